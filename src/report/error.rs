//! What can go wrong when a report is made.

use crate::config::ConfigError;
use crate::run_folder::RecordError;

/// An error in making a report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The run folder cannot be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run folder's floor plan cannot be read: another version of skilltree made the run.
    #[error("{0}\nnote: the run was made by another version of skilltree: use that one")]
    World(#[from] ConfigError),
    /// A template failed.
    #[error("the page could not be written: {0:#}\nhint: this is a bug in skilltree: please report it")]
    Page(#[from] minijinja::Error),
}
