//! The planner: against exact values in corridors, and at work in the office.

mod corridors;
mod office;
