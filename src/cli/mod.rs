//! The command line: one file per command.

mod bench;
mod console;
mod devices;
mod error;
mod keys;
mod preview;
mod probe;
mod progress;
mod report;
mod run;
mod signals;

pub use console::tell;
pub use error::CliError;

use clap::{Parser, Subcommand};
use error::exit_codes;

/// Trains thousands of small robots at once, each learning its own tree of skills by reinforcement, with
/// the same bytes on any exact GPU and on the CPU.
#[derive(Debug, Parser)]
#[command(
    name = "skilltree",
    version,
    max_term_width = 110,
    after_help = concat!("Start with:  skilltree run configs/quick.toml\n\n", exit_codes!())
)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::RunArguments),
    Report(report::ReportArguments),
    Probe(probe::ProbeArguments),
    Devices(devices::DevicesArguments),
    Bench(bench::BenchArguments),
    Keys(keys::KeysArguments),
}

/// Carries out what the user typed.
///
/// # Errors
/// [`CliError`] holds the message for the user and the exit code.
pub fn run(cli: Cli) -> Result<(), CliError> {
    match cli.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Report(arguments) => report::report(&arguments),
        Command::Probe(arguments) => probe::probe(&arguments),
        Command::Devices(arguments) => devices::devices(&arguments),
        Command::Bench(arguments) => bench::bench(&arguments),
        Command::Keys(arguments) => keys::keys(&arguments),
    }
}
