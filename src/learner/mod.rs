//! The memory of a learner: layout, sizes and views.

pub mod build;
pub mod layout;
pub mod memory;
