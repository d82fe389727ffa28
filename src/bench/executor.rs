//! Who does the work: the CPU on one thread and on all, and every exact adapter.

use super::BenchError;
use super::timing::cores;
use crate::backend::Backend;
use crate::backend::cpu::cpu_backend;
use crate::backend::open::{OpenAdapter, open_adapters};
use crate::backend::reference::reference_backend;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Which executors to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ExecutorSet {
    /// The plain twins, and the CPU on one thread and on all.
    Cpu,
    /// Every exact adapter, and the CPU on one thread.
    Gpu,
    /// Everybody.
    All,
}

/// A backend with its name in the results.
pub struct Executor {
    /// What it is, as results tell it.
    pub info: ExecutorInfo,
    /// Does the work.
    pub backend: Box<dyn Backend>,
}

/// What an executor is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExecutorInfo {
    /// Short name, which rows of results refer to: `reference`, `cpu-1`, `cpu-8`, `gpu-0`.
    pub name: String,
    /// The kind.
    pub kind: ExecutorKind,
    /// Threads of the CPU that it may use.
    pub threads: usize,
    /// What executes, in words: instruction set, or adapter and driver.
    pub device: String,
}

/// Kinds of executors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExecutorKind {
    /// The plain twins.
    Reference,
    /// The CPU backend.
    Cpu,
    /// A graphics card.
    Gpu,
    /// A graphics adapter that is a program on the CPU.
    SoftwareGpu,
}

impl Executor {
    /// A backend under a name.
    pub fn new(name: &str, kind: ExecutorKind, threads: usize, backend: Box<dyn Backend>) -> Self {
        let device = backend.describe();
        Self { info: ExecutorInfo { name: name.to_owned(), kind, threads, device }, backend }
    }

    fn cpu(threads: usize) -> Result<Self, BenchError> {
        let backend = Box::new(cpu_backend(threads, None)?);
        Ok(Self::new(&format!("cpu-{threads}"), ExecutorKind::Cpu, threads, backend))
    }

    fn adapter(number: usize, adapter: OpenAdapter) -> Result<Self, String> {
        let OpenAdapter { name, driver, software, inexact, backend } = adapter;
        let backend = backend.map_err(|error| format!("{name}: {error}"))?;
        if let Some(reason) = inexact {
            return Err(format!("{name}: its bytes are not the CPU's ({reason})"));
        }
        let (kind, threads) = if software { (ExecutorKind::SoftwareGpu, cores()) } else { (ExecutorKind::Gpu, 1) };
        let mut executor = Self::new(&format!("gpu-{number}"), kind, threads, backend);
        executor.info.device = format!("{}, {driver}", executor.info.device);
        Ok(executor)
    }
}

/// Opens executors that run on the CPU; the first one is the reference.
///
/// # Errors
/// Where threads cannot be started.
pub fn open_cpu() -> Result<Vec<Executor>, BenchError> {
    let reference = Box::new(reference_backend(1, None)?);
    let mut executors = vec![Executor::new("reference", ExecutorKind::Reference, 1, reference), Executor::cpu(1)?];
    if cores() > 1 {
        executors.push(Executor::cpu(cores())?);
    }
    Ok(executors)
}

/// Opens executors. The first one is right by definition; the second list says who was left out and why.
///
/// # Errors
/// Where adapters are asked for and there is none.
pub fn open_executors(which: ExecutorSet) -> Result<(Vec<Executor>, Vec<String>), BenchError> {
    let mut executors = if which == ExecutorSet::Gpu { vec![Executor::cpu(1)?] } else { open_cpu()? };
    let mut left_out = Vec::new();
    if which != ExecutorSet::Cpu {
        match open_adapters() {
            Ok(adapters) => {
                for (number, adapter) in adapters.into_iter().enumerate() {
                    match Executor::adapter(number, adapter) {
                        Ok(executor) => executors.push(executor),
                        Err(reason) => left_out.push(reason),
                    }
                }
            }
            Err(error) if which == ExecutorSet::Gpu => return Err(error.into()),
            Err(error) => left_out.push(format!("GPU: {}", error.to_string().lines().next().unwrap_or_default())),
        }
    }
    Ok((executors, left_out))
}
