//! Which backend executes the kernels.

use super::output::tell;
use crate::backend::cpu::cpu_backend;
use crate::backend::gpu::{GpuBackend, GpuOptions};
use crate::backend::{Backend, BackendError};
use clap::{Args, ValueEnum};

/// Where the kernels are executed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Choice {
    /// A real GPU if there is an exact one, else the CPU.
    Auto,
    /// The CPU, on all cores.
    Cpu,
    /// A GPU; a software adapter if there is no other.
    Gpu,
}

/// Options that choose and tune a backend. None of them changes a result.
#[derive(Debug, Args)]
pub(super) struct BackendArguments {
    /// Where to execute: a real and exact GPU if there is one (auto), the CPU, or a GPU.
    #[arg(long, value_enum, default_value = "auto", value_name = "WHERE")]
    pub(super) backend: Choice,
    /// Part of an adapter's name, as `skilltree devices` lists them; chooses it even if it is software.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Threads of the CPU backend; 0 is one per core.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1024))]
    threads: u32,
    /// Quanta (steps or replayed transitions) of each learner per dispatch; found out if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    iterations: Option<u32>,
}

impl BackendArguments {
    /// Opens the backend and says what it is.
    pub(super) fn open(&self) -> Result<Box<dyn Backend>, BackendError> {
        let options =
            GpuOptions { adapter: self.adapter.clone(), iterations: self.iterations, ..GpuOptions::default() };
        match self.backend {
            Choice::Gpu => Ok(Box::new(GpuBackend::new(&options)?)),
            // An adapter that is asked for by name is wanted, even where `auto` would not choose it.
            Choice::Auto if self.adapter.is_some() => Ok(Box::new(GpuBackend::new(&options)?)),
            Choice::Auto => match GpuBackend::exact(&options) {
                Ok(backend) => Ok(Box::new(backend)),
                Err(reason) => {
                    let reason = reason.to_string();
                    tell(&format!("no exact GPU, so the CPU it is: {}", reason.lines().next().unwrap_or_default()));
                    self.cpu()
                }
            },
            Choice::Cpu => self.cpu(),
        }
    }

    fn cpu(&self) -> Result<Box<dyn Backend>, BackendError> {
        Ok(Box::new(cpu_backend(self.threads as usize, self.iterations)?))
    }
}
