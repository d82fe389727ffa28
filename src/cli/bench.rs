//! `skilltree bench`: how fast, and how near to this machine's limits.

use super::output::tell;
use super::{Failure, exit_codes};
use crate::bench::export::{self, export};
use std::path::PathBuf;

/// Measures robot-steps, decisions, replayed transitions and whole learners on every backend, beside the limits of this
/// machine.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree bench --export peers\n\n",
    exit_codes!()
))]
pub(super) struct Arguments {
    /// Writes the benchmark's inputs and expected results for programs in other languages, and times nothing.
    #[arg(long, value_name = "DIR")]
    export: Option<PathBuf>,
    /// Learners whose replay is exported.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65_536))]
    learners: Option<u32>,
}

/// Runs the benchmark.
///
/// # Errors
/// Where results differ or something cannot be had.
pub(super) fn bench(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(folder) = &arguments.export {
        export(folder, arguments.learners.unwrap_or(export::LEARNERS))?;
        tell(&format!("written: {}", folder.display()));
    }
    Ok(())
}
