//! What the shaders share with Rust.

use super::codes::CODES;
use super::purpose::PURPOSES;
use super::records::WORDS;
use super::{CONSTANTS, STRUCTS, layout_of};
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
    for declaration in STRUCTS.into_iter().flatten() {
        text.push_str(declaration);
    }
    text
}
