//! How fast is this machine? `skilltree bench`.
//!
//! Every benchmark ([`benchmarks`]) is done by every [`executor`] that can do it, in turn, and in every round their bytes
//! are compared: no rate is told of a wrong result ([`measure`]). [`export`] writes the same work for programs in other
//! languages, [`scaling`] asks what a learner costs among few and among thousands.

pub mod benchmarks;
pub mod embedded_configs;
pub mod executor;
pub mod export;
pub mod measure;
pub mod result;
pub mod robot_walk;
pub mod scaling;
pub mod taught_replay;
pub mod timing;

use crate::backend::BackendError;
use crate::config::ConfigError;
use crate::train::batch_group::SetupError;
use crate::train::callbacks::Interrupted;
use std::path::{Path, PathBuf};

/// Why a benchmark cannot be run, or its rates would mean nothing.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// Two executors leave different bytes of the same work.
    #[error(
        "{work}: {left} and {right} differ: {what}\nhint: no rate means anything; `skilltree devices --parity` tells more"
    )]
    Differs {
        /// Which work.
        work: &'static str,
        /// Who left the one result.
        left: String,
        /// Who left the other.
        right: String,
        /// Where they differ first.
        what: String,
    },
    /// A file cannot be written.
    #[error("{}: {source}\nhint: name another place, or free some space", path.display())]
    File {
        /// Which file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Tensors have no form in a file.
    #[error("{}: {message}\nhint: please report this", path.display())]
    Tensors {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// The built-in experiment does not load.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The built-in experiment cannot be set up.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A backend cannot be had, or failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// Learners have not come to their end.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Compares what two executors left of the same work, 32-bit words each.
///
/// # Errors
/// [`BenchError::Differs`] names the first word that differs.
pub fn compare(work: &'static str, (left, a): (&str, &[u32]), (right, b): (&str, &[u32])) -> Result<(), BenchError> {
    let differs = |what: String| BenchError::Differs { work, left: left.to_owned(), right: right.to_owned(), what };
    if a.len() != b.len() {
        return Err(differs(format!("{} words against {}", a.len(), b.len())));
    }
    match a.iter().zip(b).position(|(a, b)| a != b) {
        Some(place) => Err(differs(format!("word {place} is {:#010x} against {:#010x}", a[place], b[place]))),
        None => Ok(()),
    }
}

/// Makes a folder if it is not there.
fn make_folder(path: &Path) -> Result<(), BenchError> {
    std::fs::create_dir_all(path).map_err(|source| BenchError::File { path: path.to_owned(), source })
}

/// Writes a file.
fn write_file(path: &Path, bytes: &[u8]) -> Result<(), BenchError> {
    std::fs::write(path, bytes).map_err(|source| BenchError::File { path: path.to_owned(), source })
}
