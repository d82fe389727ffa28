//! DECIDE: from what the robot senses to what it does, and what that earns.
//!
//! Twins: `shaders/skill/`.

pub mod act;
pub mod choose;
pub mod consult;
pub mod encode;
pub mod observe;
pub mod persist;
pub mod remember;
pub mod reward;
pub mod start;
