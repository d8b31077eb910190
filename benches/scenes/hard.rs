//! Scenes that solvers find hard, and what each of them should do.

use super::{Dice, Form, Kind, MILLI, Micro, ONE, Pair, Part, Scene, Thing, floor, polygon, room};

/// What a scene should do. Lengths are millionths of a metre.
#[derive(Clone, Copy, Debug)]
pub enum Should {
    /// Every dynamic body stays within this of where it began; down it may come by a tenth of the whole's height, if that is
    /// more.
    Stand(Micro),
    /// Every dynamic body is in the rectangle from here to there at the end.
    StayIn(Pair, Pair),
    /// Every dynamic body turns clockwise by more than a radian.
    Topple,
    /// Wherever it all flies, no energy comes from nowhere.
    NotGain,
}

/// A hard case.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: &'static str,
    pub what: &'static str,
    pub scene: Scene,
    /// Ticks of 1/60 s.
    pub ticks: u64,
    pub should: Should,
    /// Metres to the right at which the same scene must give the same bits.
    pub moved: &'static [Micro],
}

const MINUTE: u64 = 3600;

fn case(name: &'static str, what: &'static str, scene: Scene, ticks: u64, should: Should) -> Case {
    Case { name, what, scene, ticks, should, moved: &[] }
}

/// All of them, the quick ones first.
pub fn all() -> Vec<Case> {
    let half = Should::Stand(500 * MILLI);
    let around = Should::StayIn([-30 * ONE, -ONE], [30 * ONE, 30 * ONE]);
    vec![
        case("stack-20", "stack of 20, each up to 1 cm off", stack(20), MINUTE, half),
        case("stack-50", "stack of 50, each up to 1 cm off", stack(50), MINUTE, half),
        case("1000-on-1", "1000 kg on 1 kg", weights(&[1, 1000]), MINUTE, half),
        case(
            "top-100",
            "stack of 10, the top 100 times as heavy",
            weights(&[1, 1, 1, 1, 1, 1, 1, 1, 1, 100]),
            MINUTE,
            half,
        ),
        case(
            "heavy-light",
            "1, 1000, 1, 100, 1, 10, 500 kg from below",
            weights(&[1, 1000, 1, 100, 1, 10, 500]),
            MINUTE,
            half,
        ),
        case("light-chain", "five times 1 kg below 50 kg", weights(&[1, 50, 1, 50, 1, 50, 1, 50, 1, 50]), MINUTE, half),
        case("table", "20 m × 20 m on two of 1 m × 1 m", table(), MINUTE, half),
        case("card-house", "house of 26 cards, 2.6 mm thick", card_house(), MINUTE, Should::Stand(100 * MILLI)),
        case("arch", "arch of 9 stones", arch(), MINUTE, Should::Stand(200 * MILLI)),
        case("dominoes", "15 dominoes, the first pushed", dominoes(), 1200, Should::Topple),
        case(
            "cliff",
            "boxes and discs over an edge",
            cliff(),
            1200,
            Should::StayIn([-13 * ONE, -4 * ONE], [13 * ONE, ONE]),
        ),
        case("small", "stack of 10 of 1 cm", sized(10 * MILLI), MINUTE, Should::Stand(5 * MILLI)),
        case("large", "stack of 10 of 100 m", sized(100 * ONE), MINUTE, Should::Stand(50 * ONE)),
        case(
            "needles",
            "40 needles of 1 m × 1 cm",
            needles(),
            MINUTE,
            Should::StayIn([-2 * ONE, -10 * MILLI], [2 * ONE, 9 * ONE]),
        ),
        case("overlap-25", "pyramid of 10 rows, overlapping by 25 %", overlapping(), 1200, around),
        case("overlap-100", "10 boxes in one place", same_place(), 1200, around),
        case("squeezed", "between a wall that comes and one that stays", squeezed(), 1200, around),
        case("fast-spin", "32 000 rad/s, let down on a floor", fast_spin(), 1200, Should::NotGain),
        case(
            "packed",
            "400 discs in a room too tight by 0.5 %",
            packed(),
            1200,
            Should::StayIn([-10 * ONE, -10 * ONE], [10 * ONE, 10 * ONE]),
        ),
        Case { moved: &[1_000_000], ..case("drift", "1 m/s for 10 s", super::exact::drift(0), 600, around) },
        Case {
            moved: &[1_000_000],
            ..case("slide", "sliding stop from 3 m/s", super::exact::sliding_stop(0), 180, around)
        },
        Case {
            moved: &[1 << 20, 999_999_900],
            ..case("pile", "pile of 200", pile(), 1200, Should::StayIn([-7 * ONE, 0], [7 * ONE, 40 * ONE]))
        },
        case("rest", "stack of 3 for 10⁶ ticks", weights(&[1, 1, 1]), 1_000_000, Should::Stand(5 * MILLI)),
        case("pyramid-40", "pyramid 40 wide", pyramid(40), MINUTE, half),
        case(
            "tumbler",
            "500 boxes in a drum for 10⁴ ticks",
            tumbler(),
            10_000,
            Should::StayIn([-15 * ONE, -15 * ONE], [15 * ONE, 15 * ONE]),
        ),
        case(
            "washer",
            "300 boxes in a ring with paddles for 10⁴ ticks",
            washer(),
            10_000,
            Should::StayIn([-8 * ONE, -8 * ONE], [8 * ONE, 8 * ONE]),
        ),
        case("pyramid-100", "pyramid 100 wide", pyramid(100), MINUTE, half),
    ]
}

/// Boxes of 1 m on each other, each up to 1 cm from the middle: one that stands straight hides that it buckles.
fn stack(rows: Micro) -> Scene {
    let mut dice = Dice::new(1);
    let mut things = vec![floor()];
    for row in 0..rows {
        let x = dice.between(-10 * MILLI, 10 * MILLI);
        things.push(Thing::block([x, 500 * MILLI + row * ONE], ONE, ONE));
    }
    Scene::new(things)
}

/// Boxes of 1 m of these masses, from below.
fn weights(kilograms: &[Micro]) -> Scene {
    let mut things = vec![floor()];
    for (row, kilograms) in kilograms.iter().enumerate() {
        things.push(Thing::block([0, 500 * MILLI + row as Micro * ONE], ONE, ONE).dense(kilograms * ONE));
    }
    Scene::new(things)
}

fn table() -> Scene {
    let leg = |x| Thing::block([x, 500 * MILLI], ONE, ONE);
    Scene::new(vec![floor(), leg(-8 * ONE), leg(8 * ONE), Thing::block([0, 11 * ONE], 20 * ONE, 20 * ONE)])
}

/// Cards of 39 cm that lean by 5 in 12, in pairs, and lie on the pairs' tops: storeys of 4, 3, 2 and 1 pairs.
fn card_house() -> Scene {
    let card = |at, facing| Thing::block(at, 2600, 390 * MILLI).facing(facing).dense(5 * ONE);
    let (pitch, storey) = (392 * MILLI, 363_600);
    let mut things = vec![floor()];
    for level in 0..4 {
        let pairs = 4 - level;
        for at in 0..pairs {
            let (x, y) = ((2 * at - pairs + 1) * pitch / 2, level * storey);
            things.push(card([x - 76_200, y + 180_500], [12, -5]));
            things.push(card([x + 76_200, y + 180_500], [12, 5]));
            if at + 1 < pairs {
                things.push(card([x + pitch / 2, y + 362_300], [0, 1]));
            }
        }
    }
    Scene::new(things).friction(700 * MILLI)
}

/// Cosines and sines of 0, 20 … 180 degrees.
const RING: [Pair; 10] = [
    [1_000_000, 0],
    [939_693, 342_020],
    [766_044, 642_788],
    [500_000, 866_025],
    [173_648, 984_808],
    [-173_648, 984_808],
    [-500_000, 866_025],
    [-766_044, 642_788],
    [-939_693, 342_020],
    [-1_000_000, 0],
];

/// Half a ring of stones between 4 m and 5.2 m, each from one direction of [`RING`] to the next.
fn arch() -> Scene {
    let mut things = vec![floor()];
    for two in RING.windows(2) {
        // A stone's origin is near its middle, so that its corners are small numbers.
        let scaled = |[x, y]: Pair, by: Micro| [x * by / 10, y * by / 10];
        let corners = [scaled(two[0], 40), scaled(two[0], 52), scaled(two[1], 52), scaled(two[1], 40)];
        let middle = [0, 1].map(|axis| corners.iter().map(|c| c[axis]).sum::<Micro>() / 4);
        let vertices = corners.iter().map(|c| [c[0] - middle[0], c[1] - middle[1]]).collect();
        things.push(Thing::new(Kind::Dynamic, middle, Form::Polygon(vertices)));
    }
    Scene::new(things)
}

fn dominoes() -> Scene {
    let mut things = vec![floor()];
    for at in 0..15 {
        things.push(Thing::block([at * ONE, 500 * MILLI], 250 * MILLI, ONE));
    }
    // About its lower right corner, 12.5 cm to the right of its middle and 50 cm below.
    let first = things[1].clone();
    let spin = -1800 * MILLI;
    things[1] = first.spinning(spin).moving([-spin / 2, -spin / 8]);
    Scene::new(things)
}

/// A ledge of 6 m, 4 m above the floor of a room, and what slides over both its ends.
fn cliff() -> Scene {
    let mut things = vec![
        Thing::wall([0, -5 * ONE], 30 * ONE, 2 * ONE),
        Thing::wall([-14 * ONE, 0], 2 * ONE, 10 * ONE),
        Thing::wall([14 * ONE, 0], 2 * ONE, 10 * ONE),
        Thing::wall([0, -500 * MILLI], 6 * ONE, ONE),
    ];
    for side in [-1, 1] {
        let x = |x: Micro| side * x;
        let going = [side * 2 * ONE, 0];
        things.push(Thing::block([x(2500 * MILLI), 250 * MILLI], 500 * MILLI, 500 * MILLI).moving(going));
        things.push(Thing::disc([x(1800 * MILLI), 250 * MILLI], 250 * MILLI).moving(going));
        things.push(Thing::block([x(1000 * MILLI), 50 * MILLI], ONE, 100 * MILLI).moving(going));
    }
    Scene::new(things).friction(50 * MILLI)
}

/// A stack of 10 boxes of this side, from a hundredth of it off the middle.
fn sized(side: Micro) -> Scene {
    let mut dice = Dice::new(2);
    let ground = Thing::wall([0, -10 * side], 80 * side, 20 * side);
    let mut things = vec![ground];
    for row in 0..10 {
        let x = dice.between(-side / 100, side / 100);
        things.push(Thing::block([x, side / 2 + row * side], side, side));
    }
    Scene::new(things)
}

/// A bin of this inner half width and height, open above.
fn bin(half: Micro, height: Micro) -> Vec<Thing> {
    let wall = |x| Thing::wall([x, height / 2 - ONE], 2 * ONE, height + 2 * ONE);
    vec![Thing::wall([0, -ONE], 2 * half, 2 * ONE), wall(-half - ONE), wall(half + ONE)]
}

fn needles() -> Scene {
    let mut dice = Dice::new(3);
    let mut things = bin(2 * ONE, 8 * ONE);
    for k in 0..40 {
        let at = [(k % 4) * 900 * MILLI - 1350 * MILLI, ONE + (k / 4) * 600 * MILLI];
        // Within a tenth of level, so that none meets another from the start.
        let facing = [ONE, dice.between(-100 * MILLI, 100 * MILLI)];
        things.push(Thing::block(at, ONE, 10 * MILLI).facing(facing));
    }
    // Levels of every second row are shifted, so that needles lie across each other.
    for (k, needle) in things[3..].iter_mut().enumerate() {
        needle.at[0] = needle.at[0] * 2 / 3 + if (k / 4) % 2 == 0 { 200 * MILLI } else { -200 * MILLI };
        needle.at[1] += (k as Micro % 4) * 140 * MILLI;
    }
    Scene::new(things)
}

/// A pyramid of boxes of 1 m, 75 cm apart both ways.
fn overlapping() -> Scene {
    let mut things = vec![floor()];
    for row in 0..10 {
        for column in 0..10 - row {
            let x = (2 * column - 9 + row) * 375 * MILLI;
            things.push(Thing::block([x, 500 * MILLI + row * 750 * MILLI], ONE, ONE));
        }
    }
    Scene::new(things)
}

fn same_place() -> Scene {
    let mut things = vec![floor()];
    things.extend((0..10).map(|_| Thing::block([0, 500 * MILLI], ONE, ONE)));
    Scene::new(things)
}

/// A wall that comes at 0.1 m/s for 20 s, to half a metre from one that stays; between them boxes of 1 m in a row and on it.
fn squeezed() -> Scene {
    let mut press = Thing::new(Kind::Kinematic, [-4500 * MILLI, 2 * ONE], Form::Box(2 * ONE, 4 * ONE));
    press.velocity = [100 * MILLI, 0];
    Scene::new(vec![
        floor(),
        press,
        Thing::wall([ONE, 2 * ONE], 2 * ONE, 4 * ONE),
        Thing::block([-500 * MILLI, 500 * MILLI], ONE, ONE),
        Thing::block([-1600 * MILLI, 500 * MILLI], ONE, ONE),
        Thing::disc([-2700 * MILLI, 500 * MILLI], 500 * MILLI),
        Thing::block([-1100 * MILLI, 1500 * MILLI], ONE, ONE),
    ])
}

fn fast_spin() -> Scene {
    let spin = |x, by| Thing::block([x, 2 * ONE], ONE, ONE).spinning(by);
    Scene::new(vec![
        Thing::wall([0, -ONE], 1000 * ONE, 2 * ONE),
        spin(-5 * ONE, 32_000 * ONE),
        spin(5 * ONE, -32_000 * ONE),
        Thing::disc([0, 2 * ONE], 500 * MILLI).spinning(32_000 * ONE),
    ])
}

/// Discs of 1 m, 20 by 20 of them, in a room of 19.9 m.
fn packed() -> Scene {
    let mut things = room([9950 * MILLI, 9950 * MILLI]);
    for k in 0..400 {
        let at = [k % 20, k / 20].map(|i| i * 995 * MILLI - 9_452_500);
        things.push(Thing::disc(at, 500 * MILLI));
    }
    Scene { gravity: [0, 0], ..Scene::new(things) }
}

/// Polygons and discs of 50 cm to 1 m, dropped into a bin.
fn pile() -> Scene {
    let mut dice = Dice::new(5);
    let mut things = bin(6 * ONE, 40 * ONE);
    for k in 0..200 {
        let at = [(k % 10) * 1150 * MILLI - 5175 * MILLI, ONE + (k / 10) * 1200 * MILLI];
        let radius = dice.between(250, 500) * MILLI;
        let form = match dice.between(0, 4) {
            4 => Form::Disc(radius),
            which => polygon(which, radius),
        };
        things.push(Thing::new(Kind::Dynamic, at, form));
    }
    Scene::new(things)
}

pub fn pyramid(rows: Micro) -> Scene {
    let mut things = vec![Thing::wall([0, -ONE], 2 * rows * ONE, 2 * ONE)];
    for row in 0..rows {
        for column in 0..rows - row {
            let x = (2 * column - rows + row + 1) * 500 * MILLI;
            things.push(Thing::block([x, 500 * MILLI + row * ONE], ONE, ONE));
        }
    }
    Scene::new(things)
}

/// A drum of 19 m by 19 m inside that turns at 25 degrees a second, and boxes of 50 cm.
fn tumbler() -> Scene {
    let mut drum = Thing::new(Kind::Kinematic, [0, 0], Form::Box(ONE, 20 * ONE)).spinning(436_332);
    let wall = |at: Pair, w, h| Part::new(Form::Box(w, h), at);
    let (long, thick) = (20 * ONE, ONE);
    drum.parts = vec![
        wall([-10 * ONE, 0], thick, long),
        wall([10 * ONE, 0], thick, long),
        wall([0, -10 * ONE], long, thick),
        wall([0, 10 * ONE], long, thick),
    ];
    let mut things = vec![drum];
    for k in 0..500 {
        let at = [(k % 25 - 12) * 550 * MILLI, (k / 25) * 550 * MILLI - 5225 * MILLI];
        things.push(Thing::block(at, 500 * MILLI, 500 * MILLI));
    }
    Scene::new(things)
}

/// A ring of 18 slabs of 6 m radius with 6 paddles that turns at half a radian a second, and boxes of 30 cm.
fn washer() -> Scene {
    let mut ring = Thing::new(Kind::Kinematic, [0, 0], Form::Box(ONE, ONE)).spinning(500 * MILLI);
    ring.parts.clear();
    for (k, &[cos, sin]) in RING[..9].iter().enumerate() {
        for side in [1, -1] {
            let (cos, sin) = (side * cos, side * sin);
            // A slab across this direction, longer than the ring's side of 2·6.5·tan 10° m.
            let slab = Part::new(Form::Box(ONE, 2400 * MILLI), [cos * 65 / 10, sin * 65 / 10]);
            ring.parts.push(Part { facing: [cos, sin], ..slab });
            if k % 3 == 0 {
                let paddle = Part::new(Form::Box(1200 * MILLI, 200 * MILLI), [cos * 55 / 10, sin * 55 / 10]);
                ring.parts.push(Part { facing: [cos, sin], ..paddle });
            }
        }
    }
    let mut things = vec![ring];
    for k in 0..300 {
        let at = [(k % 20) * 400 * MILLI - 3800 * MILLI, (k / 20) * 400 * MILLI - 2800 * MILLI];
        things.push(Thing::block(at, 300 * MILLI, 300 * MILLI));
    }
    Scene::new(things)
}
