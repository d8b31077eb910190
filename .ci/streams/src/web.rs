//! For pages: bytes in, lines out, by functions that any language calls. One caller, one thread.
#![allow(unsafe_code, reason = "exports by name, and memory that the page writes to and reads from")]

use crate::play::{SEEDS, golden, random};
use std::cell::RefCell;
use tamias2d::Threads;

thread_local! {
    /// What the page wrote, and what it is answered.
    static BYTES: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Room for `length` bytes, to be written before [`tamias_golden`] is called.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn tamias_room(length: usize) -> *mut u8 {
    BYTES.with_borrow_mut(|bytes| {
        *bytes = vec![0; length];
        bytes.as_mut_ptr()
    })
}

/// Plays the recording that was written. How many bytes the answer has: it is where [`tamias_answer`] says.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn tamias_golden() -> usize {
    let replay = BYTES.take();
    answer(golden("", &replay, &Threads::default()))
}

/// How many scenes there are, from 1 on.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn tamias_scenes() -> u32 {
    *SEEDS.end() as u32
}

/// Plays a scene; as [`tamias_golden`].
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn tamias_scene(seed: u32) -> usize {
    answer(random(seed.into(), &Threads::default()))
}

/// Where the last answer is, until the next call of another function: lines, or `!` and what is wrong.
// SAFETY: no other symbol has this name.
#[unsafe(no_mangle)]
pub extern "C" fn tamias_answer() -> *const u8 {
    BYTES.with_borrow(|bytes| bytes.as_ptr())
}

fn answer(lines: Result<String, String>) -> usize {
    let bytes = lines.unwrap_or_else(|wrong| format!("!{wrong}")).into_bytes();
    let length = bytes.len();
    BYTES.set(bytes);
    length
}
