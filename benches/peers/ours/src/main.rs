//! This project's engine behind the peers' protocol. `--substeps N`: other substeps than the default.

use peer_scenes::runner::{Cost, Engine, Snapshot, State, WINDOW, count, run};
use peer_scenes::{Body, Geom, Kind, Scene, V};
use std::time::Instant;
use tamias2d::{
    Angle, AngularVelocity, BodyDef, BodyId, BodyKind, ColliderDef, Commands, Density, Friction, Length, Restitution,
    Rollback, Shape, Vec2, World, WorldDef,
};

struct Ours {
    world: World,
    ids: Vec<BodyId>,
    ring: Rollback,
    /// The tick that was kept as the first of the rollback.
    first: u64,
}

const RANGE: &str = "scenes are in range";

fn at([x, y]: V) -> Vec2<Length> {
    Vec2::from_f64(x, y).expect(RANGE)
}

fn length(metres: f64) -> Length {
    Length::from_f64(metres).expect(RANGE)
}

fn collider(scene: &Scene, body: &Body, geom: &Geom) -> ColliderDef {
    let shape = match geom {
        Geom::Box(x, y) => Shape::Box { width: length(2.0 * x), height: length(2.0 * y) },
        Geom::Circle(r) => Shape::Circle { radius: length(*r) },
        Geom::Poly(corners) => Shape::Polygon { vertices: corners.iter().map(|&corner| at(corner)).collect() },
    };
    let mut def = ColliderDef::new(shape);
    def.density = Density::from_f64(body.density).expect(RANGE);
    def.friction = Friction::from_f64(scene.friction).expect(RANGE);
    def.restitution = Restitution::from_f64(scene.restitution).expect(RANGE);
    if !body.collide {
        (def.filter.category, def.filter.mask) = (0, 0);
    }
    def
}

fn build(scene: &Scene, args: &[String]) -> Result<Ours, &'static str> {
    if !scene.hinges.is_empty() {
        return Err("hinges");
    }
    let [gx, gy] = scene.gravity;
    let without = WorldDef::default();
    let mut world = World::new(&WorldDef {
        gravity: Vec2::from_f64(gx, gy).expect(RANGE),
        tick_rate: (1.0 / scene.dt).round() as u32,
        substeps: count(args, "--substeps", without.substeps as usize) as u32,
        ..without
    })
    .expect(RANGE);
    let create = |body: &Body| {
        let kind = match body.kind {
            Kind::Static => BodyKind::Static,
            Kind::Dynamic => BodyKind::Dynamic,
            Kind::Kinematic => BodyKind::Kinematic,
        };
        let def = BodyDef {
            kind,
            position: at(body.pos),
            velocity: Vec2::from_f64(body.vel[0], body.vel[1]).expect(RANGE),
            angle: Angle::from_radians_f64(body.angle.rem_euclid(std::f64::consts::TAU)).expect(RANGE),
            angular_velocity: AngularVelocity::from_f64(body.omega).expect(RANGE),
            colliders: body.shapes.iter().map(|geom| collider(scene, body, geom)).collect(),
            ..BodyDef::default()
        };
        world.create_body(&def).expect(RANGE)
    };
    let ids = scene.bodies.iter().map(create).collect();
    Ok(Ours { world, ids, ring: Rollback::new(WINDOW as u32), first: 0 })
}

impl Engine for Ours {
    fn id(&self) -> (String, String) {
        ("ours".into(), "tamias2d".into())
    }

    fn step(&mut self) {
        self.world.step();
    }

    fn state(&self, body: usize) -> State {
        let body = self.world.body(self.ids[body]).expect("nothing is destroyed");
        let ((x, y), (vx, vy)) = (body.position().to_f64(), body.velocity().to_f64());
        [x, y, body.angle().to_radians_f64(), vx, vy, body.angular_velocity().to_f64()]
    }

    fn keep(&mut self, at: usize) {
        self.ring.save(&self.world);
        if at == 0 {
            self.first = self.world.tick();
        }
    }

    fn back(&mut self, at: usize) {
        self.ring.restore(&mut self.world, self.first + at as u64).expect("it was kept");
    }

    fn snapshot(&mut self, reps: usize, probe: &mut dyn FnMut(&mut Self) -> u64) -> Snapshot {
        let time = |work: &mut dyn FnMut()| {
            let begin = Instant::now();
            work();
            begin.elapsed().as_nanos() as u64
        };
        let (mut save, mut load, mut keep, mut back) = (vec![], vec![], vec![], vec![]);
        let (mut bytes, mut kept) = (Vec::new(), self.world.clone());
        let mut loaded = None;
        for _ in 0..reps {
            save.push(time(&mut || self.world.save_into(&mut bytes)));
            load.push(time(&mut || loaded = Some(World::load(&bytes))));
            keep.push(time(&mut || kept.clone_from(&self.world)));
        }
        let loaded = loaded.expect("one repetition at least").expect("just saved");
        let resaved = loaded.save() == bytes;
        let straight = probe(self);
        for _ in 0..reps {
            (0..8).for_each(|_| self.world.step());
            back.push(time(&mut || self.world.clone_from(&kept)));
        }
        let from_copy = probe(self);
        self.world = loaded;
        let from_bytes = probe(self);
        let size = bytes.len();
        (
            vec![
                Cost { name: "save", ns: save, bytes: size },
                Cost { name: "load", ns: load, bytes: size },
                Cost { name: "copy", ns: keep, bytes: 0 },
                Cost { name: "copy back after 8 steps", ns: back, bytes: 0 },
            ],
            vec![
                ("saved again: the same bytes", resaved),
                ("goes on the same from a copy", straight == from_copy),
                ("goes on the same from bytes", straight == from_bytes),
            ],
        )
    }
}

fn main() {
    run(build);
}
