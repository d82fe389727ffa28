//! What the shaders share with Rust.

use super::codes::CODES;
use super::purpose::PURPOSES;
use super::records::WORDS;
use super::{ACTIONS, CONSTANTS, STRUCTS, actions, events, layout_of, sensors};
use std::fmt::Write;

/// The text that opens every shader: constants, codes, random purposes, words of records and structs.
pub fn prelude() -> String {
    let mut text = String::new();
    for (name, value) in CONSTANTS {
        let _ = writeln!(text, "const {name}: u32 = {value}u;");
    }
    for (name, purpose) in PURPOSES {
        let _ = writeln!(text, "const {name}: u32 = {}u;", *purpose as u32);
    }
    for (name, code) in CODES {
        let _ = writeln!(text, "const {name}: u32 = {code}u;");
    }
    for (record, prefix) in WORDS {
        for (field, offset, _) in layout_of(record).map_or(&[][..], |layout| layout.fields) {
            let _ = writeln!(text, "const {prefix}_{}: u32 = {}u;", field.to_uppercase(), offset / 4);
        }
    }
    for (name, code) in [actions::CODES, events::CODES, sensors::CODES].into_iter().flatten() {
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
