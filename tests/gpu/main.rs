//! The kernels on a graphics adapter: the shipped shaders against the CPU, and what drives them.
//!
//! A machine without any adapter fails these tests: install software Vulkan (mesa-vulkan-drivers). Nothing here is
//! skipped.
#![cfg(feature = "gpu")]

mod adapter;
mod broken;
mod conformance;
mod counted_turns;
mod faults;
mod held;
mod in_flight;
#[path = "../support/lessons.rs"]
mod lessons;
mod parity;
mod runs;
mod shaders;
#[path = "../support/work.rs"]
mod work;
