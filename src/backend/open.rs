//! Opens the backend that a user asks for. The one place that knows which backends there are.

use super::cpu::cpu_backend;
#[cfg(feature = "gpu")]
use super::gpu::{GpuBackend, GpuOptions, adapter, device::is_software};
use super::reference::reference_backend;
use super::{Backend, BackendError};

/// Where to execute the kernels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum BackendChoice {
    /// A real GPU if there is an exact one, else the CPU.
    #[default]
    Auto,
    /// The CPU, on all cores.
    Cpu,
    /// The shaders' plain twins, on all cores: slow, and as the shaders are written.
    Reference,
    /// A GPU; a software adapter if there is no other.
    Gpu,
}

/// Which backend, and how it works. Nothing of it changes a result.
#[derive(Debug, Clone, Default)]
pub struct BackendOptions {
    /// Which backend.
    pub choice: BackendChoice,
    /// Part of an adapter's name; chooses it even if it is software.
    pub adapter: Option<String>,
    /// Threads of the CPU backend; 0 is one per core.
    pub threads: usize,
    /// Iterations (steps or replayed transitions) of each learner per dispatch; found out if not given.
    pub iterations: Option<u32>,
}

impl BackendOptions {
    /// Opens the backend. Where [`BackendChoice::Auto`] takes the CPU, `fallback` is told why.
    ///
    /// # Errors
    /// Where the backend that is asked for cannot be had.
    pub fn open(&self, fallback: &mut dyn FnMut(&BackendError)) -> Result<Box<dyn Backend>, BackendError> {
        match self.choice {
            BackendChoice::Gpu => self.gpu(false),
            // An adapter that is asked for by name is wanted, even where `Auto` would not choose it.
            BackendChoice::Auto if self.adapter.is_some() => self.gpu(false),
            BackendChoice::Auto => self.gpu(true).or_else(|reason| {
                fallback(&reason);
                self.cpu()
            }),
            BackendChoice::Cpu => self.cpu(),
            BackendChoice::Reference => Ok(Box::new(reference_backend(self.threads, self.iterations)?)),
        }
    }

    fn cpu(&self) -> Result<Box<dyn Backend>, BackendError> {
        Ok(Box::new(cpu_backend(self.threads, self.iterations)?))
    }

    #[cfg_attr(not(feature = "gpu"), expect(unused_variables, reason = "there is none"))]
    fn gpu(&self, exact: bool) -> Result<Box<dyn Backend>, BackendError> {
        #[cfg(feature = "gpu")]
        {
            let options =
                GpuOptions { adapter: self.adapter.clone(), iterations: self.iterations, ..GpuOptions::default() };
            Ok(Box::new(if exact { GpuBackend::exact(&options)? } else { GpuBackend::new(&options)? }))
        }
        #[cfg(not(feature = "gpu"))]
        Err(BackendError::NotBuilt)
    }
}

/// Opens a backend with default options.
///
/// # Errors
/// Where the backend that is asked for cannot be had.
pub fn open_backend(choice: BackendChoice) -> Result<Box<dyn Backend>, BackendError> {
    BackendOptions { choice, ..BackendOptions::default() }.open(&mut |_reason| ())
}

/// A graphics adapter, opened.
pub struct OpenAdapter {
    /// Its name.
    pub name: String,
    /// Driver and version.
    pub driver: String,
    /// Whether it is a program on the CPU.
    pub software: bool,
    /// Why its bytes are not the CPU's, if they are not.
    pub inexact: Option<String>,
    /// The backend, or why it cannot be had.
    pub backend: Result<Box<dyn Backend>, BackendError>,
}

/// Opens every graphics adapter of this machine.
///
/// # Errors
/// Where there is none, or this build has no GPU backend.
#[cfg(feature = "gpu")]
pub fn open_adapters() -> Result<Vec<OpenAdapter>, BackendError> {
    let (_instance, found) = adapter::adapters();
    if found.is_empty() {
        adapter::choose(None, true)?;
    }
    let open = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        let opened = GpuBackend::on(adapter, &GpuOptions::default());
        let verdict = opened.as_ref().ok().map(|gpu| gpu.verdict().clone()).filter(|verdict| !verdict.exact);
        OpenAdapter {
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            software: is_software(&info),
            name: info.name,
            inexact: verdict.map(|verdict| verdict.reason.unwrap_or_default()),
            backend: opened.map(|gpu| Box::new(gpu) as Box<dyn Backend>),
        }
    };
    Ok(found.iter().map(open).collect())
}

/// Opens every graphics adapter of this machine.
///
/// # Errors
/// Always: this build has no GPU backend.
#[cfg(not(feature = "gpu"))]
pub fn open_adapters() -> Result<Vec<OpenAdapter>, BackendError> {
    Err(BackendError::NotBuilt)
}
