//! Saves, and frames into the worlds that they may be of.

use super::draw::Draw;
use super::{LONGEST, course, mend, sound};
use tamias2d::{Frame, World};

/// A byte that says what is mended, the length of the save in two bytes, a save, a frame. Whether the frame was restored.
pub fn run(data: &[u8]) -> bool {
    if data.len() > LONGEST {
        return false;
    }
    let mut draw = Draw::new(data);
    let mode = draw.byte();
    let length = usize::from(u16::from_le_bytes([draw.byte(), draw.byte()]));
    let mut save = draw.take(length).to_vec();
    let mut frame = draw.take(LONGEST).to_vec();
    if mode & 1 > 0 {
        mend::save(&mut save);
    }
    let world = match World::load(&save) {
        Ok(world) => world,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return false;
        }
    };
    assert!(world.save() == save, "what is read is written alike");
    let mut world = course::run(world, 3);
    if frame.is_empty() {
        return false;
    }
    if mode & 2 > 0 {
        mend::frame(&mut frame, &world);
    }
    let Ok(decoded) = Frame::decode(&frame) else { return false };
    let mut again = Vec::new();
    decoded.encode_into(&mut again);
    assert!(again == frame, "what is read is written alike");
    let before = world.save();
    match world.restore_frame(&decoded) {
        Ok(()) => {
            assert_eq!((world.tick(), world.hash()), (decoded.tick(), decoded.hash()));
            sound(&world);
            course::run(world, 3);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            assert!(world.save() == before, "a frame that is refused changes nothing");
            false
        }
    }
}
