//! `skilltree devices`: every adapter, whether it is exact, and why one is not used.

#[cfg(feature = "gpu")]
mod examine;
mod listing;

use super::console::print;
use super::error::{CliError, exit_codes};
use super::parity;
use listing::{AdapterReport, DeviceList};
use std::fmt::Write;
use std::path::PathBuf;

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
        return parity::check(config, arguments.learners as usize);
    }
    #[cfg(feature = "gpu")]
    let listing = examine::devices();
    #[cfg(not(feature = "gpu"))]
    let listing = DeviceList { adapters: Vec::new(), none: Some(crate::backend::BackendError::NotBuilt.to_string()) };
    if arguments.json {
        let text = serde_json::to_string_pretty(&listing).unwrap_or_default();
        print(&(text + "\n"))
    } else {
        print(&text(&listing))
    }
}

fn text(listing: &DeviceList) -> String {
    let mut text = String::from("cpu\n  always there; the bytes that every exact adapter gives too\n");
    for entry in &listing.adapters {
        let _ = write!(text, "\n{}\n", entry.name);
        for (key, value) in lines(entry) {
            let _ = writeln!(text, "  {key:<9} {value}");
        }
    }
    if let Some(none) = &listing.none {
        let _ = write!(text, "\nno GPU\n  {}\n", none.replace('\n', "\n  "));
    }
    text
}

fn lines(entry: &AdapterReport) -> Vec<(&'static str, String)> {
    let mib = |bytes: u64| bytes >> 20;
    let exact = match (&entry.reason, entry.exact) {
        (_, true) => {
            format!("yes: {}, the bits of the CPU", entry.compared)
        }
        (Some(reason), _) => format!("no: {reason}"),
        (None, _) => "no".to_owned(),
    };
    let used = match (entry.exact, entry.software) {
        (true, false) => "--backend auto and --backend gpu",
        (_, true) => {
            "--backend gpu where there is no card, or --adapter NAME; never by auto, for it is slower than cpu"
        }
        (false, false) => "--backend gpu only: its results are close to the CPU's, but not the same",
    };
    let loops = match entry.loop_budget {
        Some(budget) => format!("ended by the driver after {budget} turns; dispatches stay below that"),
        None => "no limit seen".to_owned(),
    };
    vec![
        ("type", entry.kind.clone()),
        ("driver", format!("{}, {}", entry.backend, entry.driver)),
        ("exact", exact),
        ("used by", used.to_owned()),
        (
            "limits",
            format!(
                "buffers of {} MiB, {} MiB of it at a time; {} storage buffers",
                mib(entry.max_buffer_bytes),
                mib(entry.max_binding_bytes),
                entry.max_storage_buffers
            ),
        ),
        ("loops", loops),
    ]
}
