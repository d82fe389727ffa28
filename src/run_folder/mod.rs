//! Run folders: what an experiment leaves on disk, and how it survives being killed.
//!
//! The experiment writes through [`RunFolder`]; reports read through [`FinishedRun`] and never write here.
//! Every file is committed whole (temporary file, fsync, rename), and `manifest.json` comes last: a folder that
//! holds it is complete, and its hashes vouch for every other file. Files are reached through [`file_system`] alone.

mod checksummed;
mod error;
pub mod examples;
pub mod failures;
pub mod file_system;
pub mod finished;
pub mod folder;
pub mod json;
pub mod manifest;
mod paths;
pub mod results_writer;
pub mod sweep;
pub mod tables;
pub mod weights;
pub mod writer;

pub use error::RecordError;
pub use examples::{PlaceReading, Trajectory, TrajectoryPoint};
pub use failures::Divergence;
pub use finished::FinishedRun;
pub use folder::{RunFolder, State};
pub use json::JsonFile;
pub use manifest::{Manifest, Provenance};
pub use results_writer::ResultsWriter;
pub use sweep::Sweep;
pub use tables::{EvaluationRow, Names, Sums, TrialRow};
pub use weights::{NetWeights, SkillWeights};

/// Version of the run folder's layout and of every file in it.
pub const FORMAT: u32 = 3;
