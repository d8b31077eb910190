//! Carrying commands out: everything is checked before anything changes.

use super::command::{Command, CommandError, INPUT_MAX, Reply};
use crate::World;
use crate::body::{Attractor, BodyData, BodyDef, BodyError, BodyKind, Collider, center_at, origin_of};
use crate::geom::Vec2;
use crate::motion::{Push, Source, acceleration};
use crate::num::{
    Acceleration, AngularImpulse, AngularVelocity, Damping, Decimal, Force, Impulse, Length, Mu, Quantity, RangeError,
    Torque, Velocity, clamp_i64, cross_wide, mul_div,
};
use crate::store::{Arena, AttractorId, BodyId, ColliderId};

impl World {
    /// Carries a command out, but for what it wakes.
    pub(super) fn carry_out(&mut self, command: Command) -> Result<Reply, CommandError> {
        match command {
            Command::CreateBody { def } => return self.add_body(&def).map(Reply::Body),
            Command::DestroyBody { body } => self.remove_body(body)?,
            Command::SetKind { body, kind } => self.change_kind(body, kind)?,
            Command::SetPosition { body, position } => {
                let slot = self.slot(body)?;
                let center =
                    center_at(position.checked()?, self.bodies.cold.value(slot).center, self.bodies.angle.get(slot));
                self.bodies.set_position(slot, center.checked()?);
                self.place(slot);
            }
            Command::SetAngle { body, angle } => {
                let slot = self.slot(body)?;
                let (center, angle) = (self.bodies.cold.value(slot).center, angle.checked()?);
                let origin = origin_of(self.bodies.position(slot), center, self.bodies.angle.get(slot));
                self.bodies.set_position(slot, center_at(origin, center, angle).checked()?);
                self.bodies.angle.set(slot, angle);
                self.place(slot);
            }
            Command::SetVelocity { body, velocity } => {
                let slot = self.slot(body)?;
                velocity.checked()?;
                self.bodies.cold.value(slot).check(velocity, self.bodies.omega.get(slot))?;
                self.bodies.set_velocity(slot, velocity);
            }
            Command::SetAngularVelocity { body, angular_velocity } => {
                let slot = self.slot(body)?;
                angular_velocity.checked()?;
                self.bodies.cold.value(slot).check(self.bodies.velocity(slot), angular_velocity)?;
                self.bodies.omega.set(slot, angular_velocity);
            }
            Command::SetForce { body, force } => self.change(body, |data| data.force = force)?,
            Command::SetTorque { body, torque } => self.change(body, |data| data.torque = torque)?,
            Command::SetMass { body, mass, inertia } => {
                self.change(body, |data| (data.mass, data.inertia) = (mass, inertia))?;
            }
            Command::SetFixedRotation { body, fixed } => self.fix_rotation(body, fixed)?,
            Command::SetDamping { body, linear, angular } => {
                self.change(body, |data| (data.linear_damping, data.angular_damping) = (linear, angular))?;
            }
            Command::SetMu { body, mu } => {
                self.change(body, |data| data.mu = mu)?;
                self.set_source(Source::carried(body.index as usize, mu));
            }
            Command::SetUserData { body, user_data } => self.change(body, |data| data.user_data = user_data)?,
            Command::ApplyForce { body, force, point } => {
                let slot = self.dynamic_slot(body, Force::NAME)?;
                let force = force.checked()?;
                let torque = match point {
                    Some(point) if self.bodies.cold.value(slot).turns() => {
                        self.moment::<Torque>(slot, point, force.x.to_bits(), force.y.to_bits())?
                    }
                    _ => 0,
                };
                self.push(slot, force, Torque::from_bits(torque))?;
            }
            Command::ApplyTorque { body, torque } => {
                let slot = self.turning_slot(body, Torque::NAME)?;
                self.push(slot, Vec2::default(), torque.checked()?)?;
            }
            Command::ApplyImpulse { body, impulse, point } => self.hit(body, impulse, point)?,
            Command::ApplyAngularImpulse { body, impulse } => {
                let slot = self.turning_slot(body, AngularImpulse::NAME)?;
                let omega = self.spun(slot, impulse.checked()?.to_bits())?;
                self.bodies.omega.set(slot, omega);
            }
            Command::CreateAttractor { attractor } => return self.add_attractor(attractor).map(Reply::Attractor),
            Command::SetAttractor { id, attractor } => {
                let slot = self.attractor_slot(id)?;
                let attractor = attractor.checked()?;
                self.attractors.update(slot, |a| *a = attractor);
                self.set_source(Source::fixed(slot, attractor));
            }
            Command::DestroyAttractor { id } => {
                self.attractors.remove(id.index, id.generation).ok_or(CommandError::NoSuchAttractor(id))?;
                self.set_source(Source::fixed(id.index as usize, Attractor::default()));
            }
            Command::SetGravity { gravity } => {
                self.config.gravity = gravity.checked()?;
                self.prepare_motion();
            }
            Command::SetSurface { collider, restitution, friction } => {
                let slot = self.collider_slot(collider)?;
                let (restitution, friction) = (restitution.checked()?, friction.checked()?);
                self.colliders.rows.update(slot, |row| (row.restitution, row.friction) = (restitution, friction));
                self.touch.set(slot, &self.bodies, &self.colliders);
            }
            Command::SetFilter { collider, filter } => {
                let slot = self.collider_slot(collider)?;
                self.colliders.rows.update(slot, |row| row.filter = filter);
                self.touch.set(slot, &self.bodies, &self.colliders);
            }
            Command::SetAllowSleep { body, allow } => self.change(body, |data| data.allow_sleep = allow)?,
            Command::Wake { body } => drop(self.slot(body)?),
            Command::PutToSleep { body } => self.lull(body)?,
            Command::ClearStatus => self.status.clear(),
            Command::Input { bytes } => {
                if bytes.len() > INPUT_MAX {
                    return Err(CommandError::InputTooLong { length: bytes.len() as u64 });
                }
            }
        }
        Ok(Reply::Done)
    }
}

/// That a body's own force and torque do not ask for more than the format of acceleration.
fn check_acceleration(data: &BodyData, push: Option<&Push>) -> Result<(), RangeError> {
    let [x, y, turn] = acceleration(data, Vec2::default(), push);
    for (bits, quantity, unit) in [
        (x, Acceleration::NAME, Acceleration::UNIT),
        (y, Acceleration::NAME, Acceleration::UNIT),
        (turn, "angular acceleration", "rad/s²"),
    ] {
        if i128::from(clamp_i64(bits)) != bits {
            let value = Decimal { bits, frac: Acceleration::FRAC };
            return Err(RangeError { quantity, unit, value, accepted: Acceleration::ACCEPTED });
        }
    }
    Ok(())
}

/// A sum that must stay in its quantity's range.
fn sum<Q: Quantity>(a: Q, b: Q, narrow: impl Fn(i128) -> Q) -> Result<Q, RangeError> {
    let bits = a.wide_bits().saturating_add(b.wide_bits());
    if bits < Q::MIN.wide_bits() || bits > Q::MAX.wide_bits() {
        return Err(RangeError::new::<Q>(Decimal { bits, frac: Q::FRAC }));
    }
    Ok(narrow(bits))
}

impl World {
    fn slot(&self, body: BodyId) -> Result<usize, CommandError> {
        self.bodies.slot(body).ok_or(CommandError::NoSuchBody(body))
    }

    /// The slot of a body that `quantity` can act on.
    fn dynamic_slot(&self, body: BodyId, quantity: &'static str) -> Result<usize, CommandError> {
        let slot = self.slot(body)?;
        let kind = self.bodies.cold.value(slot).kind;
        if kind == BodyKind::Dynamic { Ok(slot) } else { Err(BodyError::Kind { quantity, kind }.into()) }
    }

    /// The slot of a body that `quantity` can turn.
    fn turning_slot(&self, body: BodyId, quantity: &'static str) -> Result<usize, CommandError> {
        let slot = self.dynamic_slot(body, quantity)?;
        let fixed = self.bodies.cold.value(slot).fixed_rotation;
        if fixed { Err(BodyError::FixedRotation { quantity }.into()) } else { Ok(slot) }
    }

    fn attractor_slot(&self, id: AttractorId) -> Result<usize, CommandError> {
        self.attractors.slot(id.index, id.generation).ok_or(CommandError::NoSuchAttractor(id))
    }

    fn collider_slot(&self, id: ColliderId) -> Result<usize, CommandError> {
        self.colliders.slot(id).ok_or(CommandError::NoSuchCollider(id))
    }

    fn add_body(&mut self, def: &BodyDef) -> Result<BodyId, CommandError> {
        let data = def.data()?;
        check_acceleration(&data, None)?;
        if !self.bodies.cold.has_room() {
            return Err(CommandError::Full { what: "bodies", limit: Arena::<BodyData>::LIMIT });
        }
        if !self.colliders.has_room(def.colliders.len()) {
            return Err(CommandError::Full { what: "colliders", limit: Arena::<Collider>::LIMIT });
        }
        let center = data.center;
        let id = self.bodies.insert(def, data);
        let slot = id.index as usize;
        let first = self.colliders.insert(id.index, center, &def.colliders);
        if first.is_some() {
            self.bodies.cold.update(slot, |data| data.first = first);
        }
        self.refresh(slot);
        self.place(slot);
        if def.mu != Mu::ZERO {
            self.set_source(Source::carried(id.index as usize, def.mu));
        }
        Ok(id)
    }

    fn remove_body(&mut self, body: BodyId) -> Result<(), CommandError> {
        let slot = self.slot(body)?;
        let pulls = self.bodies.cold.value(slot).mu != Mu::ZERO;
        let first = self.bodies.cold.value(slot).first;
        for collider in self.colliders.list(first) {
            self.touch.remove(collider);
        }
        self.colliders.remove(first);
        self.bodies.remove(body);
        self.drop_push(slot);
        self.refresh(slot);
        if pulls {
            self.set_source(Source::carried(slot, Mu::ZERO));
        }
        Ok(())
    }

    fn add_attractor(&mut self, attractor: Attractor) -> Result<AttractorId, CommandError> {
        let attractor = attractor.checked()?;
        if !self.attractors.has_room() {
            return Err(CommandError::Full { what: "attractors", limit: Arena::<Attractor>::LIMIT });
        }
        let (index, generation) = self.attractors.insert(attractor);
        self.set_source(Source::fixed(index as usize, attractor));
        Ok(AttractorId { index, generation })
    }

    /// Changes a body's cold data if it can be so.
    fn change(&mut self, body: BodyId, change: impl FnOnce(&mut BodyData)) -> Result<(), CommandError> {
        let slot = self.slot(body)?;
        let mut data = self.bodies.cold.value(slot).clone();
        change(&mut data);
        data.check(self.bodies.velocity(slot), self.bodies.omega.get(slot))?;
        check_acceleration(&data, None)?;
        check_acceleration(&data, self.drive.push_of(slot, &self.pushes))?;
        self.bodies.cold.update(slot, |row| *row = data);
        self.refresh(slot);
        Ok(())
    }

    fn change_kind(&mut self, body: BodyId, kind: BodyKind) -> Result<(), CommandError> {
        let slot = self.slot(body)?;
        self.bodies.cold.value(slot).check_gyration(kind, self.bodies.cold.value(slot).fixed_rotation)?;
        if kind != BodyKind::Dynamic {
            self.drop_push(slot);
        }
        if kind == BodyKind::Static {
            self.bodies.set_velocity(slot, Vec2::default());
            self.bodies.omega.set(slot, AngularVelocity::ZERO);
        }
        self.bodies.cold.update(slot, |data| {
            data.kind = kind;
            if kind != BodyKind::Dynamic {
                (data.force, data.torque) = (Vec2::default(), Torque::ZERO);
                (data.linear_damping, data.angular_damping) = (Damping::ZERO, Damping::ZERO);
            }
        });
        self.refresh(slot);
        self.place(slot);
        Ok(())
    }

    fn fix_rotation(&mut self, body: BodyId, fixed: bool) -> Result<(), CommandError> {
        let slot = self.slot(body)?;
        self.bodies.cold.value(slot).check_gyration(self.bodies.cold.value(slot).kind, fixed)?;
        if fixed {
            self.bodies.omega.set(slot, AngularVelocity::ZERO);
            if self.drive.push_of(slot, &self.pushes).is_some() {
                self.pushes[self.drive.push_at[slot] as usize].torque = Torque::ZERO;
            }
        }
        self.bodies.cold.update(slot, |data| {
            data.fixed_rotation = fixed;
            if fixed {
                data.torque = Torque::ZERO;
            }
        });
        self.refresh(slot);
        Ok(())
    }

    /// The moment r × F about the centre of mass of a force or impulse (x, y) at a point, 64 fraction bits (DD:torque).
    fn moment<Q: Quantity>(&self, slot: usize, point: Vec2<Length>, x: i128, y: i128) -> Result<i128, RangeError> {
        let point = point.checked()?;
        let center = self.bodies.position(slot);
        let arm = |p: Length, c: Length| i128::from(p.to_bits()).saturating_sub(c.to_bits().into());
        let (rx, ry) = (arm(point.x, center.x), arm(point.y, center.y));
        let bits = cross_wide([rx, ry], [x, y], 32);
        if bits < Q::MIN.wide_bits() || bits > Q::MAX.wide_bits() {
            return Err(RangeError::new::<Q>(Decimal { bits, frac: 64 }));
        }
        Ok(bits)
    }

    /// Adds to the forces of this tick on a body.
    fn push(&mut self, slot: usize, force: Vec2<Force>, torque: Torque) -> Result<(), CommandError> {
        let present = self.drive.push_of(slot, &self.pushes);
        let none = Push { slot: slot as u32, force: Vec2::default(), torque: Torque::ZERO };
        let mut push = present.cloned().unwrap_or(none);
        push.force =
            Vec2::new(sum(push.force.x, force.x, Force::from_bits)?, sum(push.force.y, force.y, Force::from_bits)?);
        push.torque = sum(push.torque, torque, Torque::from_bits)?;
        check_acceleration(self.bodies.cold.value(slot), Some(&push))?;
        if present.is_some() {
            self.pushes[self.drive.push_at[slot] as usize] = push;
        } else {
            self.drive.push_at[slot] = self.pushes.len() as u32;
            self.pushes.push(push);
        }
        Ok(())
    }

    /// Forgets the forces of this tick on a body.
    pub(super) fn drop_push(&mut self, slot: usize) {
        if self.drive.push_of(slot, &self.pushes).is_some() {
            self.pushes.retain(|push| push.slot as usize != slot);
            self.drive.index_pushes(&self.pushes);
        }
    }

    /// Lets a source begin, change or cease to pull.
    fn set_source(&mut self, source: Source) {
        if self.drive.set_source(source) {
            self.prepare_motion();
        }
    }

    /// v += J/m, ω += (r × J)/I.
    fn hit(&mut self, body: BodyId, impulse: Vec2<Impulse>, point: Option<Vec2<Length>>) -> Result<(), CommandError> {
        let slot = self.dynamic_slot(body, Impulse::NAME)?;
        let impulse = impulse.checked()?;
        let data = self.bodies.cold.value(slot);
        let velocity = self.bodies.velocity(slot);
        let faster = |v: Velocity, j: Impulse| {
            let change = mul_div(j.to_bits(), 1 << 48, data.mass.to_bits());
            wide_sum::<Velocity>(v, change).map(|bits| Velocity::from_bits(bits as i64))
        };
        let velocity = Vec2::new(faster(velocity.x, impulse.x)?, faster(velocity.y, impulse.y)?);
        let omega = match point {
            Some(point) if data.turns() => {
                let moment = self.moment::<AngularImpulse>(slot, point, impulse.x.to_bits(), impulse.y.to_bits())?;
                self.spun(slot, moment)?
            }
            _ => self.bodies.omega.get(slot),
        };
        self.bodies.set_velocity(slot, velocity);
        self.bodies.omega.set(slot, omega);
        Ok(())
    }

    /// The angular velocity after an angular impulse of 64 fraction bits.
    fn spun(&self, slot: usize, impulse: i128) -> Result<AngularVelocity, RangeError> {
        let change = mul_div(impulse, 1 << 48, self.bodies.cold.value(slot).inertia.to_bits());
        wide_sum::<AngularVelocity>(self.bodies.omega.get(slot), change).map(|b| AngularVelocity::from_bits(b as i64))
    }
}

/// `value + change` in the quantity's bits, if it is in range.
fn wide_sum<Q: Quantity>(value: Q, change: i128) -> Result<i128, RangeError> {
    let bits = value.wide_bits().saturating_add(change);
    if bits < Q::MIN.wide_bits() || bits > Q::MAX.wide_bits() {
        return Err(RangeError::new::<Q>(Decimal { bits, frac: Q::FRAC }));
    }
    Ok(bits)
}
