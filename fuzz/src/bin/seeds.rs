//! Writes what the fuzzers begin with (`src/seeds.rs`) into a folder: `cargo run --release --bin seeds FOLDER`

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let Some(folder) = env::args_os().nth(1).map(PathBuf::from) else {
        return Err(io::Error::other("name the folder that the seeds go to"));
    };
    for (target, name, bytes) in tamias2d_fuzz::seeds::all(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../replays"))? {
        let folder = folder.join(target);
        fs::create_dir_all(&folder)?;
        fs::write(folder.join(name), bytes)?;
    }
    Ok(())
}
