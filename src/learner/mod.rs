//! The memory of a learner: layout, sizes and views.

pub mod layout;
pub mod memory;
