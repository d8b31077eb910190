//! The impulse of a collision by itself (GD:impulse, IM:col2D): two bodies, a point, a normal.

use crate::geom::Vec2;
use crate::num::{
    AngularVelocity, Decimal, Impulse, Inertia, Length, Mass, Quantity, RangeError, Restitution, Velocity, cross_wide,
    div, hypot, mul_div, round_shift,
};
use core::fmt;

/// One of two bodies that collide. `Striker::default()` stands still and cannot be moved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Striker {
    /// `None`: an impulse does not change its velocity.
    pub mass: Option<Mass>,
    /// `None`: an impulse does not change its angular velocity.
    pub inertia: Option<Inertia>,
    /// Of its centre of mass.
    pub velocity: Vec2<Velocity>,
    /// Counter-clockwise positive.
    pub angular_velocity: AngularVelocity,
    /// From its centre of mass to the point of the collision; within ±32 768 m.
    pub arm: Vec2<Length>,
}

/// What a collision does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// J = j·n/‖n‖ on a; b gets −J, to the bit. Zero if the two do not approach.
    pub impulse: Vec2<Impulse>,
    /// (v_a − v_b)·n/‖n‖ of the point, before.
    pub speed_before: Velocity,
    /// a with its velocities after.
    pub a: Striker,
    /// b with its velocities after.
    pub b: Striker,
}

/// Why there is no such collision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpactError {
    /// The normal has no direction.
    ZeroNormal,
    /// Neither body has a mass.
    BothFixed,
    /// A value outside its quantity's accepted range; velocities after the collision among them.
    Range(RangeError),
    /// An arm beyond ±32 768 m.
    Arm {
        /// The coordinate.
        value: Length,
    },
}

impl fmt::Display for ImpactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ImpactError::ZeroNormal => f.write_str("the normal is zero"),
            ImpactError::BothFixed => f.write_str("neither body has a mass"),
            ImpactError::Range(error) => error.fmt(f),
            ImpactError::Arm { value } => write!(f, "arm coordinate {value} m is outside ±32768 m"),
        }
    }
}

impl core::error::Error for ImpactError {}

impl From<RangeError> for ImpactError {
    fn from(error: RangeError) -> Self {
        ImpactError::Range(error)
    }
}

/// The collision of a (the vertex owner) with b (the edge owner) at a point, with the normal from b to a:
/// j = −(1 + C_R)·v_ab·n / [(1/m_a + 1/m_b)‖n‖² + (r_a × n)²/I_a + (r_b × n)²/I_b], J = j·n, only if v_ab·n < 0.
///
/// Shape: `normal` of any length but zero; it gives the same for each length. Rounding: nearest; J once, so momentum is
/// exact but for one rounding per velocity. Error: below 1e-12 relative for m·r²/I below 10⁶. Source: SRS, GD:impulse.
///
/// ```
/// use tamias2d::{Impact, Mass, Inertia, Restitution, Striker, Vec2, impact};
/// let a = Striker {
///     mass: Some("2".parse()?),
///     inertia: Some("3".parse()?),
///     velocity: Vec2::from_f64(0.0, -5.0)?,
///     angular_velocity: "2".parse()?,
///     arm: Vec2::from_f64(1.0, -1.0)?,
/// };
/// let Impact { impulse, a, .. } = impact(&a, &Striker::default(), Vec2::from_f64(0.0, 10.0)?, "0.5".parse()?)?;
/// assert_eq!(format!("{:.12}", impulse.y), "5.400000000000"); // 1.5·3/(1/2 + 1/3)
/// assert_eq!(format!("{:.12}", a.velocity.y), "-2.300000000000");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn impact(a: &Striker, b: &Striker, normal: Vec2<Length>, restitution: Restitution) -> Result<Impact, ImpactError> {
    for striker in [a, b] {
        striker.check()?;
    }
    restitution.checked()?;
    let [nx, ny] = [normal.x.to_bits(), normal.y.to_bits()];
    let most = nx.unsigned_abs() | ny.unsigned_abs();
    if most == 0 {
        return Err(ImpactError::ZeroNormal);
    }
    // Made as long as it can be, so that rounding its length does not show.
    let up = most.leading_zeros().saturating_sub(2);
    let [nx, ny] = [nx << up, ny << up];
    let length = i128::from(hypot(nx, ny));
    // Unit, Q62.
    let n = [nx, ny].map(|c| div(i128::from(c) << 62, length) as i64);
    let [va, vb] = [a, b].map(Striker::at_point);
    let between = |axis: usize| va[axis].saturating_sub(vb[axis]);
    let along = |axis: usize| mul_div(between(axis), n[axis].into(), 1 << 62);
    let speed = along(0).saturating_add(along(1));
    let speed_before = Velocity::from_bits(within::<Velocity>(speed)?);
    if speed >= 0 {
        return Ok(Impact { impulse: Vec2::default(), speed_before, a: *a, b: *b });
    }
    // m·(…) with the mass m of one that has one: only ratios, never 1/m.
    let Some(mass) = a.mass.or(b.mass) else { return Err(ImpactError::BothFixed) };
    let whole = a.weight(mass, n).saturating_add(b.weight(mass, n));
    let closing = speed.saturating_neg().saturating_mul(i128::from(restitution.to_bits()).saturating_add(1 << 48));
    // Q96 to Q64, times m over the weights.
    let j = mul_div(round_shift(closing, 32), mass.to_bits(), whole);
    let vector = n.map(|n| mul_div(j, n.into(), 1 << 62));
    let impulse = Vec2::new(Impulse::from_bits(vector[0]).checked()?, Impulse::from_bits(vector[1]).checked()?);
    let (a, b) = (a.struck(vector)?, b.struck(vector.map(i128::saturating_neg))?);
    Ok(Impact { impulse, speed_before, a, b })
}

/// Bits of a quantity of 64 bits, if they are in its range.
fn within<Q: Quantity>(bits: i128) -> Result<i64, RangeError> {
    if bits < Q::MIN.wide_bits() || bits > Q::MAX.wide_bits() {
        return Err(RangeError::new::<Q>(Decimal { bits, frac: Q::FRAC }));
    }
    Ok(bits as i64)
}

impl Striker {
    fn check(&self) -> Result<(), ImpactError> {
        self.velocity.checked()?;
        self.angular_velocity.checked()?;
        if let Some(mass) = self.mass {
            mass.checked()?;
        }
        if let Some(inertia) = self.inertia {
            inertia.checked()?;
        }
        for value in [self.arm.x, self.arm.y] {
            if value.to_bits().unsigned_abs() > 1 << 47 {
                return Err(ImpactError::Arm { value });
            }
        }
        Ok(())
    }

    /// The velocity of the point: v + ω·(−r_y, r_x) (DD:chaslesThm), Q48.
    fn at_point(&self) -> [i128; 2] {
        let omega = i128::from(self.angular_velocity.to_bits());
        let turned = |r: Length| round_shift(omega.saturating_mul(r.to_bits().into()), 32);
        let (x, y) = (i128::from(self.velocity.x.to_bits()), i128::from(self.velocity.y.to_bits()));
        [x.saturating_sub(turned(self.arm.y)), y.saturating_add(turned(self.arm.x))]
    }

    /// m/m_i + (r × n)²·m/I_i, Q64.
    fn weight(&self, mass: Mass, n: [i64; 2]) -> i128 {
        let line = self.mass.map_or(0, |own| mul_div(mass.to_bits(), 1 << 64, own.to_bits()));
        let turn = self.inertia.map_or(0, |inertia| {
            let arm = [self.arm.x.to_bits().into(), self.arm.y.to_bits().into()];
            // Q32 times Q62, to Q40: below 2⁵⁶.
            let moment = cross_wide(arm, n.map(i128::from), 54);
            mul_div(moment.saturating_mul(moment) >> 16, mass.to_bits(), inertia.to_bits())
        });
        line.saturating_add(turn)
    }

    /// It after an impulse, Q64.
    fn struck(&self, impulse: [i128; 2]) -> Result<Striker, RangeError> {
        let mut after = *self;
        if let Some(mass) = self.mass {
            let change = impulse.map(|j| mul_div(j, 1 << 48, mass.to_bits()));
            let faster = |v: Velocity, change: i128| within::<Velocity>(change.saturating_add(v.to_bits().into()));
            let [x, y] = [faster(self.velocity.x, change[0])?, faster(self.velocity.y, change[1])?];
            after.velocity = Vec2::new(Velocity::from_bits(x), Velocity::from_bits(y));
        }
        if let Some(inertia) = self.inertia {
            let moment = cross_wide([self.arm.x.to_bits().into(), self.arm.y.to_bits().into()], impulse, 32);
            let change = mul_div(moment, 1 << 48, inertia.to_bits());
            let spun = change.saturating_add(self.angular_velocity.to_bits().into());
            after.angular_velocity = AngularVelocity::from_bits(within::<AngularVelocity>(spun)?);
        }
        Ok(after)
    }
}
