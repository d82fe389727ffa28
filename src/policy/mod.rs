//! DECIDE: from what the robot senses to what it does.
//!
//! Twins: `shaders/policy/`.

pub mod applicability;
pub mod features;
pub mod hierarchy;
pub mod persistence;
pub mod planner_table;
pub mod select;
