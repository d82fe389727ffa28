//! skilltree
pub mod config;
pub mod learner;
pub mod record;
pub mod report;
pub mod world;
