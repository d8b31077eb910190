//! Outcomes that need a little computing, in `f64`.

/// Where a body is at time t that was at the nearest point (a·(1 − e), 0) of its ellipse about the origin at 0, going up.
pub fn kepler(a: f64, e: f64, mu: f64, t: f64) -> [f64; 2] {
    let mean = (t * (mu / (a * a * a)).sqrt()).rem_euclid(std::f64::consts::TAU);
    let mut eccentric = if e > 0.5 { std::f64::consts::PI } else { mean };
    for _ in 0..60 {
        eccentric -= (eccentric - e * eccentric.sin() - mean) / (1.0 - e * eccentric.cos());
    }
    [a * (eccentric.cos() - e), a * (1.0 - e * e).sqrt() * eccentric.sin()]
}

/// The first time at which a function that is positive at `from` is 0; looked for in steps of a thousandth of the span.
pub fn first_root(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let step = (to - from) / 1000.0;
    let Some(k) = (1..=1000).find(|&k| f(from + step * f64::from(k)) <= 0.0) else { return f64::INFINITY };
    let (mut low, mut high) = (from + step * f64::from(k - 1), from + step * f64::from(k));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// φ'' = bend(φ) from [φ, φ'] over t, by 20 000 steps of the classical Runge-Kutta scheme.
pub fn integrate(start: [f64; 2], bend: impl Fn(f64) -> f64, t: f64) -> [f64; 2] {
    const STEPS: u32 = 20_000;
    let h = t / f64::from(STEPS);
    let rate = |[phi, omega]: [f64; 2]| [omega, bend(phi)];
    let along = |s: [f64; 2], by: f64, k: [f64; 2]| [s[0] + by * k[0], s[1] + by * k[1]];
    (0..STEPS).fold(start, |s, _| {
        let k1 = rate(s);
        let k2 = rate(along(s, h / 2.0, k1));
        let k3 = rate(along(s, h / 2.0, k2));
        let k4 = rate(along(s, h, k3));
        let sum = [0, 1].map(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0);
        along(s, h, sum)
    })
}
