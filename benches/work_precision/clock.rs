//! Time that this thread had the processor, which others on the machine disturb less than that of the clock on the wall.

use cpu_time::ThreadTime;

/// What several rounds took, in nanoseconds.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    pub best: f64,
    pub median: f64,
}

/// Nanoseconds of one call.
pub fn time(work: impl FnOnce()) -> f64 {
    let begin = ThreadTime::now();
    work();
    begin.elapsed().as_secs_f64() * 1e9
}

impl Cost {
    /// Of rounds; at least one.
    pub fn of(rounds: &[f64]) -> Cost {
        let mut sorted = rounds.to_vec();
        sorted.sort_by(f64::total_cmp);
        Cost { best: sorted[0], median: sorted[sorted.len() / 2] }
    }
}
