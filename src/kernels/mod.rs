//! The kernels: what a device is asked to execute.
//!
//! Twins: `shaders/kernels/`.

pub mod evaluate;
pub mod plain;
pub mod step;
pub mod train;
