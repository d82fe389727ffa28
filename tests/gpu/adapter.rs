//! The adapter that all of these tests share.

use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

static GPU: LazyLock<Mutex<GpuBackend>> = LazyLock::new(|| Mutex::new(opened(&GpuOptions::default())));

/// The one backend of these tests. Drivers are tested one user at a time: who opens another holds this one as well.
pub(crate) fn gpu() -> MutexGuard<'static, GpuBackend> {
    GPU.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A backend of its own.
pub(crate) fn opened(options: &GpuOptions) -> GpuBackend {
    GpuBackend::new(options).expect("an adapter, if only a software one")
}
