//! What the shaders share with Rust.

use super::codes::CODES;
use super::macros::Layout;
use super::purpose::PURPOSES;
use super::records::WORDS;
use super::{actions, choices, dispatch, events, lengths, params, records, sensors, shape, sizes, state, world};
use std::fmt::Write;

/// How Rust lays out every struct that the shaders share.
pub const LAYOUTS: [&[Layout]; 6] =
    [world::LAYOUTS, records::LAYOUTS, shape::LAYOUTS, params::LAYOUTS, state::LAYOUTS, dispatch::LAYOUTS];

/// WGSL text of every one of them.
const STRUCTS: [&[&str]; 6] =
    [world::STRUCTS, records::STRUCTS, shape::STRUCTS, params::STRUCTS, state::STRUCTS, dispatch::STRUCTS];

/// How Rust lays out the struct of this name.
pub fn layout_of(name: &str) -> Option<&'static Layout> {
    LAYOUTS.into_iter().flatten().find(|layout| layout.name == name)
}

/// The text that opens every shader: constants, codes, random purposes, words of records and structs.
pub fn prelude() -> String {
    let mut text = String::new();
    for (name, value) in [sizes::CONSTANTS, records::CONSTANTS].into_iter().flatten() {
        let _ = writeln!(text, "const {name}: u32 = {value}u;");
    }
    for (name, purpose) in PURPOSES {
        let _ = writeln!(text, "const {name}: u32 = {}u;", *purpose as u32);
    }
    for (name, value) in lengths::LENGTHS {
        let _ = writeln!(text, "const {name}: f32 = {value:?}f;");
    }
    for (name, code) in CODES {
        let _ = writeln!(text, "const {name}: u32 = {code}u;");
    }
    for (record, prefix) in WORDS {
        for (field, offset, _) in layout_of(record).map_or(&[][..], |layout| layout.fields) {
            let _ = writeln!(text, "const {prefix}_{}: u32 = {}u;", field.to_uppercase(), offset / 4);
        }
    }
    let codes = [actions::CODES, choices::CODES, events::CODES, sensors::CODES];
    for (name, code) in codes.into_iter().chain(events::EVENT_BITS).flatten() {
        let _ = writeln!(text, "const {name}: u32 = {code}u;");
    }
    let turns: Vec<String> = actions::ACTION_TURN.iter().map(|degrees| format!("{degrees:?}f")).collect();
    let _ = writeln!(text, "const ACTIONS: u32 = {}u;", actions::ACTIONS);
    let _ = writeln!(text, "const ACTION_TURN = array<f32, {}>({});", turns.len(), turns.join(", "));
    for declaration in STRUCTS.into_iter().flatten() {
        text.push_str(declaration);
    }
    text
}
