#![allow(clippy::arithmetic_side_effects, reason = "tests, not the engine")]

use super::rect::Rect;
use super::tree::Tree;
use super::{Broad, Sweep};
use crate::geom::{Aabb, Vec2};
use crate::num::Length;
use crate::threads::{Crew, Cut};
use proptest::prelude::*;

const M: i64 = 1 << 32;
/// Beyond every accepted coordinate.
const FAR: i64 = 1_100_000_000 * M;

fn aabb([x, y]: [i64; 2], [w, h]: [i64; 2]) -> Aabb {
    let v = |x, y| Vec2::new(Length::from_bits(x), Length::from_bits(y));
    Aabb { min: v(x - w, y - h), max: v(x + w, y + h) }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % n
    }

    /// Two numbers from -most to most.
    fn within(&mut self, most: i64) -> [i64; 2] {
        [0; 2].map(|_| (self.below(2 * most as u64 + 1) as i64).wrapping_sub(most))
    }

    fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in 1..list.len() {
            list.swap(i, self.below(i as u64 + 1) as usize);
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Proxy {
    moves: bool,
    at: [i64; 2],
    velocity: [i64; 2],
    half: [i64; 2],
    /// Members of a group do not want each other; group 0 wants all.
    group: u64,
}

impl Proxy {
    fn random(random: &mut Random, room: i64) -> Proxy {
        let half = match random.below(6) {
            0 => [0; 2],
            1 => random.within(room / 3).map(i64::abs),
            _ => random.within(room / 20).map(i64::abs),
        };
        // Few places at times, so that some boxes are the same.
        let at = if random.below(4) == 0 { random.within(1).map(|at| at * (room / 2)) } else { random.within(room) };
        let (moves, velocity) = (random.below(3) > 0, random.within(room / 100));
        Proxy { moves, at, velocity, half, group: random.below(4) }
    }

    fn aabb(&self) -> Aabb {
        aabb(self.at, self.half)
    }

    fn tell(&self, slot: u32, broad: &mut Broad) {
        if self.moves {
            broad.set_moving(slot, self.aabb());
        } else {
            broad.set_fixed(slot, self.aabb());
        }
    }
}

/// What the broad phase should know.
type Model = Vec<Option<Proxy>>;

fn wanted(model: &Model, a: u32, b: u32) -> bool {
    assert!(a < b);
    let [a, b] = [a, b].map(|slot| model[slot as usize].as_ref().expect("asked about a proxy that is not there"));
    assert!(a.moves || b.moves, "asked about two fixed proxies");
    a.group == 0 || a.group != b.group
}

fn overlap(model: &Model, a: u32, b: u32) -> bool {
    let [a, b] = [a, b].map(|slot| model[slot as usize].expect("is there"));
    a.aabb().overlaps(&b.aabb())
}

/// Every wanted pair that overlaps: all pairs looked at.
fn truth(model: &Model) -> Vec<(u32, u32)> {
    let slots = || model.iter().zip(0u32..).filter_map(|(proxy, slot)| proxy.as_ref().map(|proxy| (slot, proxy)));
    let mut pairs = Vec::new();
    for (a, one) in slots() {
        for (b, two) in slots() {
            if a < b && (one.moves || two.moves) && wanted(model, a, b) && overlap(model, a, b) {
                pairs.push((a, b));
            }
        }
    }
    pairs
}

/// Boxes by slot, from one on.
struct By<F>(usize, F);

impl<F: Fn(u32) -> Aabb + Copy + Send> Cut for By<F> {
    fn len(&self) -> usize {
        usize::MAX
    }

    fn cut(self, at: usize) -> (Self, Self) {
        (By(self.0, self.1), By(self.0 + at, self.1))
    }
}

impl<F: Fn(u32) -> Aabb + Copy + Send> Sweep for By<F> {
    fn sweep(&mut self, at: usize) -> (u32, Aabb) {
        let slot = (self.0 + at) as u32;
        (slot, (self.1)(slot))
    }
}

fn update(broad: &mut Broad, model: &Model, shift: [i64; 2]) {
    let swept = |slot: u32| {
        let proxy = model[slot as usize].expect("asked for a proxy that is not there");
        assert!(proxy.moves, "asked for a fixed proxy");
        proxy.aabb()
    };
    broad.update(shift, By(0, swept), |a, b| wanted(model, a, b), Crew::ALONE);
}

/// Everything that `candidates` promises.
fn check(broad: &Broad, model: &Model) {
    let pairs = broad.candidates();
    assert!(pairs.is_sorted_by(|a, b| a < b), "not ascending, or twice");
    // Asks for both proxies, and refuses two fixed ones.
    assert!(pairs.iter().all(|&(a, b)| wanted(model, a, b)), "unwanted");
    let met: Vec<_> = pairs.iter().copied().filter(|&(a, b)| overlap(model, a, b)).collect();
    assert_eq!(met, truth(model));
    for area in model.iter().flatten().take(8).map(Proxy::aabb) {
        check_query(broad, model, &area);
    }
}

/// Everything that `query` promises: of what is fixed no more than what overlaps, whatever came before.
fn check_query(broad: &Broad, model: &Model, area: &Aabb) {
    let mut visited = vec![0; model.len()];
    broad.query(area, |slot| visited[slot as usize] += 1);
    for (proxy, visits) in model.iter().zip(visited) {
        match proxy {
            None => assert_eq!(visits, 0, "a proxy that is not there"),
            Some(proxy) if proxy.aabb().overlaps(area) => assert_eq!(visits, 1),
            Some(proxy) => assert!(visits <= u32::from(proxy.moves), "a fixed proxy that is elsewhere"),
        }
    }
}

/// One random thing that a caller does, told to all.
fn act(model: &mut Model, broads: &mut [Broad], random: &mut Random, room: i64) {
    let slot = random.below(model.len() as u64) as u32;
    let proxy = &mut model[slot as usize];
    match random.below(12) {
        0 | 1 => {
            *proxy = None;
            broads.iter_mut().for_each(|broad| broad.remove(slot));
        }
        2 => {
            // Others now want it, or do not: also when it is gone.
            if let Some(proxy) = proxy {
                proxy.group = random.below(4);
            }
            broads.iter_mut().for_each(|broad| broad.touch(slot));
        }
        3 | 4 => {
            // Moves without a word, far.
            if let Some(proxy) = proxy.as_mut().filter(|proxy| proxy.moves) {
                proxy.at = random.within(room);
            }
        }
        5 => {
            if let Some(proxy) = proxy {
                proxy.moves = !proxy.moves;
                broads.iter_mut().for_each(|broad| proxy.tell(slot, broad));
            }
        }
        6 => {
            if let Some(proxy) = proxy.as_mut().filter(|proxy| proxy.moves) {
                proxy.velocity = random.within(room / 50);
                proxy.half = random.within(room / 10).map(i64::abs);
            }
        }
        _ => {
            let new = Proxy::random(random, room);
            *proxy = Some(new);
            broads.iter_mut().for_each(|broad| new.tell(slot, broad));
        }
    }
}

/// A random history, told to broad phases that get different hints, one of which is replaced by copies of the others
/// and one of which is made from nothing, in another order, now and then.
fn history(seed: u64, slots: usize, rounds: u32, room: i64) {
    let mut random = Random(seed);
    let mut model: Model = vec![None; slots];
    let mut broads = [const { Broad::default as fn() -> Broad }; 4].map(|new| new());
    for round in 0..rounds {
        // Mostly little happens, at times much.
        let acts = if random.below(8) == 0 { slots as u64 * 2 } else { random.below(6) };
        for _ in 0..acts {
            act(&mut model, &mut broads, &mut random, room);
        }
        let drift = if round % 50 < 30 { [room / 300, -room / 200] } else { [0; 2] };
        for proxy in model.iter_mut().flatten().filter(|proxy| proxy.moves) {
            proxy.at = [0, 1].map(|axis| {
                let at: i64 = proxy.at[axis] + proxy.velocity[axis] + drift[axis];
                if at.abs() > room { at - 2 * room * at.signum() } else { at }
            });
        }
        let nonsense = [i64::MAX, i64::MIN, 1 << 60, -FAR, 0][random.below(5) as usize];
        let hints = [[0; 2], drift, random.within(room / 10), [nonsense, random.within(room)[0]]];
        for (broad, hint) in broads.iter_mut().zip(hints) {
            update(broad, &model, hint);
            check(broad, &model);
        }
        let chosen = random.below(4) as usize;
        if round % 7 == 0 {
            let [first, .., last] = &mut broads;
            last.clone_from(first);
        } else if round % 7 == 3 {
            broads[2] = broads[0].clone();
        } else if round % 7 == 5 {
            let broad = &mut broads[chosen];
            broad.clear();
            let mut order: Vec<u32> = (0..slots as u32).collect();
            random.shuffle(&mut order);
            for slot in order {
                if let Some(proxy) = model[slot as usize] {
                    proxy.tell(slot, broad);
                }
            }
            // What was told is found before the first update.
            update(broad, &model, [0; 2]);
            check(broad, &model);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn every_pair_is_found_whatever_happened_before(seed: u64, slots in 2..60usize) {
        history(seed, slots, 150, 40 * M);
    }

    #[test]
    fn every_pair_is_found_at_the_ends_of_the_world(seed: u64, slots in 2..40usize) {
        // Places within `room`, boxes up to a third of it beyond: 1.07e9 m in all.
        history(seed, slots, 100, 800_000_000 * M);
    }

    #[test]
    fn every_pair_is_found_among_grains(seed: u64) {
        history(seed, 30, 100, 1000);
    }
}

#[test]
fn every_pair_is_found_among_many() {
    history(1, 400, 60, 200 * M);
    history(2, 700, 30, 100 * M);
}

#[test]
fn unknown_proxies_may_be_removed_and_touched() {
    let mut broad = Broad::default();
    broad.remove(7);
    broad.touch(u32::MAX);
    broad.update([0; 2], By(0, |_| unreachable!()), |_, _| unreachable!(), Crew::ALONE);
    assert_eq!(broad.candidates(), []);
}

/// Boxes of 1 m in a square grid, 4 m apart.
fn grid(side: i64) -> Vec<[i64; 2]> {
    (0..side * side).map(|i| [i % side * 4 * M, i / side * 4 * M]).collect()
}

#[test]
fn what_falls_together_is_searched_once() {
    let (places, half) = (grid(20), [M / 2; 2]);
    let mut broad = Broad::default();
    for (&at, slot) in places.iter().zip(0..) {
        broad.set_moving(slot, aabb(at, half));
    }
    let mut fallen = 0;
    for tick in 1..600 {
        let way = -tick * M / 360;
        fallen += way;
        let swept = |slot: u32| aabb([places[slot as usize][0], places[slot as usize][1] + fallen], half);
        broad.update([0, way], By(0, swept), |_, _| unreachable!(), Crew::ALONE);
        assert!(broad.since.iter().all(|&since| since <= 1), "a new fat box in tick {tick}");
    }
}

#[test]
fn what_rests_is_searched_once() {
    let mut random = Random(5);
    let places: Vec<[i64; 2]> = (0..900).map(|i| [i % 30 * M, i / 30 * M]).collect();
    let mut broad = Broad::default();
    broad.set_fixed(900, aabb([0, -M], [100 * M, M / 2]));
    for (&at, slot) in places.iter().zip(0..) {
        broad.set_moving(slot, aabb(at, [M / 2; 2]));
    }
    for tick in 1..300 {
        let jitter = random.within(M / 1_000_000);
        let swept = |slot: u32| aabb(places[slot as usize], [M / 2 + jitter[0]; 2]);
        broad.update([0; 2], By(0, swept), |_, _| true, Crew::ALONE);
        assert!(broad.since.iter().all(|&since| since <= 1), "a new fat box in tick {tick}");
    }
    // 870 neighbours each in a row and in a column, 2 · 841 across, 30 on the ground: and no others.
    assert_eq!(broad.candidates().len(), 870 * 2 + 841 * 2 + 30);
}

/// How many boxes a search looks at, on average, and that it finds what all boxes looked at would.
fn cost(tree: &Tree, boxes: &[Option<Rect>], random: &mut Random, room: i64) -> u64 {
    let mut tests = 0;
    for _ in 0..100 {
        let probe = Rect::new(&aabb(random.within(room), [M; 2]));
        let mut found = Vec::new();
        tree.visit(
            |rect| {
                tests += 1;
                rect.overlaps(&probe)
            },
            |proxy| found.push(proxy),
        );
        found.sort_unstable();
        let meets = |rect: &Option<Rect>| rect.is_some_and(|rect| rect.overlaps(&probe));
        let truth: Vec<u32> = boxes.iter().zip(0..).filter(|(rect, _)| meets(rect)).map(|(_, proxy)| proxy).collect();
        assert_eq!(found, truth);
    }
    tests / 100
}

#[test]
fn a_tree_stays_good() {
    let (mut random, room) = (Random(9), 100 * M);
    let mut tree = Tree::default();
    let mut places: Vec<[i64; 2]> = (0..3000).map(|_| random.within(room)).collect();
    // Some that are far away, and some that are big.
    places[..3].copy_from_slice(&[[FAR; 2], [-FAR; 2], [FAR / 1000; 2]]);
    let rect = |at: [i64; 2], slot: usize| Rect::new(&aabb(at, [if slot % 100 == 50 { 20 * M } else { M / 2 }; 2]));
    let mut boxes: Vec<Option<Rect>> = places.iter().enumerate().map(|(slot, &at)| Some(rect(at, slot))).collect();
    for (rect, proxy) in boxes.iter().zip(0..) {
        tree.set(proxy, rect.as_ref().expect("all are there"));
    }
    tree.tidy();
    let new = cost(&tree, &boxes, &mut random, room);
    assert!(new < 80, "{new} tests in a tree of 3000 just built");
    for round in 0..400 {
        for slot in 3..places.len() {
            if random.below(8) == 0 {
                let step = random.within(5 * M);
                places[slot] = [0, 1].map(|axis| (places[slot][axis] + step[axis]).clamp(-room, room));
                // A tenth of them are gone and come again.
                boxes[slot] = (slot % 10 > 0 || random.below(2) > 0).then(|| rect(places[slot], slot));
                match &boxes[slot] {
                    Some(rect) => tree.set(slot as u32, rect),
                    None => tree.remove(slot as u32),
                }
            }
        }
        tree.tidy();
        for _ in 0..100 {
            let probe = Rect::new(&aabb(random.within(room), [M; 2]));
            tree.search(&probe, |_| ());
        }
        if round % 20 == 0 {
            let now = cost(&tree, &boxes, &mut random, room);
            assert!(now < 250, "{now} tests in round {round}");
        }
    }
    // All but a few go; the few move.
    for (slot, gone) in boxes.iter_mut().enumerate().filter(|(slot, _)| slot % 100 > 0) {
        *gone = None;
        tree.remove(slot as u32);
    }
    tree.tidy();
    for slot in (0..places.len()).step_by(100) {
        boxes[slot] = Some(rect(random.within(room), slot));
        tree.set(slot as u32, &boxes[slot].expect("just set"));
    }
    assert!(cost(&tree, &boxes, &mut random, room) <= 40, "30 leaves");
}
