//! The memory of a learner.
pub mod layout;
