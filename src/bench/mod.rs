//! How fast is this machine, and how near to its limits? `skilltree bench`.
//!
//! Every kind of work ([`tasks`]) is done by all who can do it ([`executor`]), in turn with a control loop and with the
//! [`limits`] of one core, and in every round their bytes are compared: no figure is told of what is wrong
//! ([`measure`]). [`cost`] counts what a unit of work needs, so that a rate becomes a share of a limit.
//! [`simulate`] and [`replay`] hold the work and a scalar reference, which does the same without lanes; [`export`]
//! writes the same work for programs in other languages.

pub mod archive;
pub mod clock;
pub mod cost;
pub mod executor;
pub mod export;
pub mod limits;
pub mod measure;
pub mod replay;
pub mod result;
pub mod run;
pub mod scaling;
pub mod simulate;
pub mod tasks;
pub mod text;
pub mod workload;

use crate::backend::BackendError;
use crate::config::ConfigError;
use crate::train::batch_group::SetupError;
use crate::train::callbacks::Interrupted;
use std::path::{Path, PathBuf};

/// Why a benchmark cannot be run, or its figures would mean nothing.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    /// Two executors leave different bytes of the same work.
    #[error(
        "{work}: {left} and {right} differ: {what}\nhint: no figure means anything; `skilltree devices --parity` tells more"
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
    /// A file cannot be written or read.
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
    /// A cohort has not come to its end.
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

/// Compares two executors' words of the same work.
///
/// # Errors
/// [`BenchError::Differs`] names the first word that differs.
pub fn same(work: &'static str, (left, a): (&str, &[u32]), (right, b): (&str, &[u32])) -> Result<(), BenchError> {
    let differs = |what: String| BenchError::Differs { work, left: left.to_owned(), right: right.to_owned(), what };
    if a.len() != b.len() {
        return Err(differs(format!("{} words against {}", a.len(), b.len())));
    }
    match a.iter().zip(b).position(|(a, b)| a != b) {
        Some(place) => Err(differs(format!("word {place} is {:#010x} against {:#010x}", a[place], b[place]))),
        None => Ok(()),
    }
}

/// Writes a file.
fn put(path: &Path, bytes: &[u8]) -> Result<(), BenchError> {
    std::fs::write(path, bytes).map_err(|source| BenchError::File { path: path.to_owned(), source })
}
