//! Run folders: what an experiment leaves on disk, and how it survives being killed.
//!
//! The experiment writes through [`RunFolder`]; reports read through [`FinishedRun`] and never write here.
//! Every file is committed whole (temporary file, fsync, rename), and `manifest.json` comes last: a folder that
//! holds it is complete, and its hashes vouch for every other file. Files are reached through [`file_system`] alone.

pub mod atomic;
mod error;
pub mod failures;
pub mod file_system;
pub mod finished;
pub mod finishing;
pub mod folder;
mod frame;
pub mod manifest;
pub mod sensor_readings;
pub mod stream;
pub mod sums;
pub mod sweep;
pub mod tables;
pub mod trajectories;
pub mod weights;

pub use error::RecordError;
pub use failures::Divergence;
pub use finished::FinishedRun;
pub use folder::{RunFolder, State};
pub use manifest::{Manifest, Provenance};
pub use sensor_readings::PlaceReading;
pub use sums::Sums;
pub use sweep::Sweep;
pub use tables::{EvaluationRow, Names, TrialRow};
pub use trajectories::{Trajectory, TrajectoryPoint};
pub use weights::{NetWeights, SkillWeights};

/// Version of the run folder's layout and of every file in it.
pub const FORMAT: u32 = 3;
