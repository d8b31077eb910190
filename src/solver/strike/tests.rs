//! Answers where contacts do not come to an end.
#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use super::*;
use crate::body::{BodyData, BodyKind};
use crate::narrow::Point;
use crate::num::Inertia;

/// Of a body of 1 kg that reaches 1/2 m.
fn mobility(inertia: &str) -> Mobility {
    Mobility::new(&BodyData {
        kind: BodyKind::Dynamic,
        mass: "1".parse::<Mass>().unwrap(),
        inertia: inertia.parse::<Inertia>().unwrap(),
        reach: "0.5".parse::<Length>().unwrap(),
        ..BodyData::default()
    })
}

/// A row of discs that run into each other all at once, inelastic: an impulse goes along it by a disc a round, to and fro, which takes
/// more rounds than there are. At its end strikes an elastic rod, aslant: answered alone, its friction would add energy. So no
/// attempt is as it should be, and the last one counts: bodies approach a hundredth as fast as before.
#[test]
fn what_does_not_come_to_an_end_is_answered_all_the_same() {
    const DISCS: usize = 80;
    let (disc, rod) = (mobility("0.125"), mobility("0.08"));
    let metre = |part: i64| (1i64 << 32) * part / 100;
    let contact = |a: usize, arm: [i64; 2], between: [i64; 2], kind: &Mobility| {
        let points = [Point { arm, separation: 0, id: 0 }, Point::default()];
        let manifold = Manifold { normal: [1 << 30, 0], count: 1, points };
        Strike::new([a, a - 1], &manifold, between, [kind, &disc], ONE, false)
    };
    let mut strikes: Vec<Strike> = (1..DISCS).map(|a| contact(a, [metre(-50), 0], [metre(-100), 0], &disc)).collect();
    strikes.push(contact(DISCS, [metre(-35), metre(35)], [metre(-85), metre(35)], &rod));
    let restitutions: Vec<i64> = (1..=DISCS).map(|a| if a == DISCS { ONE } else { 0 }).collect();
    let weights: Vec<Weight> = (0..=DISCS).map(|at| if at == DISCS { &rod } else { &disc }.weight()).collect();
    // 1 cm/s from disc to disc; the rod 3 m/s, and 5 cm/s across, which its impulse turns round.
    let mut speeds: Vec<Speed> = (0..DISCS).map(|at| [-(at as i64) * ONE / 100, 0, 0]).collect();
    speeds.push([-3 * ONE, -5 * ONE / 100, 0]);
    let start = speeds.clone();
    solve(&mut strikes, &restitutions, &weights, &mut speeds, &mut Vec::new());
    let fastest = |speeds: &[Speed]| strikes.iter().map(|strike| strike.approach(speeds)).min();
    assert!(fastest(&speeds) > fastest(&start).map(|speed| speed / 100), "{:?}", fastest(&speeds));
    assert!(!gains(&weights, &start, &speeds));
}
