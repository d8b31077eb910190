//! Bytes as decisions: the ends of all ranges, just beyond them, and what games use.

use tamias2d::{
    Acceleration, Angle, AngularImpulse, AngularVelocity, Attractor, BodyDef, BodyKind, ColliderDef, Damping, Density,
    Filter, Force, Friction, Impulse, Inertia, Integrator, Length, Mass, Mu, Restitution, Shape, Sleeping, Time,
    Torque, Vec2, Velocity, WorldDef, num::Quantity,
};

/// Reads decisions off the front of bytes; at their end all are 0.
pub struct Draw<'b> {
    bytes: &'b [u8],
}

macro_rules! quantities {
    ($($name:ident: $quantity:ident, $bits:ty;)*) => {$(
        pub fn $name(&mut self) -> $quantity {
            let end = |q: $quantity| q.to_bits() as i128;
            let one = 1i128 << $quantity::FRAC;
            $quantity::from_bits(self.bits(end(<$quantity as Quantity>::MIN), end(<$quantity as Quantity>::MAX), one) as $bits)
        }
    )*};
}

macro_rules! vectors {
    ($($name:ident: $of:ident, $quantity:ident;)*) => {$(
        pub fn $name(&mut self) -> Vec2<$quantity> {
            Vec2::new(self.$of(), self.$of())
        }
    )*};
}

impl<'b> Draw<'b> {
    pub fn new(bytes: &'b [u8]) -> Self {
        Draw { bytes }
    }

    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub fn byte(&mut self) -> u8 {
        let (first, rest) = self.bytes.split_first().unwrap_or((&0, &[]));
        self.bytes = rest;
        *first
    }

    /// One of `count` choices.
    pub fn below(&mut self, count: u8) -> u8 {
        self.byte() % count
    }

    pub fn yes(&mut self) -> bool {
        self.byte() & 1 == 1
    }

    pub fn word(&mut self) -> u32 {
        u32::from_le_bytes(core::array::from_fn(|_| self.byte()))
    }

    pub fn take(&mut self, count: usize) -> &'b [u8] {
        let (taken, rest) = self.bytes.split_at(count.min(self.bytes.len()));
        self.bytes = rest;
        taken
    }

    /// A value in, at or beside a range; `one` is that of its unit.
    fn bits(&mut self, least: i128, most: i128, one: i128) -> i128 {
        let sign = |value: i128| if least >= 0 { value.saturating_abs() } else { value };
        match self.below(24) {
            0 => 0,
            1 => least,
            2 => most,
            3 => least.saturating_add(1),
            4 => most - 1,
            5 => least.saturating_sub(1),
            6 => most.saturating_add(1),
            7 => one,
            8 => sign(-one),
            9 => 1,
            10 => sign(-1),
            11 => {
                let shift = self.byte() & 127;
                sign(i128::from_le_bytes(core::array::from_fn(|_| self.byte())) >> shift)
            }
            // Of any order of magnitude.
            12 | 13 => {
                let value = i128::from(self.byte() as i8) << (self.byte() % 119);
                sign(value).clamp(least, most)
            }
            14..=18 => sign(i128::from(self.byte() as i8) * one / 16),
            _ => sign(i128::from(i16::from_le_bytes([self.byte(), self.byte()])) * one / 256),
        }
    }

    quantities! {
        length: Length, i64;
        velocity: Velocity, i64;
        spin: AngularVelocity, i64;
        acceleration: Acceleration, i64;
        angle: Angle, i64;
        time: Time, i64;
        mass: Mass, i128;
        inertia: Inertia, i128;
        force: Force, i128;
        torque: Torque, i128;
        impulse: Impulse, i128;
        angular_impulse: AngularImpulse, i128;
        density: Density, i128;
        restitution: Restitution, i64;
        friction: Friction, i64;
        damping: Damping, i64;
        mu: Mu, u128;
    }

    vectors! {
        place: length, Length;
        speed: velocity, Velocity;
        pull: acceleration, Acceleration;
        push: force, Force;
        kick: impulse, Impulse;
    }

    pub fn point(&mut self) -> Option<Vec2<Length>> {
        self.yes().then(|| self.place())
    }

    pub fn world(&mut self) -> WorldDef {
        let tick_rate = [60, 15, 1000, 30, 144, 240, 14, 1001][usize::from(self.below(8))];
        let substeps = [10, 1, 64, 4, 2, 12, 0, 65][usize::from(self.below(8))];
        let gravity = match self.below(3) {
            0 => Vec2::new(Acceleration::ZERO, Acceleration::from_bits(-10 << 48)),
            1 => Vec2::default(),
            _ => self.pull(),
        };
        let integrator = if self.below(4) == 0 { Integrator::SymplecticEuler } else { Integrator::ForestRuth };
        let unit_shift = [0, 0, 0, 10, 5, 1, 7, 11][usize::from(self.below(8))];
        let sleeping = match self.below(4) {
            0 => None,
            1 => Some(Sleeping { speed: self.velocity(), time: self.time() }),
            2 => Some(Sleeping { speed: Velocity::from_bits(1 << 48), time: Time::from_bits(1 << 44) }),
            _ => Some(Sleeping::default()),
        };
        WorldDef { tick_rate, substeps, gravity, integrator, unit_shift, sleeping }
    }

    pub fn kind(&mut self) -> BodyKind {
        match self.below(6) {
            0 => BodyKind::Static,
            1 => BodyKind::Kinematic,
            _ => BodyKind::Dynamic,
        }
    }

    /// A width or a radius.
    fn size(&mut self) -> Length {
        let bits = self.bits(4295, 16_000 << 32, 1 << 32);
        Length::from_bits(bits as i64)
    }

    fn shape(&mut self) -> Shape {
        match self.below(8) {
            0..=2 => Shape::Circle { radius: self.size() },
            3..=5 => Shape::Box { width: self.size(), height: self.size() },
            6 => {
                let size = i128::from(self.size().to_bits());
                let corner = |(x, y): (i128, i128)| {
                    let along = |part: i128| Length::from_bits((size * part / 8) as i64);
                    Vec2::new(along(x), along(y))
                };
                let corners = [(-8, -4), (0, -6), (7, -5), (8, 0), (5, 4), (0, 6), (-3, 6), (-8, 1)];
                let count = usize::from(self.below(9));
                Shape::Polygon { vertices: corners.into_iter().take(count).map(corner).collect() }
            }
            _ => {
                let count = self.below(10);
                Shape::Polygon { vertices: (0..count).map(|_| self.place()).collect() }
            }
        }
    }

    pub fn filter(&mut self) -> Filter {
        match self.below(4) {
            0 => Filter { category: self.word(), mask: self.word() },
            1 => Filter { category: 1 << (self.byte() & 1), mask: u32::from(self.byte() & 3) },
            _ => Filter::default(),
        }
    }

    fn collider(&mut self) -> ColliderDef {
        let mut def = ColliderDef::new(self.shape());
        let parts = self.byte();
        if parts & 1 > 0 {
            (def.restitution, def.friction) = (self.restitution(), self.friction());
        }
        if parts & 2 > 0 {
            def.offset = self.place();
        }
        if parts & 4 > 0 {
            def.angle = self.angle();
        }
        if parts & 8 > 0 {
            def.density = self.density();
        }
        if parts & 16 > 0 {
            def.filter = self.filter();
        }
        def.sensor = parts & 224 == 224;
        def
    }

    pub fn body(&mut self) -> BodyDef {
        let mut def = BodyDef { kind: self.kind(), position: self.place(), ..BodyDef::default() };
        let [first, second] = [self.byte(), self.byte()];
        let has = |parts: u8, bit: u32| parts >> bit & 1 == 1;
        if has(first, 0) {
            def.velocity = self.speed();
        }
        if has(first, 1) {
            def.angle = self.angle();
        }
        if has(first, 2) {
            def.angular_velocity = self.spin();
        }
        if has(first, 3) {
            def.mass = Some(self.mass());
        }
        if has(first, 4) {
            def.inertia = Some(self.inertia());
        }
        if has(first, 5) {
            def.center = Some(self.place());
        }
        if has(first, 6) && has(first, 7) {
            (def.force, def.torque) = (self.push(), self.torque());
        }
        if has(second, 0) && has(second, 1) {
            (def.linear_damping, def.angular_damping) = (self.damping(), self.damping());
        }
        if has(second, 2) && has(second, 3) {
            def.mu = self.mu();
        }
        def.fixed_rotation = has(second, 4) && has(second, 5);
        def.allow_sleep = !(has(second, 6) && has(second, 7));
        def.user_data = u64::from(second);
        let colliders = [1, 1, 1, 1, 0, 2, 3, 4][usize::from(self.below(8))];
        def.colliders = (0..colliders).map(|_| self.collider()).collect();
        def
    }

    pub fn attractor(&mut self) -> Attractor {
        Attractor { position: self.place(), mu: self.mu() }
    }
}
