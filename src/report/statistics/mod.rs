//! Statistics over learners, as pure functions of numbers.
//!
//! A value is one number per seed unless a function says otherwise. Intervals hold 95 percent: the percentile bootstrap
//! over seeds for means, differences and ratios, Wilson's for rates of independent trials, log-log ones for survival.
//! All functions give NaN for no values, and the same values always give the same interval.

mod estimate;
mod selection;
mod survival;

pub use estimate::*;
pub use selection::*;
pub use survival::*;
