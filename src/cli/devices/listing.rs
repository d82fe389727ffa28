//! What `skilltree devices` says.

use serde::Serialize;
use std::fmt::Write;

/// What is known of all adapters.
#[derive(Debug, Serialize)]
pub(super) struct DeviceList {
    pub(super) adapters: Vec<AdapterReport>,
    /// Why there is none.
    pub(super) none: Option<String>,
}

/// What is known of one adapter.
#[derive(Debug, Serialize)]
pub(super) struct AdapterReport {
    pub(super) name: String,
    pub(super) backend: String,
    pub(super) driver: String,
    pub(super) kind: String,
    pub(super) software: bool,
    pub(super) max_buffer_bytes: u64,
    pub(super) max_binding_bytes: u64,
    pub(super) max_storage_buffers: u32,
    pub(super) takes_spirv: bool,
    pub(super) exact: bool,
    /// Functions and shapes of which each answer was compared.
    #[serde(skip)]
    pub(super) compared: String,
    /// The first difference, or what failed.
    pub(super) reason: Option<String>,
    pub(super) subnormals_kept: Option<bool>,
    pub(super) loop_budget: Option<u32>,
}

/// What is known of the adapters, for people.
pub(super) fn text(listing: &DeviceList) -> String {
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
    let exact = match (&entry.reason, entry.exact) {
        (_, true) => format!("yes: {}, the bits of the CPU", entry.compared),
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
    let limits = format!(
        "buffers of {} MiB, {} MiB of it at a time; {} storage buffers",
        entry.max_buffer_bytes >> 20,
        entry.max_binding_bytes >> 20,
        entry.max_storage_buffers
    );
    vec![
        ("type", entry.kind.clone()),
        ("driver", format!("{}, {}", entry.backend, entry.driver)),
        ("exact", exact),
        ("used by", used.to_owned()),
        ("limits", limits),
        ("loops", loops),
    ]
}
