//! Arms x points x seeds -> cohorts -> results.
//!
//! Learners are independent, so how they are grouped, in which order they train, and how often the run is
//! interrupted changes no byte of any result.

pub mod checkpoint;
pub mod climb;
pub mod cohorts;
pub mod failure;
pub mod family;
pub mod files;
mod fingerprint;
pub mod forecast;
pub mod group;
pub mod parity;
pub mod parts;
pub mod result;
pub mod run;
pub mod senses;
mod sound;
pub mod standing;
pub mod thresholds;
pub mod train;
pub mod trajectories;
pub mod words;
