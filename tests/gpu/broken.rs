//! Kernels with faults.

use super::adapter::gpu;
use skilltree::backend::gpu::GpuBackend;
use skilltree::backend::gpu::source::{Kernel, Part};

/// Path of a file of a kernel, a statement in it, and what stands there instead.
pub(crate) type Fault<'a> = (&'a str, &'a str, &'a str);

/// A kernel with other texts in its files.
pub(crate) fn rewritten(kernel: Kernel, rewrite: impl Fn(&Part) -> String) -> Kernel {
    let files: Vec<Part> = kernel.files().map(|part| Part { path: part.path, text: rewrite(part).leak() }).collect();
    Kernel { name: kernel.name, parts: vec![&*files.leak()].leak() }
}

/// The shipped kernel with faults, each put where its statement stands once.
pub(crate) fn broken(kernel: Kernel, faults: &[Fault<'_>]) -> Kernel {
    for (path, from, _) in faults {
        let part = kernel.files().find(|part| part.path == *path).expect("a file of the kernel");
        assert_eq!(part.text.matches(from).count(), 1, "`{from}` must stand in {path} once");
    }
    rewritten(kernel, |part| {
        let own = faults.iter().filter(|(path, ..)| *path == part.path);
        own.fold(part.text.to_owned(), |text, (_, from, to)| text.replace(from, to))
    })
}

/// What a broken kernel does, with the shipped one put back.
pub(crate) fn with<T>(kernel: Kernel, shipped: Kernel, act: impl FnOnce(&mut GpuBackend) -> T) -> T {
    let mut gpu = gpu();
    gpu.replace(kernel);
    let found = act(&mut gpu);
    gpu.replace(shipped);
    found
}
