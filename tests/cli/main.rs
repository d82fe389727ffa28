//! The program as its user meets it: every mistake has one clear message, the right exit code, and no consequence.

mod console;
mod fixture;
mod mistakes;
mod no_adapter;
mod probe;
mod report;
mod run;
#[path = "../support/mod.rs"]
mod support;
