//! Times of first touch against a search by small steps.

use super::meeting::{MM, TICK, TOUCH, acceleration, block, disc, gap, outline, same, speed, speeds};
use super::*;
use crate::narrow::Motion;
use crate::shape::Outline;

/// The first of `steps` times at which they overlap, and from the one before bisected; and the least gap seen.
fn search(pair: [&Outline; 2], motion: &Motion, until: i64, steps: i64) -> (Option<i64>, i64) {
    let (mut before, mut least) = (0, i64::MAX);
    for step in 0..=steps {
        let time = (i128::from(until) * i128::from(step) / i128::from(steps)) as i64;
        let here = gap(pair, motion, time);
        least = least.min(here);
        if here <= 0 {
            let (mut low, mut high) = (before, time);
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                if gap(pair, motion, middle) <= 0 { high = middle } else { low = middle }
            }
            return (Some(high), least);
        }
        before = time;
    }
    (None, least)
}

#[test]
fn turning_boxes_land_when_a_search_says() {
    let (floor, turned) = (block(20 * M, M), block(M, M));
    let mut noise = Noise(22);
    let (mut hits, mut worst) = (0, 0);
    for _ in 0..600 {
        let motion = Motion {
            d: [noise.within(-8 * M, 8 * M), noise.within(1100 * MM, 1400 * MM)],
            v: speeds([noise.within(-5000, 5000), noise.within(-20_000, -1000)]),
            a: [0, acceleration(-9810)],
            angle: [0, noise.within(0, 1 << 48)],
            omega: [0, speed(noise.within(-20_000, 20_000))],
            alpha: [0; 2],
        };
        let pair = [&floor, &turned];
        if gap(pair, &motion, 0) <= TOUCH {
            continue;
        }
        let found = same(pair, &motion, TICK, 0, 0);
        let (exact, least) = search(pair, &motion, TICK, 256);
        match exact {
            Some(exact) => {
                let found = found.expect("touches");
                assert!(gap(pair, &motion, found) >= -4, "{motion:?}");
                worst = worst.max(exact - found);
                hits += 1;
            }
            None => assert!(found.is_none() || least < TOUCH, "{found:?} {least} {motion:?}"),
        }
    }
    // 1e-5 s is 2.6e6.
    println!("{hits} hits, {worst} early");
    assert!(hits > 200 && worst < 2_600_000);
}

#[test]
fn a_needle_hits_a_post_in_every_phase_in_which_a_search_does() {
    let (post, needle) = (block(100 * MM, 100 * MM), block(2 * M, 20 * MM));
    let mut hits = 0;
    for phase in 0..80 {
        let motion = Motion {
            d: [-1300 * MM, 10 * MM],
            v: speeds([50_000, 0]),
            angle: [0, phase * (1 << 48) / 40],
            omega: [0, speed(if phase % 2 == 0 { 400_000 } else { -400_000 })],
            ..Motion::default()
        };
        let pair = [&post, &needle];
        let found = same(pair, &motion, TICK, 0, 0);
        let (exact, least) = search(pair, &motion, TICK, 4096);
        match (exact, found) {
            (Some(exact), Some(found)) => {
                hits += 1;
                let here = gap(pair, &motion, found);
                assert!(found <= exact && (-4..=TOUCH).contains(&here), "{phase}: {found} {exact} {here}");
            }
            (None, found) => assert!(found.is_none() || least < 100 * TOUCH, "{phase} {least}"),
            (Some(_), None) => panic!("{phase} missed"),
        }
    }
    println!("{hits}");
    assert!(hits > 40);
}

#[test]
fn bullets_do_not_pass_a_wall() {
    let wall = block(100 * MM, 4 * M);
    let mut noise = Noise(24);
    for phase in 0..200 {
        for bullet in [block(100 * MM, 100 * MM), disc(50 * MM)] {
            let d = [-noise.within(101 * MM, 3300 * MM), noise.within(-M, M)];
            let spin = if phase % 2 == 0 { 0 } else { noise.within(-50_000, 50_000) };
            let motion = Motion { d, v: speeds([200_000, 0]), omega: [0, speed(spin)], ..Motion::default() };
            let reach = if bullet.count > 1 { 71 * MM } else { 50 * MM };
            let found = same([&wall, &bullet], &motion, TICK, 0, 0);
            if -d[0] - 50 * MM - reach < 3333 * MM {
                let found = found.expect("hits");
                let here = gap([&wall, &bullet], &motion, found);
                assert!((-4..=TOUCH).contains(&here), "{here}");
            }
        }
    }
}

#[test]
fn what_leaves_after_a_bounce_does_not_touch_again() {
    let (floor, turned) = (block(20 * M, M), block(M, M));
    let mut noise = Noise(25);
    for _ in 0..2000 {
        let angle = noise.within(1 << 40, (1 << 46) - (1 << 40));
        let placed = Placed::new(&turned, Rot::new(Angle::from_bits(angle)));
        let lowest = (0..4).min_by_key(|&at| placed.vertices[at][1]).unwrap();
        let omega = speed(noise.within(-20_000, 20_000));
        // The corner's velocity is v + ω·x: it leaves at 0.1 to 5 m/s, or the other way, closing.
        let leaving = noise.within(100, 5000);
        let turning = mul(omega, placed.vertices[lowest][0], 32);
        let d = [noise.within(-8 * M, 8 * M), M / 2 - placed.min[1] + noise.within(0, TOUCH - 2)];
        let v = [noise.within(-speed(5000), speed(5000)), speed(leaving) - turning];
        let motion = Motion { d, v, angle: [0, angle], omega: [0, omega], ..Motion::default() };
        let pair = [&floor, &turned];
        let back = Motion { v: [v[0], -speed(leaving) - turning], ..motion };
        assert_eq!(same(pair, &back, TICK, 0, 0), Some(0), "closing {motion:?}");
        let found = same(pair, &motion, TICK, 0, 0);
        // Another corner may come down, or the body as a whole.
        let later = (1..=256).find(|step| gap(pair, &motion, step * (TICK / 256)) <= 0);
        assert_eq!(found.is_some(), later.is_some(), "{found:?} {later:?} {motion:?}");
        if let Some(found) = found {
            assert!(found > TICK / 512 && gap(pair, &motion, found) >= -8 - TOUCH / 2, "{found} {motion:?}");
        }
    }
}

/// Any form, from `size`/8 on.
fn form(noise: &mut Noise, size: i64) -> Outline {
    let size = noise.within(size / 8, size);
    let shift = noise.within(0, size);
    match noise.within(0, 5) {
        0 => outline(&circle([0, 0], size)),
        1 => outline(&circle(noise.around(shift), size)),
        2 => {
            let thin = noise.within(size / 50, size);
            block(size, thin)
        }
        _ => outline(&noise.polygon(size)),
    }
}

/// Depths that rounding explains: of what is turned, of normals, of what moves in a unit of time; 4 units of their own.
fn blur(pair: [&Outline; 2], motion: &Motion) -> i64 {
    let reach = pair[0].reach + pair[1].reach;
    let rim = |body: usize| mul(motion.omega[body].abs() + motion.alpha[body].abs(), pair[body].reach, 40);
    let moved: i64 = (0..2).map(|at| (motion.v[at].abs() + motion.a[at].abs()) >> 8).sum();
    4 + (reach >> 28) + ((moved + rim(0) + rim(1)) >> 31)
}

/// Compares a time with a search; whether there is one, and whether the search found one.
fn agree(pair: [&Outline; 2], motion: &Motion, steps: i64) -> (bool, bool) {
    let blur = blur(pair, motion);
    let touching = TOUCH.max(mul(TOUCH, pair[0].reach.max(pair[1].reach), 34));
    let found = same(pair, motion, TICK, 0, 0);
    let (exact, least) = search(pair, motion, found.unwrap_or(TICK), steps);
    if let Some(found) = found {
        let here = gap(pair, motion, found);
        assert!((-blur..=touching + blur).contains(&here), "{here} at {found}: {motion:?}");
    }
    // Up to that time, or to the end, nothing was passed.
    assert!(least >= -blur, "{least} ({blur}) before {found:?}: {motion:?}");
    (found.is_some(), exact.is_some())
}

#[test]
fn random_pairs_touch_when_a_search_says() {
    let mut noise = Noise(26);
    let (mut hits, mut misses) = (0, 0);
    for index in 0..9000 {
        // 1 cm to 500 m, and speeds that go with it; a third does not turn, a third only one, a ninth is pushed round.
        let size = (M / 100) << noise.within(0, 15);
        let other = size >> noise.within(0, 4);
        let forms = [form(&mut noise, size), form(&mut noise, other)];
        let pair = [&forms[0], &forms[1]];
        let reach = pair[0].reach + pair[1].reach;
        let away = noise.within(reach / 2, reach * 5 / 4);
        let d = noise.around(away);
        // Towards each other, on the whole.
        let (quick, beside) = (noise.within(-1 << 30, 3 << 30), size.min(8 * M) << 7);
        let v = d.map(|d| noise.within(-beside, beside) - (mul(d, quick, 32) << 8));
        let turning = 1 << noise.within(30, 42);
        let mut turn = |body: i64| if index % 3 > body { noise.within(-turning, turning) } else { 0 };
        let omega = [turn(0), turn(1)];
        let alpha = if index % 9 == 2 { [turn(0), turn(1)] } else { [0; 2] };
        let a = [0, noise.within(-beside, beside)];
        let motion = Motion { d, v, a, angle: [0; 2].map(|_| noise.within(0, 1 << 48)), omega, alpha };
        if gap(pair, &motion, 0) > TOUCH.max(mul(TOUCH, pair[0].reach.max(pair[1].reach), 34)) {
            let (found, _) = agree(pair, &motion, 128);
            (hits, misses) = (hits + i32::from(found), misses + i32::from(!found));
        }
    }
    println!("{hits} hits, {misses} misses");
    assert!(hits > 2000 && misses > 3000);
}

#[test]
fn the_fastest_are_not_late() {
    // 32 768 m/s at 15 ticks a second, and rims as fast, up to 2184 radians a tick.
    let most = 2184 << 40;
    let mut noise = Noise(28);
    let mut hits = 0;
    for index in 0..600 {
        let size = (M / 100) << noise.within(0, 12);
        let forms = [form(&mut noise, size), form(&mut noise, size)];
        let pair = [&forms[0], &forms[1]];
        let way = noise.within(0, 3000 * M);
        let d = noise.around(way);
        let v = d.map(|d| noise.within(-size, size) * 64 - (d << 8).clamp(-most, most));
        let spin = (i128::from(most) << 32) / i128::from(size * 3);
        let spin = (spin as i64).min(most) >> noise.within(0, 12);
        let turn = if index % 2 == 0 { [0; 2] } else { [0; 2].map(|_| noise.within(-spin, spin)) };
        let motion = Motion { d, v, omega: turn, ..Motion::default() };
        if gap(pair, &motion, 0) > 100 * TOUCH {
            let blur = blur(pair, &motion);
            if let Some(found) = same(pair, &motion, TICK, 0, 0) {
                hits += 1;
                assert!(gap(pair, &motion, found) >= -blur, "{found} {motion:?}");
                let (_, least) = search(pair, &motion, found, 256);
                assert!(least >= -blur, "{least} before {found} {motion:?}");
            } else {
                let (_, least) = search(pair, &motion, TICK, 4096);
                assert!(least >= -blur, "{least} {motion:?}");
            }
        }
    }
    println!("{hits} hits");
    assert!(hits > 200);
}

#[test]
fn no_motion_wraps() {
    let most = 1 << 62;
    let mut noise = Noise(27);
    for round in 0..3000 {
        let limit = if round % 2 == 0 { most } else { 2185 << 40 };
        let near = if round % 3 == 0 { 0 } else { 14 };
        let mut any = || noise.within(-limit, limit);
        let motion = Motion {
            d: [any() >> near, any() >> near],
            v: [any(), any()],
            a: [any(), any()],
            angle: [any(), any()],
            omega: [any(), any()],
            alpha: [any(), any()],
        };
        let size = (M / 100) << noise.within(0, 20);
        let forms = [form(&mut noise, size), form(&mut noise, size)];
        let found = same([&forms[0], &forms[1]], &motion, TICK, 0, 0);
        assert!(found.is_none_or(|time| (0..=TICK).contains(&time)));
    }
}
