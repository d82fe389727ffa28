//! Ground floor: the words of every buffer that a kernel touches, written once for Rust and WGSL.

#[macro_use]
mod macros;

pub mod phase;
pub mod prelude;
pub mod purpose;
mod records;

pub use records::*;
