//! A kernel, compiled at its first use, and the governor of its dispatches.

use super::device::Device;
use super::dispatch_size::Governor;
use super::pipeline::Pipeline;
use super::source::Kernel;
use crate::backend::BackendError;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A kernel in use. Drivers take up to many seconds to compile, so that what cohorts in turn hold is compiled once each.
#[derive(Debug)]
pub(super) struct Stage {
    kernel: Kernel,
    /// Numbers of weights of which the largest that fits is held from the next use on.
    pub(super) wanted: Vec<u32>,
    pipelines: HashMap<Vec<u32>, Pipeline>,
    pub(super) governor: Governor,
}

impl Stage {
    /// A kernel whose dispatches have `iterations` iterations, if given.
    pub(super) fn new(kernel: Kernel, iterations: Option<u32>) -> Self {
        Self { kernel, wanted: Vec::new(), pipelines: HashMap::new(), governor: Governor::new(iterations, 1) }
    }

    /// The kernel, ready to run, and its governor.
    ///
    /// # Errors
    /// Where the driver refuses it.
    pub(super) fn ready(&mut self, device: &Device) -> Result<(&Pipeline, &mut Governor), BackendError> {
        let pipeline = match self.pipelines.entry(self.wanted.clone()) {
            Entry::Occupied(made) => made.into_mut(),
            Entry::Vacant(place) => place.insert(Pipeline::new(device, self.kernel, &self.wanted)?),
        };
        Ok((pipeline, &mut self.governor))
    }

    /// Words of a workgroup's memory that hold weights.
    pub(super) fn held(&self) -> u32 {
        self.pipelines.get(&self.wanted).map_or(0, Pipeline::held)
    }

    /// Takes another text in place of the kernel of its name.
    pub(super) fn replace(&mut self, kernel: Kernel) {
        if self.kernel.name == kernel.name {
            self.kernel = kernel;
            self.pipelines.clear();
        }
    }
}
