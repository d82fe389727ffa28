//! From what the user typed to a checked, immutable plan.
pub mod plan;
