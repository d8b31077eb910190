//! Looking at a body.

use super::Collider;
use crate::World;
use crate::body::{BodyData, BodyDef, BodyKind, origin_of};
use crate::geom::{Rot, Vec2};
use crate::num::{Angle, AngularVelocity, Energy, Length, Mass, Velocity, mul_add, mul_div};
use crate::store::BodyId;

/// A body of a world, to look at.
#[derive(Clone, Copy)]
pub struct Body<'w> {
    pub(super) world: &'w World,
    pub(super) slot: usize,
}

impl Body<'_> {
    fn data(&self) -> &BodyData {
        self.world.bodies.cold.value(self.slot)
    }

    /// Its id.
    pub fn id(&self) -> BodyId {
        let generation = self.world.bodies.cold.generation(self.slot).unwrap_or(u32::MAX);
        BodyId { index: self.slot as u32, generation }
    }

    /// Everything about it, as it could be created anew.
    pub fn def(&self) -> BodyDef {
        let data = self.data();
        BodyDef {
            kind: data.kind,
            position: self.position(),
            angle: self.angle(),
            velocity: self.velocity(),
            angular_velocity: self.angular_velocity(),
            force: data.force,
            torque: data.torque,
            mass: Some(data.mass),
            inertia: Some(data.inertia),
            center: Some(data.center),
            fixed_rotation: data.fixed_rotation,
            linear_damping: data.linear_damping,
            angular_damping: data.angular_damping,
            mu: data.mu,
            user_data: data.user_data,
            allow_sleep: data.allow_sleep,
            colliders: self.colliders().map(|collider| collider.def()).collect(),
        }
    }

    /// What moves it.
    pub fn kind(&self) -> BodyKind {
        self.data().kind
    }

    /// Its origin: the very bits that were set, until it moves.
    pub fn position(&self) -> Vec2<Length> {
        origin_of(self.center_of_mass(), self.data().center, self.angle())
    }

    /// Its centre of mass, in the world.
    pub fn center_of_mass(&self) -> Vec2<Length> {
        self.world.bodies.position(self.slot)
    }

    /// Its colliders, in the order of its definition.
    pub fn colliders(&self) -> impl Iterator<Item = Collider<'_>> {
        let world = self.world;
        world.colliders.list(self.data().first).map(move |slot| Collider { world, slot })
    }

    /// Its orientation in turns, unwrapped (DD:angDisp is a difference of two); [`Angle::radians`] is φ in [0, 2π).
    pub fn angle(&self) -> Angle {
        self.world.bodies.angle.get(self.slot)
    }

    /// Its orientation as a rotation. Derived at each call: about 15 ns.
    pub fn rotation(&self) -> Rot {
        Rot::new(self.angle())
    }

    /// The velocity of its centre of mass.
    pub fn velocity(&self) -> Vec2<Velocity> {
        self.world.bodies.velocity(self.slot)
    }

    /// Counter-clockwise positive.
    pub fn angular_velocity(&self) -> AngularVelocity {
        self.world.bodies.omega.get(self.slot)
    }

    /// The velocity of the body's point at `point` in the world: v + ω·(−r_y, r_x) (DD:chaslesThm).
    ///
    /// Rounding: once per component. Overflow: saturates.
    pub fn velocity_at(&self, point: Vec2<Length>) -> Vec2<Velocity> {
        let (center, velocity) = (self.center_of_mass(), self.velocity());
        let omega = self.angular_velocity().to_bits();
        let arm = |p: Length, c: Length| p.to_bits().saturating_sub(c.to_bits());
        let (rx, ry) = (arm(point.x, center.x), arm(point.y, center.y));
        let part = |v: Velocity, r: i64| Velocity::from_bits(mul_add(omega, r, v.to_bits(), 32, 32));
        Vec2::new(part(velocity.x, ry.saturating_neg()), part(velocity.y, rx))
    }

    /// Its mass; what it means, it means while the body is dynamic.
    pub fn mass(&self) -> Mass {
        self.data().mass
    }

    /// The game's own.
    pub fn user_data(&self) -> u64 {
        self.data().user_data
    }

    /// Whether steps move it: not while it sleeps. Static and kinematic bodies are always awake.
    pub fn is_awake(&self) -> bool {
        !self.world.bodies.rest.is_asleep(self.slot)
    }

    /// ½·m·‖v‖² + ½·I·ω² (DD:kEnergy). Rounding: once per term. Overflow: saturates.
    pub fn kinetic_energy(&self) -> Energy {
        let (v, data) = (self.velocity(), self.data());
        let square = |bits: i64| i128::from(bits).saturating_mul(bits.into());
        let speed2 = square(v.x.to_bits()).saturating_add(square(v.y.to_bits()));
        // 96 + 64 fraction bits to 64, and the half.
        let line = mul_div(speed2, data.mass.to_bits(), 1 << 97);
        let turn = mul_div(square(self.angular_velocity().to_bits()), data.inertia.to_bits(), 1 << 97);
        Energy::from_bits(line.saturating_add(turn))
    }

    /// −m·g·p (DD:potEnergy) in the world's uniform gravity. Rounding: once. Overflow: saturates.
    pub fn potential_energy(&self) -> Energy {
        let (p, g) = (self.center_of_mass(), self.world.config.gravity);
        let product = |a: i64, b: i64| i128::from(a).saturating_mul(b.into());
        let height = product(g.x.to_bits(), p.x.to_bits()).saturating_add(product(g.y.to_bits(), p.y.to_bits()));
        Energy::from_bits(mul_div(height.saturating_neg(), self.data().mass.to_bits(), 1 << 80))
    }
}
