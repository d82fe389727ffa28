//! SIMULATE: the robot's body, its actuators and its sensors (paper, section III).
//!
//! Twins: `shaders/robot/`.

pub mod collide;
pub mod floor;
pub mod light;
#[path = "move.rs"]
pub mod motion;
pub mod noise;
pub mod sonar;
