//! Commands that are refused change nothing and say why; those at the edge of what is accepted do no harm.
#![allow(clippy::disallowed_types, clippy::arithmetic_side_effects, reason = "tests, not the engine")]

mod common;

use common::{acc, at, disc, newton_seconds, newtons, num, vel, world};
use tamias2d::num::{Decimal, Quantity};
use tamias2d::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Attractor, AttractorId, BodyDef, BodyError, BodyId, BodyKind,
    ColliderDef, ColliderId, Command, CommandError, Commands, ConfigError, Damping, Density, Filter, Force, Friction,
    INPUT_MAX, Impulse, Inertia, Integrator, Length, Mass, Mu, RangeError, Restitution, Shape, ShapeError, Torque,
    Vec2, Velocity, World, WorldDef,
};

/// The collider of the dynamic body.
const COLLIDER: ColliderId = ColliderId { index: 1, generation: 0 };

/// A world with a body of each kind, one with fixed rotation, a heavy one, and ids of what is gone.
struct Scene {
    world: World,
    dynamic: BodyId,
    fixed: BodyId,
    heavy: BodyId,
    kinematic: BodyId,
    resting: BodyId,
    gone: BodyId,
    star: AttractorId,
    gone_star: AttractorId,
}

fn scene() -> Scene {
    let mut world = world(0.0, -9.8);
    let mut body = |def: BodyDef| world.create_body(&def).expect("accepted");
    let gone = body(BodyDef { colliders: vec![disc(0.5)], ..BodyDef::default() });
    let (mass, inertia, colliders) = (Some(num("1")), Some(num("1")), vec![disc(0.5)]);
    let (position, velocity) = (at(1.0, 2.0), vel(3.0, 4.0));
    let dynamic = body(BodyDef { position, velocity, mass, inertia, colliders, ..BodyDef::default() });
    let fixed = body(BodyDef { fixed_rotation: true, ..BodyDef::default() });
    let heavy = body(BodyDef {
        mass: Some(Mass::MAX),
        inertia: Some(Inertia::MAX),
        position: at(-1e9, 0.0),
        ..BodyDef::default()
    });
    let kinematic = body(BodyDef { kind: BodyKind::Kinematic, velocity: vel(1.0, 0.0), ..BodyDef::default() });
    let resting = body(BodyDef { kind: BodyKind::Static, ..BodyDef::default() });
    let star = world.create_attractor(Attractor { position: at(50.0, 0.0), mu: num("5") }).expect("accepted");
    let gone_star = world.create_attractor(Attractor { position: at(50.0, 9.0), mu: num("5") }).expect("accepted");
    world.destroy_body(gone).expect("accepted");
    world.destroy_attractor(gone_star).expect("accepted");
    world.step();
    // Forces wait for their tick: they must survive as well.
    world.apply_force(dynamic, newtons(1.0, 2.0), None).expect("accepted");
    Scene { world, dynamic, fixed, heavy, kinematic, resting, gone, star, gone_star }
}

/// A quantity of which a vector's components or a scalar can be one unit beyond its range.
trait Beyond: Quantity {
    /// One unit beyond either end.
    fn beyond() -> Vec<Self>;
}

macro_rules! beyond {
    ($($type:ident)*) => {$(
        impl Beyond for $type {
            fn beyond() -> Vec<Self> {
                let (min, max) = (Self::MIN.to_bits(), Self::MAX.to_bits());
                let ends = [min.checked_sub(1), max.checked_add(1)];
                ends.into_iter().flatten().map(Self::from_bits).collect()
            }
        }
    )*};
}

beyond! {
    Acceleration Angle AngularImpulse AngularVelocity Damping Density Force Friction Impulse Inertia Length Mass Mu
    Restitution Torque Velocity
}

/// What a value outside its range is answered with.
fn outside<Q: Quantity>(value: Q) -> String {
    let unit = if Q::UNIT.is_empty() { String::new() } else { format!(" {}", Q::UNIT) };
    format!("{} {value}{unit} is outside {}{unit}", Q::NAME, Q::ACCEPTED)
}

/// What colliders cannot be, and bodies with them.
fn impossible(scene: &Scene) -> Table {
    let far = num::<Length>("16000.5");
    let shape = |shape| vec![ColliderDef::new(shape)];
    let polygon =
        |vertices: &[(f64, f64)]| shape(Shape::Polygon { vertices: vertices.iter().map(|&(x, y)| at(x, y)).collect() });
    let of = |colliders| create(BodyDef { colliders, ..BodyDef::default() });
    let dynamic = scene.dynamic;
    let gyration = "a radius of gyration of 0.0039999999571";
    let mut table = vec![
        (of(shape(Shape::Circle { radius: Length::ZERO })), "colliders[0]: radius 0 m is outside 0.000001 … 16000 m"),
        (of(shape(Shape::Box { width: num("1"), height: far })), "colliders[0]: height 16000.5 m is outside"),
        (of(polygon(&[(0.0, 0.0), (1.0, 0.0)])), "colliders[0]: 2 vertices are outside 3 … 8"),
        (of(polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])), "colliders[0]: vertex 0 is on the line"),
        (of(polygon(&[(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)])), "the polygon is not convex at vertex 2"),
        (of(vec![ColliderDef { offset: at(16_000.0, 0.0), ..disc(500.0) }]), "the collider reaches 16500.00"),
        (
            of(vec![ColliderDef { offset: Vec2::new(far, far), ..disc(1.0) }]),
            "coordinate 16000.5 m is outside ±16000 m",
        ),
    ];
    let center = Some(Vec2::new(far, Length::ZERO));
    table.push((create(BodyDef { center, ..BodyDef::default() }), "center coordinate 16000.5 m is outside ±16000 m"));
    // 4 mm, and the disc reaches 0.5 m.
    let inertia = num("0.000016");
    table.push((Command::SetMass { body: dynamic, mass: num("1"), inertia }, gyration));
    let body =
        BodyDef { mass: Some(num("1")), inertia: Some(inertia), colliders: vec![disc(0.5)], ..BodyDef::default() };
    table.push((create(body), gyration));
    table.into_iter().map(|(command, text)| (command, text.into())).collect()
}

/// Commands that must be refused, and what is said of them: exactly, or in part.
type Table = Vec<(Command, String)>;

/// For each value beyond the range, and each way to hold it, the command that holds it.
fn add<Q: Beyond>(table: &mut Table, commands: impl Fn(Q) -> Vec<Command>) {
    let values = Q::beyond();
    assert!(!values.is_empty());
    for value in values {
        table.extend(commands(value).into_iter().map(|command| (command, outside(value))));
    }
}

/// The same for what a collider holds, the second one of its body.
fn add_collider<Q: Beyond>(table: &mut Table, collider: impl Fn(Q) -> ColliderDef) {
    for value in Q::beyond() {
        let colliders = vec![disc(1.0), collider(value)];
        let command = create(BodyDef { colliders, ..BodyDef::default() });
        table.push((command, format!("colliders[1]: {}", outside(value))));
    }
}

/// The vectors in which one component is `value` and the other 0.
fn either<Q: Default + Copy>(value: Q) -> [Vec2<Q>; 2] {
    [Vec2::new(value, Q::default()), Vec2::new(Q::default(), value)]
}

fn create(def: BodyDef) -> Command {
    Command::CreateBody { def }
}

/// Every value of every command one unit beyond its range.
fn out_of_range(scene: &Scene) -> Table {
    let mut table = Table::new();
    let (body, id) = (scene.dynamic, scene.star);
    let def = BodyDef::default;
    add::<Length>(&mut table, |value| {
        let mut commands = Vec::new();
        for position in either(value) {
            let (force, impulse, attractor) =
                (newtons(1.0, 0.0), newton_seconds(1.0, 0.0), Attractor { position, mu: num("1") });
            commands.extend([
                create(BodyDef { position, ..def() }),
                Command::SetPosition { body, position },
                Command::ApplyForce { body, force, point: Some(position) },
                Command::ApplyImpulse { body, impulse, point: Some(position) },
                Command::CreateAttractor { attractor },
                Command::SetAttractor { id, attractor },
            ]);
        }
        commands
    });
    add::<Angle>(&mut table, |angle| vec![create(BodyDef { angle, ..def() }), Command::SetAngle { body, angle }]);
    add::<Velocity>(&mut table, |value| {
        let commands = |velocity| [create(BodyDef { velocity, ..def() }), Command::SetVelocity { body, velocity }];
        either(value).into_iter().flat_map(commands).collect()
    });
    add::<AngularVelocity>(&mut table, |angular_velocity| {
        vec![create(BodyDef { angular_velocity, ..def() }), Command::SetAngularVelocity { body, angular_velocity }]
    });
    add::<Force>(&mut table, |value| {
        let commands = |force| {
            [
                create(BodyDef { force, ..def() }),
                Command::SetForce { body, force },
                Command::ApplyForce { body, force, point: None },
            ]
        };
        either(value).into_iter().flat_map(commands).collect()
    });
    add::<Torque>(&mut table, |torque| {
        vec![
            create(BodyDef { torque, ..def() }),
            Command::SetTorque { body, torque },
            Command::ApplyTorque { body, torque },
        ]
    });
    let (mass, inertia) = (num("1"), num("1"));
    add::<Mass>(&mut table, |mass| {
        vec![create(BodyDef { mass: Some(mass), ..def() }), Command::SetMass { body, mass, inertia }]
    });
    add::<Inertia>(&mut table, |inertia| {
        vec![create(BodyDef { inertia: Some(inertia), ..def() }), Command::SetMass { body, mass, inertia }]
    });
    add::<Damping>(&mut table, |rate| {
        vec![
            create(BodyDef { linear_damping: rate, ..def() }),
            create(BodyDef { angular_damping: rate, ..def() }),
            Command::SetDamping { body, linear: rate, angular: Damping::ZERO },
            Command::SetDamping { body, linear: Damping::ZERO, angular: rate },
        ]
    });
    let collider = COLLIDER;
    add::<Restitution>(&mut table, |restitution| {
        vec![Command::SetSurface { collider, restitution, friction: num("0") }]
    });
    add::<Friction>(&mut table, |friction| vec![Command::SetSurface { collider, restitution: num("0"), friction }]);
    add_collider(&mut table, |restitution: Restitution| ColliderDef { restitution, ..disc(1.0) });
    add_collider(&mut table, |friction: Friction| ColliderDef { friction, ..disc(1.0) });
    add_collider(&mut table, |density: Density| ColliderDef { density, ..disc(1.0) });
    add_collider(&mut table, |angle: Angle| ColliderDef { angle, ..disc(1.0) });
    add::<Mu>(&mut table, |mu| {
        let attractor = Attractor { position: at(0.0, 0.0), mu };
        vec![
            create(BodyDef { mu, ..def() }),
            Command::SetMu { body, mu },
            Command::CreateAttractor { attractor },
            Command::SetAttractor { id, attractor },
        ]
    });
    add::<Impulse>(&mut table, |value| {
        let command = |impulse| Command::ApplyImpulse { body, impulse, point: None };
        either(value).into_iter().map(command).collect()
    });
    add::<AngularImpulse>(&mut table, |impulse| vec![Command::ApplyAngularImpulse { body, impulse }]);
    add::<Acceleration>(&mut table, |value| {
        either(value).into_iter().map(|gravity| Command::SetGravity { gravity }).collect()
    });
    table
}

/// Every command about a body or an attractor that is gone, or never was.
fn stale(scene: &Scene) -> Table {
    let mut table = Table::new();
    for collider in [
        ColliderId { index: 0, ..COLLIDER },
        ColliderId { index: 2, ..COLLIDER },
        ColliderId { generation: 1, ..COLLIDER },
    ] {
        let (restitution, friction) = (num("0"), num("0"));
        for command in [
            Command::SetSurface { collider, restitution, friction },
            Command::SetFilter { collider, filter: Filter::default() },
        ] {
            table.push((command, format!("there is no collider {}v{}", collider.index, collider.generation)));
        }
    }
    let never = BodyId { index: 1000, generation: 0 };
    let to_come = BodyId { index: scene.dynamic.index, generation: scene.dynamic.generation + 1 };
    for body in [scene.gone, never, to_come] {
        let commands = [
            Command::DestroyBody { body },
            Command::SetKind { body, kind: BodyKind::Static },
            Command::SetPosition { body, position: at(0.0, 0.0) },
            Command::SetAngle { body, angle: Angle::ZERO },
            Command::SetVelocity { body, velocity: vel(0.0, 0.0) },
            Command::SetAngularVelocity { body, angular_velocity: AngularVelocity::ZERO },
            Command::SetForce { body, force: newtons(0.0, 0.0) },
            Command::SetTorque { body, torque: Torque::ZERO },
            Command::SetMass { body, mass: num("1"), inertia: num("1") },
            Command::SetFixedRotation { body, fixed: true },
            Command::SetDamping { body, linear: Damping::ZERO, angular: Damping::ZERO },
            Command::SetMu { body, mu: Mu::ZERO },
            Command::SetUserData { body, user_data: 1 },
            Command::ApplyForce { body, force: newtons(1.0, 0.0), point: None },
            Command::ApplyTorque { body, torque: num("1") },
            Command::ApplyImpulse { body, impulse: newton_seconds(1.0, 0.0), point: None },
            Command::ApplyAngularImpulse { body, impulse: num("1") },
        ];
        table.extend(commands.map(|command| (command, format!("there is no body {}v{}", body.index, body.generation))));
    }
    for id in [scene.gone_star, AttractorId { index: 9, generation: 0 }] {
        let attractor = Attractor { position: at(0.0, 0.0), mu: num("1") };
        for command in [Command::SetAttractor { id, attractor }, Command::DestroyAttractor { id }] {
            table.push((command, format!("there is no attractor {}v{}", id.index, id.generation)));
        }
    }
    table
}

/// What only another kind of body has.
fn wrong_kind(scene: &Scene) -> Table {
    let mut table = Table::new();
    for (body, kind, text) in
        [(scene.resting, BodyKind::Static, "static"), (scene.kinematic, BodyKind::Kinematic, "kinematic")]
    {
        let of = || BodyDef { kind, ..BodyDef::default() };
        let mut no = |quantity: &str, commands: Vec<Command>| {
            let error = format!("a {text} body has no {quantity}");
            table.extend(commands.into_iter().map(|command| (command, error.clone())));
        };
        let (force, torque) = (newtons(0.0, 1.0), Torque::from_bits(1));
        no(
            "force",
            vec![
                create(BodyDef { force, ..of() }),
                Command::SetForce { body, force },
                Command::ApplyForce { body, force, point: None },
                Command::ApplyForce { body, force, point: Some(at(0.0, 1.0)) },
            ],
        );
        no(
            "torque",
            vec![
                create(BodyDef { torque, ..of() }),
                Command::SetTorque { body, torque },
                Command::ApplyTorque { body, torque },
            ],
        );
        no("impulse", vec![Command::ApplyImpulse { body, impulse: newton_seconds(0.0, 1.0), point: None }]);
        no("angular impulse", vec![Command::ApplyAngularImpulse { body, impulse: num("1") }]);
        let rate = Damping::from_bits(1);
        no(
            "damping",
            vec![
                create(BodyDef { linear_damping: rate, ..of() }),
                create(BodyDef { angular_damping: rate, ..of() }),
                Command::SetDamping { body, linear: rate, angular: Damping::ZERO },
                Command::SetDamping { body, linear: Damping::ZERO, angular: rate },
            ],
        );
        if kind == BodyKind::Static {
            let (velocity, angular_velocity) =
                (Vec2::new(Velocity::ZERO, Velocity::from_bits(-1)), AngularVelocity::from_bits(1));
            no("velocity", vec![create(BodyDef { velocity, ..of() }), Command::SetVelocity { body, velocity }]);
            no(
                "angular velocity",
                vec![
                    create(BodyDef { angular_velocity, ..of() }),
                    Command::SetAngularVelocity { body, angular_velocity },
                ],
            );
        }
    }
    let body = scene.fixed;
    let of = || BodyDef { fixed_rotation: true, ..BodyDef::default() };
    let mut no = |quantity: &str, commands: Vec<Command>| {
        let error = format!("a body with fixed rotation has no {quantity}");
        table.extend(commands.into_iter().map(|command| (command, error.clone())));
    };
    let (torque, angular_velocity) = (num("1"), AngularVelocity::from_bits(1));
    no(
        "torque",
        vec![
            create(BodyDef { torque, ..of() }),
            Command::SetTorque { body, torque },
            Command::ApplyTorque { body, torque },
        ],
    );
    no(
        "angular velocity",
        vec![create(BodyDef { angular_velocity, ..of() }), Command::SetAngularVelocity { body, angular_velocity }],
    );
    no("angular impulse", vec![Command::ApplyAngularImpulse { body, impulse: num("1") }]);
    table
}

/// What is in range by itself and leads out of a range.
fn leading_out_of_range(scene: &Scene) -> Table {
    let (body, heavy) = (scene.dynamic, scene.heavy);
    let force = newtons(1e6, 0.0);
    let text = |quantity: &str, value: &str, unit: &str, limit: &str| {
        format!("{quantity} {value} {unit} is outside {limit} {unit}")
    };
    let acceleration = |value: &str| text("acceleration", value, "m/s²", Acceleration::ACCEPTED);
    let angular = |value: &str| text("angular acceleration", value, "rad/s²", Acceleration::ACCEPTED);
    let mut table = vec![
        (create(BodyDef { force, ..BodyDef::default() }), acceleration("1000000")),
        (create(BodyDef { force: newtons(0.0, -32_768.0), ..BodyDef::default() }), acceleration("-32768")),
        (create(BodyDef { torque: num("40000"), ..BodyDef::default() }), angular("40000")),
        (Command::SetForce { body, force }, acceleration("1000000")),
        (Command::SetForce { body, force: newtons(0.0, -40_000.5) }, acceleration("-40000.5")),
        (Command::SetTorque { body, torque: num("-1e6") }, angular("-1000000")),
        // 1 N waits for the tick.
        (Command::ApplyForce { body, force, point: None }, acceleration("1000001")),
        (Command::ApplyTorque { body, torque: num("1e6") }, angular("1000000")),
        // The moment of 30 000 N at 2 m, which is −60 000 N m.
        (Command::ApplyForce { body, force: newtons(30_000.0, 0.0), point: Some(at(1.0, 4.0)) }, angular("-60000")),
        // The force that waits is too much for a lighter body.
        (Command::SetMass { body, mass: num("0.00006103515625"), inertia: num("1000") }, acceleration("32768")),
    ];
    let velocity = |value: &str| text("velocity", value, "m/s", Velocity::ACCEPTED);
    let spin = |value: &str| text("angular velocity", value, "rad/s", AngularVelocity::ACCEPTED);
    let fast = |x, y| Command::ApplyImpulse { body, impulse: newton_seconds(x, y), point: None };
    table.extend([
        (fast(40_000.0, 0.0), velocity("40003")),
        (fast(0.0, -1e14), velocity("-99999999999996")),
        (Command::ApplyAngularImpulse { body, impulse: num("-50000") }, spin("-50000")),
        // The velocity would be accepted, the spin of 3·10¹⁰ rad/s is not.
        (
            Command::ApplyImpulse { body, impulse: newton_seconds(0.0, 30_000.0), point: Some(at(1_000_001.0, 2.0)) },
            spin("30000000000"),
        ),
        // Levers: 3·10⁹ N at 2·10⁹ m, and the same as an impulse.
        (
            Command::ApplyForce { body: heavy, force: newtons(0.0, 3e9), point: Some(at(1e9, 0.0)) },
            text("torque", "6000000000000000000", "N m", "±1e18"),
        ),
        (
            Command::ApplyImpulse { body: heavy, impulse: newton_seconds(0.0, 3e9), point: Some(at(1e9, 0.0)) },
            text("angular impulse", "6000000000000000000", "N m s", "±1e18"),
        ),
        (Command::ApplyImpulse { body: heavy, impulse: newton_seconds(1e14, 0.0), point: None }, String::new()),
        (Command::SetForce { body: heavy, force: newtons(1e14, 0.0) }, String::new()),
        (Command::Input { bytes: vec![0; INPUT_MAX + 1] }, "input of 65537 bytes is longer than 65536".into()),
    ]);
    table
}

/// Asserts that each command is refused with its text, where one is given, and changes nothing.
fn refused(mut world: World, table: Table) {
    let (hash, save) = (world.hash(), world.save());
    assert!(!table.is_empty());
    for (command, text) in table {
        let shown = format!("{command:?}");
        let shown: String = shown.chars().take(200).collect();
        let Err(error) = world.apply(command) else { panic!("{shown} is accepted") };
        assert!(error.to_string().contains(&text), "{shown}: {error}");
        assert_eq!(world.hash(), hash, "{shown}");
        assert_eq!(world.save(), save, "{shown}");
    }
    assert_eq!(world.check(), Ok(()));
    // What is derived has not changed either: the world goes on as one that was never asked.
    let mut other = World::load(&save).expect("just saved");
    for _ in 0..5 {
        world.step();
        other.step();
        assert_eq!(world.hash(), other.hash());
    }
}

#[test]
fn fr_verify_physical_constraints_values_beyond_their_range_change_nothing() {
    let scene = scene();
    let table = out_of_range(&scene);
    println!("{} commands with a value one unit beyond its range", table.len());
    refused(scene.world, table);
}

#[test]
fn fr_verify_physical_constraints_impossible_colliders_change_nothing() {
    let scene = scene();
    let table = impossible(&scene);
    refused(scene.world, table);
}

#[test]
fn a_body_of_too_little_inertia_may_lie_still() {
    let mut world = world(0.0, 0.0);
    let thin = BodyDef {
        mass: Some(num("1")),
        inertia: Some(num("0.000016")),
        colliders: vec![disc(0.5)],
        ..BodyDef::default()
    };
    let resting = world.create_body(&BodyDef { kind: BodyKind::Static, ..thin.clone() }).expect("it does not turn");
    let fixed = world.create_body(&BodyDef { fixed_rotation: true, ..thin.clone() }).expect("it does not turn");
    let hash = world.hash();
    let gyration = |error| matches!(error, CommandError::Body(BodyError::Gyration { .. }));
    assert!(gyration(world.set_kind(resting, BodyKind::Dynamic).expect_err("it would turn")));
    assert!(gyration(world.set_fixed_rotation(fixed, false).expect_err("it would turn")));
    assert_eq!(world.hash(), hash);
    // A sensor collides with nothing, and needs no inertia.
    let colliders = vec![ColliderDef { sensor: true, ..disc(0.5) }];
    world.create_body(&BodyDef { colliders, ..thin }).expect("it only senses");
    let error = BodyDef { colliders: vec![disc(0.0)], ..BodyDef::default() }.check().expect_err("no disc");
    let radius = ShapeError::Size { name: "radius", value: Length::ZERO };
    assert_eq!(error, BodyError::Collider { index: 0, error: radius });
}

#[test]
fn fr_simulation_space_stale_ids_change_nothing() {
    let scene = scene();
    let table = stale(&scene);
    refused(scene.world, table);
}

#[test]
fn fr_verify_physical_constraints_values_of_another_kind_change_nothing() {
    let scene = scene();
    let table = wrong_kind(&scene);
    refused(scene.world, table);
}

#[test]
fn fr_verify_physical_constraints_values_that_lead_out_of_range_change_nothing() {
    let mut scene = scene();
    scene.world.set_velocity(scene.dynamic, vel(3.0, 4.0)).expect("accepted");
    scene.world.set_position(scene.dynamic, at(1.0, 2.0)).expect("accepted");
    let table = leading_out_of_range(&scene);
    refused(scene.world, table);
}

#[test]
fn forces_of_one_tick_that_add_up_beyond_their_range_change_nothing() {
    let mut scene = scene();
    let heavy = scene.heavy;
    scene.world.apply_force(heavy, newtons(6e13, -6e13), None).expect("accepted");
    scene.world.apply_torque(heavy, num("6e17")).expect("accepted");
    let again = |x, y| Command::ApplyForce { body: heavy, force: newtons(x, y), point: None };
    let table = vec![
        (again(6e13, 0.0), "force 120000000000000 N is outside ±1e14 N".into()),
        (again(0.0, -6e13), "force -120000000000000 N is outside ±1e14 N".into()),
        (
            Command::ApplyTorque { body: heavy, torque: num("6e17") },
            "torque 1200000000000000000 N m is outside ±1e18 N m".into(),
        ),
    ];
    refused(scene.world.clone(), table);
    // In the other direction there is room.
    scene.world.apply_force(heavy, newtons(-6e13, 6e13), None).expect("accepted");
    scene.world.apply_torque(heavy, num("-6e17")).expect("accepted");
}

#[test]
fn a_lever_too_long_is_refused_whatever_the_direction_of_the_force() {
    let mut scene = scene();
    let heavy = scene.heavy;
    scene.world.set_position(heavy, at(-1e9, 0.0)).expect("accepted");
    let mut table = Table::new();
    // Both products of r × F are beyond the format; their difference is 6·10²² N m, 1.2·10²³ and so on.
    for (fx, fy, x, y) in [
        (6e13, 6e13, 1e9, 1e9),
        (-6e13, -6e13, 1e9, 1e9),
        (6e13, 3e13, 1e9, -1e9),
        (1e13, 1e13, 1e9, 1e3),
        (2e13, 1e13, 1e9, 9.9e8),
    ] {
        let point = Some(at(x, y));
        table.push((Command::ApplyForce { body: heavy, force: newtons(fx, fy), point }, String::new()));
        table.push((Command::ApplyImpulse { body: heavy, impulse: newton_seconds(fx, fy), point }, String::new()));
    }
    refused(scene.world.clone(), table);

    // A force along its lever has no moment, however large both are; nor does a small moment get lost in large products.
    let (mut world, point) = (scene.world, Some(at(1e9, 1e9)));
    world.apply_force(heavy, newtons(6e13, 3e13), point).expect("it has no moment");
    world.apply_impulse(heavy, newton_seconds(6e13, 3e13), point).expect("it has no moment");
    assert_eq!(world.body(heavy).expect("it exists").angular_velocity(), AngularVelocity::ZERO);
    world.apply_impulse(heavy, newton_seconds(-6e13 - 3e8, -3e13), point).expect("3·10¹⁷ N m s on 10¹⁸ kg m²");
    assert_eq!(world.body(heavy).expect("it exists").angular_velocity(), num("0.3"));
}

#[test]
fn errors_carry_the_value_and_the_limit() {
    let mut scene = scene();
    let error = scene.world.set_mass(scene.dynamic, Mass::ZERO, num("1")).expect_err("no mass");
    let value = Decimal { bits: 0, frac: Mass::FRAC };
    let range = RangeError { quantity: "mass", unit: "kg", value, accepted: "0.000001 … 2100000000" };
    assert_eq!(error, CommandError::Body(BodyError::Range(range)));
    assert_eq!(error.to_string(), "mass 0 kg is outside 0.000001 … 2100000000 kg");

    let error = scene.world.set_velocity(scene.resting, vel(1.0, 0.0)).expect_err("it is static");
    assert_eq!(error, CommandError::Body(BodyError::Kind { quantity: "velocity", kind: BodyKind::Static }));
    let error = scene.world.apply_torque(scene.fixed, num("1")).expect_err("it does not turn");
    assert_eq!(error, CommandError::Body(BodyError::FixedRotation { quantity: "torque" }));
    let error = scene.world.destroy_body(scene.gone).expect_err("it is gone");
    assert_eq!(error, CommandError::NoSuchBody(scene.gone));
    let error = scene.world.destroy_attractor(scene.gone_star).expect_err("it is gone");
    assert_eq!(error, CommandError::NoSuchAttractor(scene.gone_star));
    let error = scene.world.input(vec![0; INPUT_MAX + 1]).expect_err("too long");
    assert_eq!(error, CommandError::InputTooLong { length: INPUT_MAX as u64 + 1 });
    scene.world.input(vec![0; INPUT_MAX]).expect("just short enough");
    // A `BodyDef` can be asked before there is a world.
    let error = BodyDef { mass: Some(Mass::from_bits(-1)), ..BodyDef::default() }.check().expect_err("negative");
    assert_eq!(error.to_string(), outside(Mass::from_bits(-1)));
    // A μ that does not fit the widest integer of messages is refused all the same.
    let mu = Mu::from_bits(u128::MAX);
    assert!(scene.world.set_mu(scene.dynamic, mu).is_err());
    let full = CommandError::Full { what: "bodies", limit: 1 << 24 };
    assert_eq!(full.to_string(), "there are 16777216 bodies, which is the most there can be");
}

#[test]
fn fr_verify_physical_constraints_worlds() {
    let new = |def: WorldDef| World::new(&def).map(|_| ());
    for tick_rate in [0, 1, 14, 1001, u32::MAX] {
        let error = new(WorldDef { tick_rate, ..WorldDef::default() }).expect_err("outside");
        assert_eq!(error, ConfigError::TickRate { value: tick_rate });
        assert_eq!(error.to_string(), format!("tick_rate {tick_rate} 1/s is outside 15 … 1000 1/s"));
    }
    for substeps in [0, 65, u32::MAX] {
        let error = new(WorldDef { substeps, ..WorldDef::default() }).expect_err("outside");
        assert_eq!(error, ConfigError::Substeps { value: substeps });
        assert_eq!(error.to_string(), format!("substeps {substeps} is outside 1 … 64"));
    }
    let low = Acceleration::from_bits(i64::MIN);
    for unit_shift in [11, u32::MAX] {
        let error = new(WorldDef { unit_shift, ..WorldDef::default() }).expect_err("outside");
        assert_eq!(error, ConfigError::UnitShift { value: unit_shift });
        assert_eq!(error.to_string(), format!("unit_shift {unit_shift} is outside 0 … 10"));
    }
    for gravity in either(low) {
        let error = new(WorldDef { gravity, ..WorldDef::default() }).expect_err("outside");
        assert_eq!(error.to_string(), outside(low));
    }
    for (tick_rate, substeps) in [(15, 1), (15, 64), (1000, 1), (1000, 64)] {
        assert_eq!(new(WorldDef { tick_rate, substeps, ..WorldDef::default() }), Ok(()));
    }
}

/// A body of 1 kg whose every value is given, as [`tamias2d::Body::def`] gives it.
fn explicit() -> BodyDef {
    BodyDef { mass: Some(num("1")), inertia: Some(num("1")), center: Some(at(0.0, 0.0)), ..BodyDef::default() }
}

/// Bodies at the edges of what is accepted, each alone at it and all together.
fn edges() -> Vec<BodyDef> {
    let mut defs = Vec::new();
    let def = explicit;
    for ends in [[Length::MIN, Length::MAX], [Length::MAX, Length::MIN]] {
        defs.push(BodyDef { position: Vec2::new(ends[0], ends[1]), ..def() });
    }
    for bits in [i64::MAX, -i64::MAX] {
        let (v, w) = (Velocity::from_bits(bits), AngularVelocity::from_bits(bits));
        defs.push(BodyDef { velocity: Vec2::new(v, v), ..def() });
        defs.push(BodyDef { angular_velocity: w, angle: Angle::from_bits(-bits), ..def() });
        defs.push(BodyDef { angle: Angle::from_bits(bits), angular_velocity: w, ..def() });
        defs.push(BodyDef {
            kind: BodyKind::Kinematic,
            velocity: Vec2::new(v, v),
            angular_velocity: w,
            angle: Angle::from_bits(bits),
            position: Vec2::new(Length::MAX, Length::MIN),
            ..def()
        });
    }
    for mass in [Mass::MIN, Mass::MAX] {
        for inertia in [Inertia::MIN, Inertia::MAX] {
            defs.push(BodyDef { mass: Some(mass), inertia: Some(inertia), ..def() });
            for rate in [Damping::from_bits(1), Damping::MAX] {
                defs.push(BodyDef {
                    mass: Some(mass),
                    inertia: Some(inertia),
                    linear_damping: rate,
                    angular_damping: rate,
                    velocity: Vec2::new(Velocity::MAX, Velocity::MIN),
                    angular_velocity: AngularVelocity::MIN,
                    ..def()
                });
            }
        }
    }
    // The greatest accelerations: 32 767.5 m/s² and rad/s² of the lightest and of the heaviest.
    for (mass, force) in [("0.000001", 0.0327675), ("2100000000", 2.1e9 * 32_767.5)] {
        defs.push(BodyDef { mass: Some(num(mass)), force: newtons(force, -force), ..def() });
    }
    defs.push(BodyDef { inertia: Some(Inertia::MAX), torque: Torque::MAX, ..def() });
    defs.push(BodyDef { inertia: Some(Inertia::MIN), torque: num("3.27675e-8"), ..def() });
    for mu in [Mu::from_bits(1), Mu::MAX] {
        defs.push(BodyDef { mu, position: at(12.0, 5.0), ..def() });
    }
    defs
}

#[test]
fn values_at_the_edges_of_their_ranges_are_accepted_and_do_no_harm() {
    let configs = [(15, 1), (60, 4), (1000, 1)].map(|(tick_rate, substeps)| WorldDef {
        tick_rate,
        substeps,
        ..WorldDef::default()
    });
    let gravities = [(0.0, 0.0), (32_767.9, -32_767.9)];
    for config in configs {
        for integrator in [Integrator::ForestRuth, Integrator::SymplecticEuler] {
            for gravity in gravities {
                let gravity = acc(gravity.0, gravity.1);
                let config = WorldDef { integrator, gravity, ..config.clone() };
                let mut all = World::new(&config).expect("accepted");
                for def in edges() {
                    let mut world = World::new(&config).expect("accepted");
                    for world in [&mut world, &mut all] {
                        let id = world.create_body(&def).expect("at the edge");
                        assert_eq!(world.body(id).expect("it exists").def(), def);
                    }
                    for _ in 0..100 {
                        world.step();
                        assert_eq!(world.check(), Ok(()), "{def:?}");
                    }
                }
                for place in [Vec2::new(Length::MIN, Length::MIN), Vec2::new(Length::MAX, Length::MIN), at(0.0, 0.0)] {
                    for mu in [Mu::MAX, Mu::from_bits(1), Mu::ZERO] {
                        all.create_attractor(Attractor { position: place, mu }).expect("at the edge");
                    }
                }
                for _ in 0..100 {
                    all.step();
                    assert_eq!(all.check(), Ok(()));
                }
                assert_eq!(World::load(&all.save()).expect("just saved").hash(), all.hash());
            }
        }
    }
}

#[test]
fn the_ends_that_messages_print_are_accepted() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&BodyDef::default()).expect("accepted");
    for (mass, inertia) in [("0.000001", "1e-12"), ("2100000000", "1e18")] {
        let (mass, inertia) = (mass.parse::<Mass>(), inertia.parse::<Inertia>());
        world.set_mass(id, mass.expect("as printed"), inertia.expect("as printed")).expect("as printed");
    }
    for torque in ["-1e18", "1e18"] {
        world.set_torque(id, num(torque)).expect("as printed");
        world.apply_angular_impulse(id, num(torque)).expect("as printed");
    }
    world.set_damping(id, num("0"), num("1000")).expect("as printed");
    world.set_mu(id, num("2e21")).expect("as printed");
    world.set_position(id, Vec2::new(num("-1000000000"), num("1000000000"))).expect("as printed");
    assert_eq!((num::<Force>("1e14"), num::<Force>("-1e14")), (Force::MAX, Force::MIN));
    assert_eq!((num::<Impulse>("1e14"), num::<Impulse>("-1e14")), (Impulse::MAX, Impulse::MIN));
}

#[test]
fn impulses_at_the_edges_are_accepted() {
    let mut world = world(0.0, 0.0);
    let id = world.create_body(&BodyDef::default()).expect("accepted");
    let most = Impulse::from_bits(i128::from(i64::MAX) << 16);
    world.apply_impulse(id, Vec2::new(most, Impulse::ZERO), None).expect("to the limit");
    assert_eq!(world.body(id).expect("it exists").velocity().x, Velocity::MAX);
    let one = Impulse::from_bits(1 << 16);
    let (hash, save) = (world.hash(), world.save());
    assert!(world.apply_impulse(id, Vec2::new(one, Impulse::ZERO), None).is_err());
    assert_eq!((world.hash(), world.save()), (hash, save));
    // Back across the whole range at once.
    let back = Impulse::from_bits(-(i128::from(i64::MAX) << 17));
    world.apply_impulse(id, Vec2::new(back, Impulse::ZERO), None).expect("to the other limit");
    assert_eq!(world.body(id).expect("it exists").velocity().x, Velocity::MIN);
    let spin = AngularImpulse::from_bits(-(i128::from(i64::MAX) << 16));
    world.apply_angular_impulse(id, spin).expect("to the limit");
    assert_eq!(world.body(id).expect("it exists").angular_velocity(), AngularVelocity::MIN);
    assert!(world.apply_angular_impulse(id, AngularImpulse::from_bits(-(1 << 16))).is_err());
}

#[test]
fn a_change_of_kind_takes_what_the_new_kind_does_not_have() {
    let def = BodyDef {
        velocity: vel(1.0, 2.0),
        angular_velocity: num("3"),
        force: newtons(4.0, 5.0),
        torque: num("6"),
        linear_damping: num("7"),
        angular_damping: num("8"),
        mu: num("9"),
        ..explicit()
    };
    let mut world = world(0.0, -9.8);
    let id = world.create_body(&def).expect("accepted");
    world.apply_force(id, newtons(1.0, 1.0), Some(at(1.0, 0.0))).expect("accepted");
    let none = BodyDef {
        force: newtons(0.0, 0.0),
        torque: Torque::ZERO,
        linear_damping: Damping::ZERO,
        angular_damping: Damping::ZERO,
        ..def.clone()
    };
    let mut kinematic = world.clone();
    kinematic.set_kind(id, BodyKind::Kinematic).expect("accepted");
    let want = BodyDef { kind: BodyKind::Kinematic, ..none.clone() };
    assert_eq!(kinematic.body(id).expect("it exists").def(), want);
    world.set_kind(id, BodyKind::Static).expect("accepted");
    let want =
        BodyDef { kind: BodyKind::Static, velocity: vel(0.0, 0.0), angular_velocity: AngularVelocity::ZERO, ..none };
    assert_eq!(world.body(id).expect("it exists").def(), want);
    for mut world in [world, kinematic] {
        let spin = world.body(id).expect("it exists").angular_velocity();
        for _ in 0..10 {
            assert_eq!(world.check(), Ok(()));
            world.step();
        }
        assert_eq!(world.body(id).expect("it exists").angular_velocity(), spin, "the force of a tick is gone");
        world.set_kind(id, BodyKind::Dynamic).expect("accepted");
        world.step();
        assert_eq!(world.check(), Ok(()));
    }
}

#[test]
fn zero_is_accepted_where_only_zero_is() {
    let mut scene = scene();
    for body in [scene.resting, scene.kinematic, scene.fixed] {
        scene.world.set_angular_velocity(body, AngularVelocity::ZERO).expect("zero");
        scene.world.set_torque(body, Torque::ZERO).expect("zero");
    }
    for body in [scene.resting, scene.kinematic] {
        scene.world.set_force(body, newtons(0.0, 0.0)).expect("zero");
        scene.world.set_damping(body, Damping::ZERO, Damping::ZERO).expect("zero");
        scene.world.set_velocity(body, vel(0.0, 0.0)).expect("zero");
    }
}
