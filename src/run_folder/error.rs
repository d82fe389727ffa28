//! What can go wrong with a run folder, always with the path and what to do.

use std::io;
use std::path::{Path, PathBuf};

/// An error in writing or reading a run folder.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The output folder cannot be made or written to.
    #[error("{}: cannot write the run folder: {source}\nhint: choose a writable place with --out", path.display())]
    Unwritable {
        /// The folder.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// A file was not written; what was there before still is.
    #[error(
        "{}: not committed: {source}\nhint: the earlier state is intact: free some space or fix the permissions, \
         then give the same command again",
        path.display()
    )]
    NotCommitted {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// A file was put in place, but the disk did not confirm that it would survive a power cut.
    #[error(
        "{}: committed, but the disk did not confirm it: {source}\nhint: give the same command again to verify what is there",
        path.display()
    )]
    DurabilityUnknown {
        /// The folder whose entry was not confirmed.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// A file or folder exists but cannot be read.
    #[error("{}: cannot read: {source}\nhint: check that it exists, that it is not something else, and its permissions", path.display())]
    Unreadable {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// Another process is writing here.
    #[error("{}: another skilltree process is working here\nhint: wait for it, or choose another --out", path.display())]
    Busy {
        /// The folder.
        path: PathBuf,
    },
    /// The folder holds something that skilltree did not write.
    #[error(
        "{}: not a skilltree run folder (it holds `{found}`)\nhint: nothing was touched; choose an empty or new folder",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// Something in it that is not ours.
        found: String,
    },
    /// There is no run folder to read.
    #[error("{}: no run folder{found}\nhint: name a folder that `skilltree run` has written, such as runs/quick", path.display())]
    NoRun {
        /// What was named.
        path: PathBuf,
        /// What is there instead, in brackets, or nothing.
        found: String,
    },
    /// The folder belongs to a run with other params.
    #[error(
        "{}: holds a run with another {file}\nhint: nothing was touched; choose another --out, or remove the folder yourself",
        path.display()
    )]
    OtherExperiment {
        /// The folder.
        path: PathBuf,
        /// The file that differs.
        file: String,
    },
    /// The run was interrupted, or is still going on.
    #[error(
        "{0}: the run is not complete: {finished} of {1} learners are finished and saved\nhint: `skilltree run \
         {0}/config.toml --out {0}` goes on with it; there is no report of a part of a run",
        path.display(), of.map_or_else(|| "its".to_owned(), |of| of.to_string())
    )]
    Unfinished {
        /// The folder.
        path: PathBuf,
        /// Learners whose results are saved.
        finished: u64,
        /// Learners of the run, where some of them are saved.
        of: Option<u64>,
    },
    /// What a run has saved so far comes from another program.
    #[error(
        "{}: written by {found}, and this is {known}\nhint: results of two programs are not mixed: go on with the \
         program that began the run, or choose another --out",
        path.display()
    )]
    OtherProgram {
        /// The file.
        path: PathBuf,
        /// Program and plan that wrote it.
        found: String,
        /// This program and plan.
        known: String,
    },
    /// The folder was written by a version with another layout.
    #[error("{}: format {found}, but this program reads format {known}\nhint: use the skilltree version that wrote it", path.display())]
    Format {
        /// The file that says so.
        path: PathBuf,
        /// Format found.
        found: String,
        /// Format that this program reads.
        known: u32,
    },
    /// A file's content is wrong.
    #[error("{}: damaged: {problem}\nhint: {hint}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
        /// What to do.
        hint: &'static str,
    },
    /// The caller asked for something that no run folder can hold: a bug in skilltree.
    #[error("{what}: {problem}\nhint: this is a bug in skilltree: please report it")]
    Invalid {
        /// The name or table that was to be written.
        what: String,
        /// Why it cannot be.
        problem: String,
    },
}

/// Hint for results that fail verification.
pub(crate) const RERUN: &str = "copy the folder again, or move it away and repeat the run";

impl RecordError {
    pub(crate) fn damaged(path: &Path, problem: impl Into<String>) -> Self {
        Self::Damaged { path: path.into(), problem: problem.into(), hint: RERUN }
    }

    pub(crate) fn not_committed(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::NotCommitted { path: path.into(), source }
    }

    pub(crate) fn unreadable(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Unreadable { path: path.into(), source }
    }

    pub(crate) fn invalid(what: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Invalid { what: what.into(), problem: problem.into() }
    }
}
