//! Replays: played, inspected, gone into at their keyframes, and compared.

use super::{LONGEST, MOST_TICKS, is_small, mend, sound};
use std::io::Cursor;
use tamias2d::replay::{Contents, Player, Segment, compare, read_index, recompute};

/// A byte that says whether the rest is mended, and a replay. Whether it is whole and has keyframes.
pub fn run(data: &[u8]) -> bool {
    let Some((&mode, rest)) = data.split_first() else { return false };
    if rest.len() > LONGEST {
        return false;
    }
    let mut file = rest.to_vec();
    if mode & 1 > 0 {
        mend::replay(&mut file, is_small, MOST_TICKS);
    }
    let whole = played(&file);
    let contents = Player::new(file.as_slice()).and_then(Player::inspect);
    if let Err(error) = &contents {
        assert!(!error.to_string().is_empty());
    }
    if let (Some(true), Err(error)) = (whole, &contents) {
        panic!("what plays to its end is whole: {error}");
    }
    let _index = read_index(&mut Cursor::new(&file));
    if let Ok(contents) = &contents {
        segments(&file, contents);
    }
    if whole.is_some() {
        let half = &file[..file.len() / 2];
        let _comparison = compare([&mut Cursor::new(file.as_slice()), &mut Cursor::new(half)]);
        let _evidence = recompute(&mut Cursor::new(&file), u64::from(mode >> 1 & 7));
    }
    contents.is_ok_and(|contents| !contents.keyframes.is_empty())
}

/// Plays as far as worlds are small. Whether to the end without an error; none if it was too much.
fn played(file: &[u8]) -> Option<bool> {
    let Ok(mut player) = Player::new(file) else { return Some(false) };
    sound(player.world());
    while player.ticks() < MOST_TICKS {
        if !is_small(player.world()) {
            return None;
        }
        let step = player.step();
        sound(player.world());
        match step {
            Ok(Some(hash)) => {
                assert_eq!(player.world().hash(), hash);
                assert!(player.commands().count() <= file.len(), "commands are made of bytes");
            }
            Ok(None) => return Some(true),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                return Some(false);
            }
        }
    }
    None
}

/// Goes into a file that is whole at its keyframes.
fn segments(file: &[u8], contents: &Contents) {
    for keyframe in contents.keyframes.iter().take(4) {
        let Ok(player) = Player::at(Cursor::new(file), keyframe) else { continue };
        sound(player.world());
    }
    if contents.summary.ticks <= MOST_TICKS {
        for segment in Segment::few(contents, 3) {
            if Player::new(file).is_ok_and(|player| is_small(player.world())) {
                let mut ticks = 0u64;
                let verified = segment.verify(Cursor::new(file), |_| ticks += 1);
                assert!(ticks <= contents.summary.ticks);
                drop(verified);
            }
        }
    }
}
