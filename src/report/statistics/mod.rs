//! Statistics over learners, as pure functions of numbers.
//!
//! A value is one number per seed unless a function says otherwise. A *stratum* holds the values of one task or arm:
//! seeds are resampled within it, never across. All functions give NaN for no values, and the same values always give
//! the same interval.
//!
//! Definitions are those of rliable 1.2.0 (Agarwal et al. 2021) where it has them.

mod bootstrap;
mod compare;
mod interval;
mod location;
mod profile;
mod selection;
mod survival;

pub use bootstrap::{bca, bootstrap, bootstrap_bca, bootstrap_ratio, bootstrap_stratified};
pub use compare::{bootstrap_probability, paired_difference, probability_of_improvement};
pub use interval::{Interval, student_t, wilson};
pub use location::{
    Statistic, interquartile_mean, mean, optimality_gap, quantile, ratio, share_below, sorted, standard_deviation,
};
pub use profile::{performance_profile, profile_band};
pub use selection::{Selection, select};
pub use survival::{Observation, Step, Survival};

/// Resamples behind every interval in a table.
pub const TABLE_RESAMPLES: usize = 10_000;
/// Resamples behind every band in a figure.
pub const BAND_RESAMPLES: usize = 2_000;
/// Intervals over fewer seeds than this are too narrow to trust (simulated coverage is below 92 percent).
pub const FEW_SEEDS: usize = 10;
/// Share of the distribution below and above a 95 percent interval.
const TAIL: f64 = 0.025;
/// 97.5 percent point of the normal distribution.
const Z: f64 = 1.959_963_984_540_054;
