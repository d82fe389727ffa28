//! Arms x points x seeds -> cohorts -> results.
//!
//! Learners are independent, so how they are grouped, in which order they train, and how often the run is
//! interrupted changes no byte of any result.

pub mod allocate;
pub mod batch;
pub mod batch_group;
pub mod callbacks;
pub mod checkpoint;
pub mod codec;
pub mod cohort_callbacks;
pub mod committed;
pub mod divergence;
pub mod estimate;
pub mod nets;
pub mod observation;
pub mod parity;
pub mod pretraining;
pub mod result;
pub mod run;
pub mod schedule;
pub mod thresholds;
pub mod train_loop;
pub mod trajectories;
pub mod write_results;
