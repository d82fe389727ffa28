//! The reference backend: the plain twins of the shaders, statement for statement.

use super::BackendError;
use super::host::{HostBackend, HostForms};
use crate::env::workgroup::{CohortData, Workgroup};
use crate::kernels::plain::PLAIN;
use crate::layout::{Dispatch, Robot};
use bytemuck::Zeroable;

/// A reference backend; see [`HostBackend::new`].
///
/// # Errors
/// Where the threads cannot be started.
pub fn reference_backend(threads: usize, iterations: Option<u32>) -> Result<HostBackend, BackendError> {
    HostBackend::new(&REFERENCE, threads, iterations)
}

/// The plain forms.
pub const REFERENCE: HostForms = HostForms { kind: "reference", instructions: || "plain", hot: PLAIN, step };

fn step(robots: &mut [Robot], shared: &CohortData, iterations: u32) {
    let mut group = Workgroup {
        dispatch: Dispatch { iterations, ..Dispatch::zeroed() },
        ..Workgroup::new(shared, &[], &REFERENCE.hot)
    };
    for robot in robots {
        group.step(robot);
    }
}
