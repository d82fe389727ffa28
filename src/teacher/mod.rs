//! The teacher: a privileged planner that knows the floor plan and the robot's pose.
//!
//! It demonstrates skills to learners, and its own success is the bound that reports show. It solves any
//! skill that is defined by events in any world: nothing in it is written for docking. Host only; it moves
//! the robot with the same twins as the kernels, so what it plans for is what happens.

pub mod demonstrations;
pub mod grid;
mod slip;
mod task;
pub mod value_iteration;
