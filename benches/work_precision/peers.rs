//! Other engines' figures beside ours, from the files that `benches/peers/run.sh` leaves.

use std::path::Path;

pub fn summary(_: &Path) -> String {
    String::new()
}

pub fn tables(_: &Path) -> String {
    String::new()
}
