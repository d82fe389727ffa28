//! Options that choose a backend.

use super::console::tell;
use crate::backend::open::{BackendChoice, BackendOptions};
use crate::backend::{Backend, BackendError};

/// Options that choose and tune a backend. None of them changes a result.
#[derive(Debug, clap::Args)]
pub(super) struct BackendArguments {
    /// Where to execute: a real and exact GPU if there is one (auto), the CPU, or a GPU.
    #[arg(long, value_enum, default_value = "auto", value_name = "WHERE")]
    backend: BackendChoice,
    /// Part of an adapter's name, as `skilltree devices` lists them; chooses it even if it is software.
    #[arg(long, value_name = "NAME")]
    adapter: Option<String>,
    /// Threads of the CPU backend; 0 is one per core.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1024))]
    threads: u32,
    /// Iterations (steps or replayed transitions) of each learner per dispatch; found out if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    iterations: Option<u32>,
}

impl BackendArguments {
    /// Opens the backend, and says why where it is not the GPU that might be hoped for.
    pub(super) fn open(&self) -> Result<Box<dyn Backend>, BackendError> {
        let options = BackendOptions {
            choice: self.backend,
            adapter: self.adapter.clone(),
            threads: self.threads as usize,
            iterations: self.iterations,
        };
        options.open(&mut |reason| {
            let reason = reason.to_string();
            tell(&format!("no exact GPU, so the CPU it is: {}", reason.lines().next().unwrap_or_default()));
        })
    }
}
