//! SIMULATE: the robot's body, its actuators, its sensors and what its actions bring about (paper, section III).
//!
//! Twins: `shaders/env/`.

pub mod contact;
pub mod events;
pub mod light;
pub mod memory;
pub mod motion;
pub mod observation;
pub mod observe;
pub mod reset;
pub mod segments;
pub mod sonar;
pub mod step;
pub mod workgroup;
