//! From what the user typed to a checked, immutable plan.
//!
//! [`keys`] is the one table of defaults and ranges. `tree` holds TOML with the place of every value, `set` adds what
//! the command line changes, `read` takes typed values out and refuses what it does not know, and every complaint
//! is a [`ConfigError`] that shows the place and a way out. `hierarchy` finds the skills of an arm and their order,
//! `worlds` the floor plans,
//! `sweep` the points at which arms are run. [`load()`] puts the layers together.

mod arm;
mod arms;
mod children;
mod hierarchy;
mod inputs;
pub mod keys;
mod load;
mod mirror;
pub mod plan;
pub mod reference;
mod renamed;
mod robot;
mod seeds;
mod set;
mod skill;
mod sweep;
mod teacher;
mod transfer;
mod unused_keys;
mod worlds;

pub use crate::toml::{ConfigError, Files, MemoryFiles, OsFiles, Place};
pub use load::{Overrides, load, load_from};
pub use seeds::parse_seeds;
