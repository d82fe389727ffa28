//! `skilltree devices`: every adapter, whether it is exact, and why one is not used.

use super::output::print;
use super::{Failure, exit_codes, parity};
use crate::backend::gpu::adapter::adapters;
use crate::backend::gpu::arithmetic_check::ANSWER_WORDS;
use crate::backend::gpu::conformance::{QUESTIONS, Verdict, examine};
use crate::backend::gpu::device::{Device, is_software, takes_spirv};
use crate::backend::gpu::loop_limit::SAFE_TURNS;
use crate::backend::gpu::{GpuOptions, adapter};
use serde::Serialize;
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
pub(super) struct Arguments {
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

/// What is known of all adapters.
#[derive(Debug, Serialize)]
struct Listing {
    adapters: Vec<Entry>,
    /// Why there is none.
    none: Option<String>,
}

/// What is known of one adapter.
#[derive(Debug, Serialize)]
struct Entry {
    name: String,
    backend: String,
    driver: String,
    kind: String,
    software: bool,
    max_buffer_bytes: u64,
    max_binding_bytes: u64,
    max_storage_buffers: u32,
    takes_spirv: bool,
    exact: bool,
    /// The first difference, or what failed.
    reason: Option<String>,
    subnormals_kept: Option<bool>,
    loop_budget: Option<u32>,
}

/// Prints the adapters, or what they do to an experiment.
///
/// # Errors
/// Where an adapter is to leave the CPU's bytes and does not. A machine without adapters is not in error.
pub(super) fn devices(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(config) = &arguments.parity {
        return parity::check(config, arguments.learners as usize);
    }
    let listing = listing();
    if arguments.json {
        let text = serde_json::to_string_pretty(&listing).unwrap_or_default();
        print(&(text + "\n"))
    } else {
        print(&text(&listing))
    }
}

fn listing() -> Listing {
    let (_instance, found) = adapters();
    let entries: Vec<Entry> = found.iter().map(entry).collect();
    let none = if entries.is_empty() {
        adapter::choose(GpuOptions::default().adapter.as_deref(), true).err().map(|error| error.to_string())
    } else {
        None
    };
    Listing { adapters: entries, none }
}

fn entry(adapter: &wgpu::Adapter) -> Entry {
    let (info, limits) = (adapter.get_info(), adapter.limits());
    let examined = Device::open(adapter).and_then(|device| examine(&device));
    let (verdict, failure) = match examined {
        Ok(verdict) => (Some(verdict), None),
        Err(error) => (None, error.to_string().lines().next().map(str::to_owned)),
    };
    let of = |get: fn(&Verdict) -> Option<String>| verdict.as_ref().and_then(get);
    Entry {
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_string(),
        kind: kind(info.device_type).to_owned(),
        software: is_software(&info),
        name: info.name,
        max_buffer_bytes: limits.max_buffer_size,
        max_binding_bytes: limits.max_storage_buffer_binding_size,
        max_storage_buffers: limits.max_storage_buffers_per_shader_stage,
        takes_spirv: takes_spirv(adapter),
        exact: verdict.as_ref().is_some_and(|verdict| verdict.exact),
        reason: failure.or_else(|| of(|verdict| verdict.reason.clone())),
        subnormals_kept: verdict.as_ref().map(|verdict| verdict.subnormals),
        loop_budget: verdict.as_ref().and_then(|verdict| verdict.loop_budget),
    }
}

fn kind(kind: wgpu::DeviceType) -> &'static str {
    match kind {
        wgpu::DeviceType::DiscreteGpu => "graphics card",
        wgpu::DeviceType::IntegratedGpu => "graphics within the CPU",
        wgpu::DeviceType::VirtualGpu => "virtual graphics card",
        wgpu::DeviceType::Cpu => "software, on the CPU",
        wgpu::DeviceType::Other => "of unknown type",
    }
}

fn text(listing: &Listing) -> String {
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

fn lines(entry: &Entry) -> Vec<(&'static str, String)> {
    let mib = |bytes: u64| bytes >> 20;
    let exact = match (&entry.reason, entry.exact) {
        (_, true) => {
            format!("yes: {} functions and shapes, {QUESTIONS} inputs each, the bits of the CPU", ANSWER_WORDS - 1)
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
        Some(budget) => format!("ended by the driver after {budget} turns; dispatches stay below {SAFE_TURNS}"),
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
