//! From what the user typed to a checked, immutable plan.
//!
//! Every key has one row: [`keys`] has those of this module, [`crate::layout::params`] the numbers that a learner's memory
//! holds; [`mod@reference`] prints them all. [`load()`] puts the layers together: defaults, the config that a file extends, the
//! file, `--set`, each arm's own table, the values at a point of the sweep. `hierarchy` finds the skills of an arm and
//! their order, `worlds` the floor plans, `sweep` the points at which arms are run, `renamed` refuses old names. Every
//! complaint is a [`ConfigError`] that shows the place and a way out.

mod arm;
mod arms;
mod children;
mod events;
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
