//! From what the user typed to a checked, immutable plan.
//!
//! `tree` holds TOML with the place of every value, `read` takes typed values out of it and refuses what it
//! does not know, and every complaint is a [`ConfigError`] that shows the place and a way out.

pub mod error;
pub mod plan;
pub(crate) mod read;
pub(crate) mod tree;

pub use error::{ConfigError, Place};
