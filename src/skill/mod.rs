//! DECIDE: from what the robot senses to what it does, and what that earns.
//!
//! Twins: `shaders/skill/`.

pub mod choose;
pub mod encode;
pub mod observe;
pub mod reward;
pub mod start;
