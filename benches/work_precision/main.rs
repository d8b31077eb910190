//! How wrong the engine is, and at what cost: `cargo bench --bench work_precision` writes `benches/report` anew.
//!
//! `-- grid`, `-- hard`, `-- features`, `-- growth` or `-- lockstep` measures a part only, and a number after `growth` is the
//! most bodies; `-- page` draws what was measured before; `-- peers` reads what `benches/peers/driver.py` left in `$PEERS`.
//! `-- threads`, with the feature of that name, prints what several threads gain, and writes nothing.
#![allow(
    clippy::disallowed_types,
    clippy::arithmetic_side_effects,
    reason = "a bench, not the engine: it compares with floating point"
)]

mod clock;
mod draw;
mod exact;
mod features;
mod grid;
mod growth;
mod hard;
mod lockstep;
mod machine;
mod page;
mod peers;
mod plot;
mod raw;
mod reference;
#[path = "../scenes/mod.rs"]
mod scenes;
mod stage;
mod table;
#[cfg(feature = "threads")]
mod threads;
mod trace;
mod yardstick;

use std::path::PathBuf;

/// How often everything is timed.
const ROUNDS: usize = 7;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    // `cargo test --benches` runs this as well, without it.
    if !args.iter().any(|arg| arg == "--bench") {
        return;
    }
    let parts: Vec<&str> = args.iter().map(String::as_str).filter(|arg| !arg.starts_with('-')).collect();
    #[cfg(feature = "threads")]
    if parts == ["threads"] {
        return threads::print();
    }
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let wanted = |part: &str| parts.is_empty() || parts.contains(&part);
    let folder = root.join("benches/report");
    std::fs::create_dir_all(&folder).expect("the folder is ours");
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("the folder is ours");
    if wanted("grid") {
        write("work_precision.csv", grid::csv(&grid::measure(ROUNDS)));
    }
    if wanted("features") {
        write("features.csv", features::csv(&features::measure(ROUNDS)));
    }
    if wanted("hard") {
        write("hard.csv", hard::csv(&hard::measure()));
    }
    if wanted("growth") {
        let most = parts.iter().find_map(|part| part.parse().ok()).unwrap_or(i64::MAX);
        write("growth.csv", growth::csv(&growth::measure(most)));
    }
    if wanted("lockstep") {
        write("lockstep.csv", lockstep::csv(&lockstep::measure(ROUNDS)));
    }
    if parts.contains(&"peers") {
        raw::write(&std::env::var_os("PEERS").map_or(root.join("target/peers"), PathBuf::from), &folder);
        write("peers_machine.txt", machine::describe("optimisation level 3, one codegen unit, no LTO"));
    } else if parts != ["page"] {
        write("machine.txt", machine::describe("profile `bench`: thin LTO, one codegen unit"));
    }
    page::write(&folder);
}
