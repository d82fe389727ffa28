//! What the shaders share with Rust.

use super::phase::PHASES;
use super::purpose::PURPOSES;
use super::{ACTIONS, CONSTANTS, STRUCTS, actions, choices, events, sensors};
use std::fmt::Write;

/// The text that opens every shader: constants, codes, random purposes and structs.
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
    for (name, code) in [actions::CODES, choices::CODES, events::CODES, sensors::CODES].into_iter().flatten() {
        let _ = writeln!(text, "const {name}: u32 = {code}u;");
    }
    let turns: Vec<String> = actions::ACTION_TURN.iter().map(|degrees| format!("{degrees:?}f")).collect();
    let _ = writeln!(text, "const ACTIONS: u32 = {ACTIONS}u;");
    let _ = writeln!(text, "const ACTION_TURN = array<f32, {ACTIONS}>({});", turns.join(", "));
    for declaration in STRUCTS.into_iter().flatten() {
        text.push_str(declaration);
    }
    text
}
