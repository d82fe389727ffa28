//! Trees of skills, against what is not the product: rules as sets, recursions in f64, geometry by distance fields,
//! logistic fits by another method, and learners that train alone.

mod after;
mod backups;
mod bench;
mod choices;
mod mirrors;
mod nets;
#[path = "../oracle/mod.rs"]
#[expect(dead_code, reason = "other tests use the rest of it")]
mod oracle;
mod persistence;
mod planned;
mod senses;
mod stems;
mod stopped;
mod trees;
