//! How a net moves along its gradient: a file pair for each rule.

pub mod adam;
pub mod adam_rows;
pub mod sgd;
