//! Box2D 3 by its C interface, behind the peers' protocol. `--substeps N`: other substeps than its default of 4.
//!
//! Sleeping is off, and the speed below which nothing bounces is 0 instead of 1 m/s: else it could not be compared.

use boxdd_sys::ffi::*;
use peer_scenes::runner::{Cost, Engine, Snapshot, State, WINDOW, count, run};
use peer_scenes::{Geom, Kind, Scene};
use std::time::Instant;

struct B2 {
    world: b2WorldId,
    bodies: Vec<b2BodyId>,
    dt: f32,
    substeps: i32,
    /// Images of the world, and how long each is.
    kept: Vec<(Vec<u8>, i32)>,
}

fn v(p: [f64; 2]) -> b2Vec2 {
    b2Vec2 { x: p[0] as f32, y: p[1] as f32 }
}

fn rot(a: f64) -> b2Rot {
    b2Rot { c: a.cos() as f32, s: a.sin() as f32 }
}

fn build(s: &Scene, args: &[String]) -> Result<B2, &'static str> {
    let substeps = count(args, "--substeps", 4) as i32;
    unsafe {
        let mut wd = b2DefaultWorldDef();
        wd.gravity = v(s.gravity);
        wd.enableSleep = false;
        wd.workerCount = 1;
        wd.restitutionThreshold = 0.0;
        let world = b2CreateWorld(&wd);
        let mut bodies = vec![];
        for b in &s.bodies {
            let mut d = b2DefaultBodyDef();
            d.type_ = match b.kind {
                Kind::Static => b2BodyType_b2_staticBody,
                Kind::Dynamic => b2BodyType_b2_dynamicBody,
                Kind::Kinematic => b2BodyType_b2_kinematicBody,
            };
            d.position = b2Pos { x: b.pos[0] as _, y: b.pos[1] as _ };
            d.rotation = rot(b.angle);
            d.linearVelocity = v(b.vel);
            d.angularVelocity = b.omega as f32;
            d.enableSleep = false;
            let id = b2CreateBody(world, &d);
            for g in &b.shapes {
                let mut sd = b2DefaultShapeDef();
                sd.density = b.density as f32;
                sd.material.friction = s.friction as f32;
                sd.material.restitution = s.restitution as f32;
                if !b.collide {
                    sd.filter.maskBits = 0;
                }
                match g {
                    Geom::Box(x, y) => {
                        let p = b2MakeBox(*x as f32, *y as f32);
                        b2CreatePolygonShape(id, &sd, &p);
                    }
                    Geom::Circle(r) => {
                        let c = b2Circle { center: v([0.0, 0.0]), radius: *r as f32 };
                        b2CreateCircleShape(id, &sd, &c);
                    }
                    Geom::Poly(pts) => {
                        let f: Vec<b2Vec2> = pts.iter().map(|p| v(*p)).collect();
                        let h = b2ComputeHull(f.as_ptr(), f.len() as i32);
                        assert_eq!(h.count as usize, f.len(), "hull lost a vertex");
                        let p = b2MakePolygon(&h, 0.0);
                        b2CreatePolygonShape(id, &sd, &p);
                    }
                }
            }
            bodies.push(id);
        }
        for h in &s.hinges {
            let mut d = b2DefaultRevoluteJointDef();
            d.base.bodyIdA = bodies[h.a];
            d.base.bodyIdB = bodies[h.b];
            d.base.localFrameA.p = v(h.la);
            d.base.localFrameB.p = v(h.lb);
            b2CreateRevoluteJoint(world, &d);
        }
        Ok(B2 { world, bodies, dt: s.dt as f32, substeps, kept: vec![(vec![], 0); WINDOW] })
    }
}

impl Engine for B2 {
    fn id(&self) -> (String, String) {
        let name = if cfg!(feature = "double") {
            "box2d-double"
        } else if cfg!(feature = "avx2") {
            "box2d-avx2"
        } else {
            "box2d"
        };
        let v = unsafe { b2GetVersion() };
        (name.into(), format!("Box2D {}.{}.{}-dev, boxdd-sys 0.6.0", v.major, v.minor, v.revision))
    }

    fn step(&mut self) {
        unsafe { b2World_Step(self.world, self.dt, self.substeps) }
    }

    fn state(&self, b: usize) -> State {
        unsafe {
            let id = self.bodies[b];
            let (p, q) = (b2Body_GetPosition(id), b2Body_GetRotation(id));
            let (l, w) = (b2Body_GetLinearVelocity(id), b2Body_GetAngularVelocity(id));
            [p.x as f64, p.y as f64, (q.s as f64).atan2(q.c as f64), l.x as f64, l.y as f64, w as f64]
        }
    }

    fn keep(&mut self, at: usize) {
        let (image, length) = &mut self.kept[at];
        // Into memory that is used again; asked for its size only where that does not do.
        unsafe {
            *length = b2World_Snapshot(self.world, image.as_mut_ptr(), image.len() as i32);
            if *length == 0 || *length > image.len() as i32 {
                let need = b2World_Snapshot(self.world, std::ptr::null_mut(), 0);
                image.resize(need as usize + need as usize / 4, 0);
                *length = b2World_Snapshot(self.world, image.as_mut_ptr(), image.len() as i32);
            }
        }
        assert!(*length > 0, "Box2D refuses to save");
    }

    fn back(&mut self, at: usize) {
        let (image, length) = &self.kept[at];
        assert!(unsafe { b2World_Restore(self.world, image.as_ptr(), *length) }, "Box2D refuses its own image");
    }

    fn snapshot(&mut self, reps: usize, probe: &mut dyn FnMut(&mut Self) -> u64) -> Snapshot {
        unsafe {
            let need = b2World_Snapshot(self.world, std::ptr::null_mut(), 0);
            let mut image = vec![0u8; need as usize];
            let (mut save, mut load) = (vec![], vec![]);
            for _ in 0..reps {
                let t = Instant::now();
                let n = b2World_Snapshot(self.world, image.as_mut_ptr(), need);
                save.push(t.elapsed().as_nanos() as u64);
                assert_eq!(n, need);
            }
            let h0 = probe(self);
            let mut ok = true;
            for _ in 0..reps {
                let t = Instant::now();
                ok &= b2World_Restore(self.world, image.as_ptr(), need);
                load.push(t.elapsed().as_nanos() as u64);
            }
            // What a rollback pays: restoring into a world that has moved on.
            let mut back = vec![];
            for _ in 0..reps {
                for _ in 0..8 {
                    self.step();
                }
                let t = Instant::now();
                ok &= b2World_Restore(self.world, image.as_ptr(), need);
                back.push(t.elapsed().as_nanos() as u64);
            }
            let mut again = vec![0u8; need as usize];
            let n2 = b2World_Snapshot(self.world, again.as_mut_ptr(), need);
            let h1 = probe(self);
            (
                vec![
                    Cost { name: "save", ns: save, bytes: need as usize },
                    Cost { name: "load", ns: load, bytes: need as usize },
                    Cost { name: "load after 8 steps", ns: back, bytes: need as usize },
                ],
                vec![
                    ("loads", ok),
                    ("saved again: the same bytes", n2 == need && again == image),
                    ("goes on the same from bytes", h0 == h1),
                ],
            )
        }
    }
}

fn main() {
    run(build);
}
