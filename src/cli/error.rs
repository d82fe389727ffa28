//! What the user is told when a command fails, and the exit code.

use crate::backend::BackendError;
use crate::bench::BenchError;
use crate::config::ConfigError;
#[cfg(feature = "report")]
use crate::report::ReportError;
use crate::run_folder::RecordError;
use crate::train::batch_group::SetupError;
use crate::train::run::RunError;

/// The last line of every help text.
macro_rules! exit_codes {
    () => {
        "Exit codes: 0 done; 2 wrong usage or config; 75 give the same command again; 1 anything else."
    };
}
pub(super) use exit_codes;

/// An error as the user sees it.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// Wrong usage of the command line: message and hint.
    #[error("{message}\nhint: {hint}")]
    Usage {
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
    /// Standard output does not take the results.
    #[error("cannot write to standard output: {0}\nhint: free some space, or send the output elsewhere")]
    Output(std::io::Error),
    /// The operating system does not hand signals over.
    #[error("cannot listen for signals: {0}\nhint: this machine lets no program do so; run it elsewhere")]
    Signals(std::io::Error),
    /// A config or world file, or a `--set`, is wrong.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The experiment cannot be set up as it stands in the config.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// A backend cannot be had, or failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// An adapter does not leave the bytes of the CPU.
    #[error(
        "adapters that differ from the CPU: {differing} of {adapters}\nhint: `--backend cpu` gives the exact results; a newer driver may too"
    )]
    Parity {
        /// Adapters that differ, or failed.
        differing: usize,
        /// Adapters that were asked.
        adapters: usize,
    },
    /// A run folder cannot be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A run was told to stop.
    #[error("{0}")]
    Stopped(String),
    /// A benchmark cannot be run, or its executors disagree.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// A report cannot be made.
    #[cfg(feature = "report")]
    #[error(transparent)]
    Report(#[from] ReportError),
}

impl CliError {
    /// Exit code: 2 usage or config, 75 run again, 1 anything else.
    pub fn code(&self) -> u8 {
        match self {
            Self::Usage { .. } | Self::Config(_) | Self::Setup(_) => 2,
            Self::Stopped(_) => 75,
            Self::Backend(error) | Self::Bench(BenchError::Backend(error)) => match error {
                BackendError::NotBuilt => 2,
                BackendError::Device { .. } => 75,
                _ => 1,
            },
            _ => 1,
        }
    }
}

impl From<RunError> for CliError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Record(error) => Self::Record(error),
            RunError::Backend(error) => Self::Backend(error),
            RunError::Stopped { .. } => Self::Stopped(error.to_string()),
        }
    }
}
