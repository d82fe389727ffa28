//! `skilltree devices --parity`: does every adapter leave the bytes of the CPU, from end to end?

use super::output::print;
use super::{Failure, count};
use crate::backend::cpu::cpu_backend;
use crate::backend::gpu::adapter::{adapters, choose};
use crate::backend::gpu::{GpuBackend, GpuOptions};
use crate::config::{Overrides, load};
use crate::train::parity::{Sample, Work};
use std::path::Path;

/// Does the same work on the CPU and on every adapter, and prints how the bytes compare.
///
/// # Errors
/// Where they differ, an adapter fails, or there is none: then nothing was compared.
pub(super) fn check(config: &Path, learners: usize) -> Result<(), Failure> {
    let plan = load(config, &Overrides::default())?;
    let (_instance, found) = adapters();
    if found.is_empty() {
        choose(None, true)?;
    }
    let work = Work::new(&plan, learners)?;
    let expected = work.run(&mut cpu_backend(0, None)?)?;
    let mut differing = 0;
    for adapter in &found {
        let sample = GpuBackend::on(adapter, &GpuOptions::default()).and_then(|mut gpu| work.run(&mut gpu));
        let line = match sample {
            Ok(sample) => verdict(&expected, &sample, learners),
            Err(error) => Err(error.to_string().replace('\n', "\n    ")),
        };
        differing += usize::from(line.is_err());
        let (Ok(line) | Err(line)) = line;
        print(&format!("{}\n  parity: {line}\n", adapter.get_info().name))?;
    }
    if differing == 0 { Ok(()) } else { Err(Failure::Parity { differing, adapters: found.len() }) }
}

/// How an adapter's sample compares with the CPU's, which stands on the left.
fn verdict(expected: &Sample, sample: &Sample, learners: usize) -> Result<String, String> {
    match expected.difference(sample) {
        None => Ok(format!("equal, {}, {} bytes", count(learners, "learner"), expected.bytes())),
        Some(difference) => Err(format!("{difference}")),
    }
}
