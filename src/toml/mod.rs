//! TOML with the place of every value: what config files and floor plans are read with.

pub(crate) mod document;
pub mod error;
pub mod files;
pub(crate) mod printer;
pub(crate) mod reader;

pub use error::{ConfigError, Place};
pub use files::{Files, MemoryFiles, OsFiles};
