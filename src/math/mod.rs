//! Arithmetic that gives the same bits in Rust and in WGSL.
//!
//! Every function here is built from IEEE f32 `+ - *`, comparisons and integer operations in one written
//! order. `fma`, `/` and the built-in elementary functions are not used: their results differ between
//! devices. Twins: `shaders/math/`.

pub mod functions;
pub mod reduce;
pub mod rng;
