//! Rapier behind the peers' protocol. `--substeps N`: other solver iterations than its default of 4. Sleeping is off.

use peer_scenes::runner::{Cost, Engine, Snapshot, State, WINDOW, count, run};
use peer_scenes::{Geom, Kind, Scene};
use rapier2d::prelude::*;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Everything the documentation says a snapshot must hold.
#[derive(Clone, Serialize, Deserialize)]
struct Saved {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    ccd_solver: CCDSolver,
    integration_parameters: IntegrationParameters,
    gravity: Vector,
}

struct Ra {
    w: Saved,
    pipeline: PhysicsPipeline,
    handles: Vec<RigidBodyHandle>,
    kept: Vec<Option<Saved>>,
}

fn v(p: [f64; 2]) -> Vector {
    Vector::new(p[0] as f32, p[1] as f32)
}

fn build(s: &Scene, args: &[String]) -> Result<Ra, &'static str> {
    let mut ip = IntegrationParameters::default();
    ip.dt = s.dt as f32;
    ip.num_solver_iterations = count(args, "--substeps", ip.num_solver_iterations);
    let mut w = Saved {
        islands: IslandManager::new(),
        broad_phase: BroadPhaseBvh::default(),
        narrow_phase: NarrowPhase::new(),
        bodies: RigidBodySet::new(),
        colliders: ColliderSet::new(),
        impulse_joints: ImpulseJointSet::new(),
        multibody_joints: MultibodyJointSet::new(),
        soft_bodies: SoftBodySet::default(),
        ccd_solver: CCDSolver::new(),
        integration_parameters: ip,
        gravity: v(s.gravity),
    };
    let mut handles = vec![];
    for b in &s.bodies {
        let rb = match b.kind {
            Kind::Static => RigidBodyBuilder::fixed(),
            Kind::Dynamic => RigidBodyBuilder::dynamic(),
            Kind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
        }
        .translation(v(b.pos))
        .rotation(b.angle as f32)
        .linvel(v(b.vel))
        .angvel(b.omega as f32)
        .can_sleep(false);
        let h = w.bodies.insert(rb);
        for g in &b.shapes {
            let c = match g {
                Geom::Box(x, y) => ColliderBuilder::cuboid(*x as f32, *y as f32),
                Geom::Circle(r) => ColliderBuilder::ball(*r as f32),
                Geom::Poly(p) => ColliderBuilder::convex_polyline(p.iter().map(|p| v(*p)).collect()).unwrap(),
            };
            let mut c = c.density(b.density as f32).friction(s.friction as f32).restitution(s.restitution as f32);
            if !b.collide {
                c = c.collision_groups(InteractionGroups::none());
            }
            w.colliders.insert_with_parent(c, h, &mut w.bodies);
        }
        handles.push(h);
    }
    for j in &s.hinges {
        let joint = RevoluteJointBuilder::new().local_anchor1(v(j.la)).local_anchor2(v(j.lb)).contacts_enabled(false);
        w.impulse_joints.insert(handles[j.a], handles[j.b], joint, true);
    }
    Ok(Ra { w, pipeline: PhysicsPipeline::new(), handles, kept: vec![None; WINDOW] })
}

impl Engine for Ra {
    fn id(&self) -> (String, String) {
        let name = if cfg!(feature = "det") { "rapier-det" } else { "rapier" };
        (name.into(), "rapier2d 0.36.1".into())
    }

    fn step(&mut self) {
        let w = &mut self.w;
        self.pipeline.step(
            w.gravity,
            &w.integration_parameters,
            &mut w.islands,
            &mut w.broad_phase,
            &mut w.narrow_phase,
            &mut w.bodies,
            &mut w.colliders,
            &mut w.impulse_joints,
            &mut w.multibody_joints,
            &mut w.soft_bodies,
            &mut w.ccd_solver,
            &(),
            &(),
        );
    }

    fn state(&self, b: usize) -> State {
        let rb = &self.w.bodies[self.handles[b]];
        let (p, q, l) = (rb.translation(), rb.rotation(), rb.linvel());
        [p.x as f64, p.y as f64, (q.im as f64).atan2(q.re as f64), l.x as f64, l.y as f64, rb.angvel() as f64]
    }

    fn keep(&mut self, at: usize) {
        self.kept[at] = Some(self.w.clone());
    }

    fn back(&mut self, at: usize) {
        self.w = self.kept[at].clone().expect("it was kept");
    }

    fn snapshot(&mut self, reps: usize, probe: &mut dyn FnMut(&mut Self) -> u64) -> Snapshot {
        let config = bincode::config::legacy();
        let encode = |w: &Saved| bincode::serde::encode_to_vec(w, config).expect("it is serialisable");
        let time = |work: &mut dyn FnMut()| {
            let begin = Instant::now();
            work();
            begin.elapsed().as_nanos() as u64
        };
        let (mut copy, mut save, mut load, mut back) = (vec![], vec![], vec![], vec![]);
        let (mut kept, mut bytes, mut loaded) = (self.w.clone(), vec![], None);
        for _ in 0..reps {
            copy.push(time(&mut || kept = self.w.clone()));
            save.push(time(&mut || bytes = encode(&self.w)));
            load.push(time(&mut || loaded = Some(bincode::serde::decode_from_slice(&bytes, config))));
        }
        let (loaded, _): (Saved, usize) = loaded.expect("one repetition at least").expect("just saved");
        let resaved = encode(&loaded) == bytes;
        let straight = probe(self);
        for _ in 0..reps {
            (0..8).for_each(|_| self.step());
            back.push(time(&mut || self.w = kept.clone()));
        }
        let from_copy = probe(self);
        // Another process would have another pipeline.
        (self.w, self.pipeline) = (loaded, PhysicsPipeline::new());
        let from_bytes = probe(self);
        let size = bytes.len();
        (
            vec![
                Cost { name: "save", ns: save, bytes: size },
                Cost { name: "load", ns: load, bytes: size },
                Cost { name: "copy", ns: copy, bytes: 0 },
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
