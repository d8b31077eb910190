//! Making checks and hashes right again, so that input gets past them: who forges a file can do the same.

use tamias2d::replay::{Player, REPLAY_VERSION, ReplayError};
use tamias2d::{DecodeError, Frame, LAW, SAVE_VERSION, World};
use twox_hash::XxHash3_64;

/// Writes a 32-bit number, if there is room.
pub fn put_word(bytes: &mut [u8], at: usize, value: u32) {
    if let Some(place) = bytes.get_mut(at..at + 4) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

fn put_long(bytes: &mut [u8], at: usize, value: u64) {
    if let Some(place) = bytes.get_mut(at..at + 8) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// Makes the last eight bytes the hash of those before.
pub fn check_last_word(bytes: &mut [u8]) {
    if let Some(end) = bytes.len().checked_sub(8) {
        let hash = XxHash3_64::oneshot(&bytes[..end]);
        put_long(bytes, end, hash);
    }
}

fn header(bytes: &mut [u8], magic: &[u8; 8], version: u32) {
    if let Some(place) = bytes.get_mut(..8) {
        place.copy_from_slice(magic);
    }
    put_word(bytes, 8, version);
    put_word(bytes, 12, LAW);
}

/// A save: its header and its hash.
pub fn save(bytes: &mut [u8]) {
    header(bytes, b"TAMIAS-W", SAVE_VERSION);
    if let Err(DecodeError::Hash { computed, .. }) = World::load(bytes) {
        let end = bytes.len() - 8;
        put_long(bytes, end, computed);
    }
}

/// A frame: its header, the digests and the clock of the world that it shall fit, its hash and its seal.
pub fn frame(bytes: &mut [u8], world: &World) {
    header(bytes, b"TAMIAS-F", SAVE_VERSION);
    put_long(bytes, 16, world.tick());
    let mut own = Frame::default();
    world.save_frame(&mut own);
    let mut fitting = Vec::new();
    own.encode_into(&mut fitting);
    // Four digests and the clock.
    if let Some(place) = bytes.get_mut(24..64) {
        place.copy_from_slice(&fitting[24..64]);
    }
    for from_end in [16, 8] {
        if let Err(DecodeError::Hash { computed, .. }) = Frame::decode(bytes) {
            let at = bytes.len() - from_end;
            put_long(bytes, at, computed);
        }
    }
}

const WORLD: u8 = 0x01;
const IDLE: u8 = 0x02;
const TICK: u8 = 0x03;
const TAIL: u8 = 0x04;
const END: u8 = 0x0f;
const KEYFRAME: u8 = 0x80;
const HEADER: usize = 32;
const HEAD: usize = 40;

/// A replay: its header, the hashes of its worlds, and the chain of its records. The places of its ticks' hashes.
fn chain(bytes: &mut [u8]) -> Vec<usize> {
    header(bytes, b"TAMIAS-R", REPLAY_VERSION);
    if bytes.len() < HEADER {
        return Vec::new();
    }
    check_last_word(&mut bytes[..HEADER]);
    let mut chain = XxHash3_64::oneshot(&bytes[..HEADER - 8]);
    let (mut at, mut hashes) = (HEADER, Vec::new());
    while let Some(&tag) = bytes.get(at) {
        let (start, length, check) = match tag {
            IDLE => (at + 1, 8, 0),
            END => (at + 1, 16, 8),
            _ => {
                let Some(length) = bytes.get(at + 1..at + 5) else { break };
                let length = length.iter().rev().fold(0usize, |sum, &byte| sum << 8 | usize::from(byte));
                // What claims more than there is ends with the file.
                let length = length.min(bytes.len().saturating_sub(at + 9));
                put_word(bytes, at + 1, length as u32);
                (at + 5, length, 4)
            }
        };
        let end = start + length;
        if end + check > bytes.len() {
            break;
        }
        match tag {
            WORLD => save(&mut bytes[start..end]),
            KEYFRAME if length > HEAD => {
                put_long(bytes, start + 24, chain);
                save_if_one(&mut bytes[start + HEAD..end]);
            }
            IDLE | TICK | TAIL => hashes.push(start),
            _ => {}
        }
        chain = XxHash3_64::oneshot_with_seed(chain, &bytes[at..end]);
        bytes[end..end + check].copy_from_slice(&chain.to_le_bytes()[..check]);
        at = end + check;
    }
    hashes
}

/// A keyframe holds a save or less.
fn save_if_one(bytes: &mut [u8]) {
    if bytes.starts_with(b"TAMIAS-W") {
        save(bytes);
    }
}

/// A replay that plays for at least some ticks, if its commands let it.
pub fn replay(bytes: &mut Vec<u8>, is_small: impl Fn(&World) -> bool, ticks: u64) {
    for _ in 0..8 {
        let hashes = chain(bytes);
        let Ok(mut player) = Player::new(bytes.as_slice()) else { return };
        let found = loop {
            if player.ticks() >= ticks || !is_small(player.world()) {
                return;
            }
            match player.step() {
                Ok(Some(_)) => {}
                Ok(None) => return,
                Err(ReplayError::Diverged { tick, computed, .. }) => break (tick, computed),
                Err(_) => return,
            }
        };
        let Some(&at) = hashes.get(found.0.saturating_sub(1) as usize) else { return };
        put_long(bytes, at, found.1);
    }
}
