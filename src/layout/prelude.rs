//! What the shaders share with Rust.

use super::phase::PHASES;
use super::purpose::PURPOSES;
use super::{CONSTANTS, STRUCTS};
use std::fmt::Write;

/// The text that opens every shader: constants, random purposes and structs.
pub fn prelude() -> String {
    let mut text = String::new();
    for (name, value) in CONSTANTS {
        let _ = writeln!(text, "const {name}: u32 = {value}u;");
    }
    for (name, purpose) in PURPOSES {
        let _ = writeln!(text, "const {name}: u32 = {}u;", *purpose as u32);
    }
    for (name, phase) in PHASES {
        let _ = writeln!(text, "const {name}: u32 = {phase}u;");
    }
    for declaration in STRUCTS.into_iter().flatten() {
        text.push_str(declaration);
    }
    text
}
