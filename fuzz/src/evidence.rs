//! Evidence: two of them, or one and a damaged copy of it.

use super::{LONGEST, mend};
use tamias2d::World;
use tamias2d::replay::Evidence;

/// The first byte says how the rest is split and mended.
pub fn run(data: &[u8]) -> bool {
    let Some((&mode, rest)) = data.split_first() else { return false };
    if rest.len() > LONGEST {
        return false;
    }
    let (one, other) = rest.split_at(if mode & 2 > 0 { rest.len() / 2 } else { rest.len() });
    let read = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if mode & 1 > 0 {
            mend::put_word(&mut bytes, 12, tamias2d::LAW);
            mend::check_last_word(&mut bytes);
        }
        let evidence = Evidence::decode(&bytes).ok()?;
        assert!(evidence.encode() == bytes, "what is read is written alike");
        Some(evidence)
    };
    let Some(one) = read(one) else { return false };
    let _is_a_world = World::load(one.before()).and_then(|_| World::load(one.after()));
    let ending = one.ending();
    if let Ok(found) = one.first_difference(&one) {
        assert!(found.is_none(), "nothing differs from itself");
    }
    let _may_be_malformed = one.first_difference(&ending);
    assert_eq!(one.is_of_state(), one.after().is_empty());
    if let Some(other) = read(other) {
        for result in [one.first_difference(&other), other.first_difference(&one)] {
            if let Ok(Some(difference)) = result {
                assert!(!format!("{difference:?}").is_empty());
            }
        }
    }
    true
}
