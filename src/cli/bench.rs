//! `skilltree bench`: how fast this machine is.

use super::console::{print, tell};
use super::error::{CliError, exit_codes};
use crate::bench::executor::ExecutorSet;
use crate::bench::export::{self, export};
use crate::bench::measure::bench as run_bench;
use crate::bench::result;
use crate::bench::scaling::{COUNTS, scaling};
use std::path::{Path, PathBuf};

/// Measures robot-steps, decisions, replayed transitions and whole learners on every backend. Whatever two of them do
/// must leave the same bytes, or nothing is told.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree bench --backend cpu --learners 0\n",
    "  skilltree bench --json > bench.json\n",
    "  skilltree bench --record\n",
    "  skilltree bench --scaling\n",
    "  skilltree bench --export peers\n\n",
    "Whole learners take the most time: `--learners 0` leaves them out.\n\n",
    exit_codes!()
))]
pub(super) struct BenchArguments {
    /// Who is measured.
    #[arg(long, value_enum, default_value = "all", value_name = "WHERE")]
    backend: ExecutorSet,
    /// Samples of everything, taken in turn; medians and quartiles are told.
    #[arg(long, default_value_t = 7, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    samples: u32,
    /// Whole learners to train in each sample, 0 for none; one per core, and 1024 on a graphics card, if not given.
    /// With --export, the learners whose replay is exported.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=65_536))]
    learners: Option<u32>,
    /// One JSON object instead of text.
    #[arg(long)]
    json: bool,
    /// Keeps the result as benches/runs/DATE-MACHINE.json too.
    #[arg(long)]
    record: bool,
    /// Measures what a learner costs among 64, 256, ... 16384 learners on the CPU, and nothing else. Takes some 3 GB.
    #[arg(long, conflicts_with_all = ["export", "record", "backend", "learners"])]
    scaling: bool,
    /// Writes inputs and expected results for programs in other languages, and measures nothing.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["record", "json", "backend", "samples"])]
    export: Option<PathBuf>,
}

/// Runs the benchmark.
///
/// # Errors
/// Where results differ or something cannot be had.
pub(super) fn bench(arguments: &BenchArguments) -> Result<(), CliError> {
    let command = std::env::args().collect::<Vec<_>>().join(" ");
    let note = &mut |text: &str| tell(text);
    if let Some(folder) = &arguments.export {
        export(folder, arguments.learners.unwrap_or(export::LEARNERS).max(1))?;
        tell(&format!("written: {}", folder.display()));
        return Ok(());
    }
    if arguments.scaling {
        let report = scaling(&COUNTS, arguments.samples, &command, note)?;
        let json = || serde_json::to_string_pretty(&report).unwrap_or_default() + "\n";
        return print(&if arguments.json { json() } else { report.text() });
    }
    let report = run_bench(arguments.backend, arguments.samples, arguments.learners, &command, note)?;
    if arguments.record {
        tell(&format!("kept: {}", report.record(Path::new(result::FOLDER))?.display()));
    }
    print(&if arguments.json { report.json() } else { report.text() })
}
