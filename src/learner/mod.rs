//! The memory of a learner: layout, sizes and views.

#[macro_use]
mod declare;

pub mod build;
pub mod layout;
pub mod memory;
pub mod phase;
pub mod prelude;
