//! Who does the work: the scalar reference, the CPU on one thread and on all, and every exact adapter.

use super::BenchError;
use crate::backend::Backend;
use crate::backend::cpu::CpuBackend;
use crate::backend::open::{OpenAdapter, open_adapters};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Which of them to measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// The scalar reference and the CPU.
    Cpu,
    /// All adapters, and the CPU to compare them with.
    Gpu,
    /// Everybody.
    All,
}

/// One who does work.
pub struct Executor {
    /// What it is, as results tell it.
    pub about: About,
    backend: Option<Box<dyn Backend>>,
}

/// What an executor is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// Short name, which rows of results refer to.
    pub name: String,
    /// The kind.
    pub kind: Kind,
    /// Threads of the CPU that it may use.
    pub threads: usize,
    /// What executes, in words: instruction set, or adapter and driver.
    pub device: String,
}

/// Kinds of executors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The scalar reference.
    Scalar,
    /// The CPU backend.
    Cpu,
    /// A graphics card.
    Gpu,
    /// A graphics adapter that is a program on the CPU.
    SoftwareGpu,
}

impl fmt::Debug for Executor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Executor({:?})", self.about)
    }
}

impl Executor {
    /// The scalar reference, on one thread.
    pub fn scalar() -> Self {
        let device = "one value at a time, compiled for any CPU of this kind".to_owned();
        Self { about: About { name: "scalar".to_owned(), kind: Kind::Scalar, threads: 1, device }, backend: None }
    }

    /// A backend.
    pub fn of(name: &str, kind: Kind, threads: usize, backend: Box<dyn Backend>) -> Self {
        let device = backend.describe();
        Self { about: About { name: name.to_owned(), kind, threads, device }, backend: Some(backend) }
    }

    /// The backend, or none for the scalar reference.
    pub fn backend(&mut self) -> Option<&mut (dyn Backend + 'static)> {
        self.backend.as_deref_mut()
    }

    fn cpu(threads: usize) -> Result<Self, BenchError> {
        let backend = CpuBackend::new(threads, None)?;
        Ok(Self::of(&format!("cpu-{threads}"), Kind::Cpu, threads, Box::new(backend)))
    }
}

/// Opens the executors. The first one is exact by definition; the second list says who was left out and why.
///
/// # Errors
/// Where adapters are asked for and there is none.
pub fn open(choice: Choice) -> Result<(Vec<Executor>, Vec<String>), BenchError> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut executors = Vec::new();
    let mut left_out = Vec::new();
    if choice != Choice::Gpu {
        executors.push(Executor::scalar());
    }
    executors.push(Executor::cpu(1)?);
    if choice != Choice::Gpu && threads > 1 {
        executors.push(Executor::cpu(threads)?);
    }
    if choice == Choice::Cpu {
        return Ok((executors, left_out));
    }
    let found = match open_adapters() {
        Ok(found) => found,
        Err(error) if choice == Choice::Gpu => return Err(error.into()),
        Err(error) => {
            left_out.push(format!("GPU: {}", error.to_string().lines().next().unwrap_or_default()));
            Vec::new()
        }
    };
    for (number, adapter) in found.into_iter().enumerate() {
        let OpenAdapter { name, driver, software, inexact, backend } = adapter;
        match (backend, inexact) {
            (Err(error), _) => left_out.push(format!("{name}: {error}")),
            (Ok(_), Some(reason)) => left_out.push(format!("{name}: its bytes are not the CPU's ({reason})")),
            (Ok(gpu), None) => {
                let (kind, threads) = if software { (Kind::SoftwareGpu, threads) } else { (Kind::Gpu, 1) };
                let mut executor = Executor::of(&format!("gpu-{number}"), kind, threads, gpu);
                executor.about.device = format!("{}, {driver}", executor.about.device);
                executors.push(executor);
            }
        }
    }
    Ok((executors, left_out))
}
