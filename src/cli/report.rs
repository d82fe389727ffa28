//! `skilltree report`: figures, tables and the page of complete runs.

use super::Failure;
use crate::report;
use std::path::PathBuf;

/// Draws the figures and writes the self-contained HTML page of complete runs.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  skilltree report runs/quick")]
pub(super) struct Arguments {
    /// Run folders.
    #[arg(required = true, value_name = "DIR")]
    folders: Vec<PathBuf>,
}

pub(super) fn report(arguments: &Arguments) -> Result<(), Failure> {
    for folder in &arguments.folders {
        let written = report::write(folder)?;
        print!("{}", report::text(folder)?);
        for path in written {
            println!("{}", path.display());
        }
    }
    Ok(())
}
