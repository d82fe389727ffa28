//! Intervals from formulas.

use super::location::{mean, standard_deviation};
use super::{TAIL, Z};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// A 95 percent interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// What no value says: both ends NaN.
    pub const NONE: Self = Self { low: f64::NAN, high: f64::NAN };

    /// Whether a value lies within, ends included.
    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }
}

/// Student's interval of the mean: exact for normal values, and wide enough at 5 seeds, where the bootstrap is not.
/// NaN for fewer than two values.
pub fn student_t(values: &[f64]) -> Interval {
    let count = values.len();
    let Ok(t) = StudentsT::new(0.0, 1.0, count.saturating_sub(1) as f64) else { return Interval::NONE };
    let half = t.inverse_cdf(1.0 - TAIL) * standard_deviation(values) / (count as f64).sqrt();
    let centre = mean(values);
    Interval { low: centre - half, high: centre + half }
}

/// Wilson's interval of a rate. It takes every trial as independent; trials of one learner are not.
pub fn wilson(successes: u64, trials: u64) -> Interval {
    if trials == 0 {
        return Interval::NONE;
    }
    let n = trials as f64;
    let rate = successes as f64 / n;
    let scale = 1.0 + Z * Z / n;
    let centre = rate + Z * Z / (2.0 * n);
    let half = Z * (rate * (1.0 - rate) / n + Z * Z / (4.0 * n * n)).sqrt();
    Interval { low: ((centre - half) / scale).max(0.0), high: ((centre + half) / scale).min(1.0) }
}
