//! `skilltree devices`: every adapter, whether it is exact, and why one is not used.

#[cfg(feature = "gpu")]
mod examine;
mod listing;

use super::console::{count, print};
use super::error::{CliError, exit_codes};
use crate::backend::cpu::cpu_backend;
use crate::backend::open::open_adapters;
use crate::config::{Overrides, load};
use crate::train::parity::Work;
use listing::text;
use std::path::{Path, PathBuf};

/// Lists the graphics adapters of this machine and examines each: does it give the same bytes as the CPU?
#[derive(Debug, clap::Args)]
#[command(after_help = concat!(
    "Examples:\n",
    "  skilltree devices\n",
    "  skilltree devices --parity configs/docking.toml\n\n",
    "--parity trains some learners for three trials, tests them and moves 512 robots, on every adapter and on the ",
    "CPU, and names the first word that differs. Any difference is exit code 1.\n\n",
    exit_codes!()
))]
pub(super) struct DevicesArguments {
    /// One JSON object for all adapters.
    #[arg(long)]
    json: bool,
    /// Trains, tests and moves robots of this experiment on every adapter, and compares each byte with the CPU's.
    #[arg(long, value_name = "CONFIG", conflicts_with = "json")]
    parity: Option<PathBuf>,
    /// Learners that --parity trains.
    #[arg(long, value_name = "N", requires = "parity", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=65_536))]
    learners: u32,
}

/// Prints the adapters, or what they do to an experiment.
///
/// # Errors
/// Where an adapter is to leave the CPU's bytes and does not. A machine without adapters is not in error.
pub(super) fn devices(arguments: &DevicesArguments) -> Result<(), CliError> {
    if let Some(config) = &arguments.parity {
        return check_parity(config, arguments.learners as usize);
    }
    #[cfg(feature = "gpu")]
    let listing = examine::devices();
    #[cfg(not(feature = "gpu"))]
    let listing =
        listing::DeviceList { adapters: Vec::new(), none: Some(crate::backend::BackendError::NotBuilt.to_string()) };
    if arguments.json {
        print(&(serde_json::to_string_pretty(&listing).unwrap_or_default() + "\n"))
    } else {
        print(&text(&listing))
    }
}

/// Does the same work on the CPU and on every adapter, and prints how the bytes compare.
///
/// # Errors
/// Where they differ, an adapter fails, or there is none: then nothing was compared.
fn check_parity(config: &Path, learners: usize) -> Result<(), CliError> {
    let plan = load(config, &Overrides::default())?;
    let adapters = open_adapters()?;
    let work = Work::new(&plan, learners)?;
    let expected = work.run(&mut cpu_backend(0, None)?)?;
    let equal = format!("equal, {}, {} bytes", count(learners, "learner"), expected.bytes());
    let (mut differing, all) = (0, adapters.len());
    for adapter in adapters {
        let line = match adapter.backend.and_then(|mut gpu| work.run(gpu.as_mut())) {
            Ok(sample) => expected.difference(&sample).map_or(Ok(&equal), |difference| Err(difference.to_string())),
            Err(error) => Err(error.to_string().replace('\n', "\n    ")),
        };
        differing += usize::from(line.is_err());
        let line = line.as_ref().map_or_else(String::as_str, |equal| equal.as_str());
        print(&format!("{}\n  parity: {line}\n", adapter.name))?;
    }
    if differing == 0 { Ok(()) } else { Err(CliError::Parity { differing, adapters: all }) }
}
