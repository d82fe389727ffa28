//! skilltree
pub mod advance;
pub mod backend;
pub mod config;
pub mod evaluate;
pub mod experiment;
pub mod learner;
pub mod lesson;
pub mod math;
pub mod qnet;
pub mod record;
pub mod report;
pub mod robot;
pub mod skill;
pub mod step;
pub mod teacher;
pub mod world;
