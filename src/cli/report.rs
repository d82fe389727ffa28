//! `skilltree report`: figures, tables and the page of complete runs.

use super::console::print;
use super::{CliError, exit_codes};
use crate::report;
use std::path::PathBuf;

/// Draws the figures and writes the self-contained HTML page of complete runs.
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Example:\n  skilltree report runs/quick\n\n",
    "It writes report.html and figures/ into each folder, prints the summary, and computes nothing anew: the same ",
    "folder always gives the same bytes. `skilltree run` does this at its end by itself.\n\n",
    exit_codes!()
))]
pub(super) struct ReportArguments {
    /// Run folders, as `skilltree run` leaves them.
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
}

pub(super) fn report(arguments: &ReportArguments) -> Result<(), CliError> {
    for folder in &arguments.folders {
        let written = report::write(folder)?;
        print(&report::text(folder)?)?;
        let paths: String = written.iter().map(|path| format!("{}\n", path.display())).collect();
        print(&paths)?;
    }
    Ok(())
}
