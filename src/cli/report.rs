//! `skilltree report`: figures, tables and the page of complete runs.

#[cfg(feature = "report")]
use super::console::print;
use super::error::{CliError, exit_codes};
use std::path::{Path, PathBuf};

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

#[cfg(feature = "report")]
pub(super) fn report(arguments: &ReportArguments) -> Result<(), CliError> {
    for folder in &arguments.folders {
        let crate::report::WrittenReport { files, summary } = crate::report::write(folder)?;
        print(&summary)?;
        let paths: String = files.iter().map(|path| format!("{}\n", path.display())).collect();
        print(&paths)?;
    }
    Ok(())
}

#[cfg(not(feature = "report"))]
pub(super) fn report(_: &ReportArguments) -> Result<(), CliError> {
    Err(CliError::Usage {
        message: "this build of skilltree makes no reports".to_owned(),
        hint: "build it with its default features, or with `--features report`".to_owned(),
    })
}

/// Makes the report at the end of a run. Returns the page's name, if this build makes reports.
#[cfg(feature = "report")]
pub(super) fn conclude(folder: &Path) -> Result<Option<&'static str>, CliError> {
    print(&crate::report::write(folder)?.summary)?;
    Ok(Some(crate::report::PAGE))
}

#[cfg(not(feature = "report"))]
pub(super) fn conclude(_: &Path) -> Result<Option<&'static str>, CliError> {
    super::console::tell("no report: this build of skilltree makes none (its feature `report` is off)");
    Ok(None)
}
