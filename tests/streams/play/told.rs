//! What a tick tells, as one number.

use tamias2d::{ColliderId, Collision, Event, Filter, Length, Pace, Vec2, World};

/// A hash of numbers, the same on every machine: what the standard derives feeds some of them in the machine's own order of bytes.
struct Sum(u64);

impl Sum {
    fn word(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
    }

    fn number(&mut self, number: impl Into<i128>) {
        let number = number.into();
        self.word(number as u64);
        self.word((number >> 64) as u64);
    }

    fn collider(&mut self, id: ColliderId) {
        self.number(id.index);
        self.number(id.generation);
    }

    fn point(&mut self, point: Vec2<Length>) {
        self.number(point.x.to_bits());
        self.number(point.y.to_bits());
    }

    fn event(&mut self, event: &Event) {
        let Event { tick, kind, a, b } = *event;
        self.number(tick);
        self.number(kind as u8);
        self.collider(a);
        self.collider(b);
    }

    fn collision(&mut self, collision: &Collision) {
        let Collision { tick, ordinal, a, b, order, time, point, normal, impulse, before, after } = *collision;
        self.number(tick);
        self.number(ordinal);
        self.collider(a);
        self.collider(b);
        self.number(order);
        self.number(time.to_bits());
        self.point(point);
        normal.into_iter().for_each(|part| self.number(part));
        self.number(impulse.x.to_bits());
        self.number(impulse.y.to_bits());
        for Pace { velocity, angular_velocity } in before.into_iter().chain(after) {
            self.number(velocity.x.to_bits());
            self.number(velocity.y.to_bits());
            self.number(angular_velocity.to_bits());
        }
    }
}

/// The hash of what is no state: events and collisions of the last step, and what two queries see.
pub fn told(world: &World) -> u64 {
    let mut sum = Sum(0);
    world.events().iter().for_each(|event| sum.event(event));
    world.collisions().iter().for_each(|collision| sum.collision(collision));
    if let Some(body) = world.bodies().last() {
        let (center, filter) = (body.center_of_mass(), Filter::default());
        let elsewhere = Vec2::new(center.y, center.x);
        for hit in world.ray_cast_all(center, elsewhere, filter) {
            sum.collider(hit.collider);
            sum.point(hit.point);
            sum.number(hit.fraction);
            hit.normal.into_iter().for_each(|part| sum.number(part));
        }
        let reach = Length::from_bits(center.x.to_bits().saturating_abs());
        if let Some(near) = world.closest_point(elsewhere, reach, filter) {
            sum.collider(near.collider);
            sum.point(near.point);
            sum.number(near.distance.to_bits());
        }
    }
    sum.0
}
