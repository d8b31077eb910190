//! The streams of hashes, for the program beside it and for pages.

#[path = "../../../tests/streams/play/mod.rs"]
pub mod play;
#[cfg(all(target_arch = "wasm32", target_os = "unknown"))]
mod web;
