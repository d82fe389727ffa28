//! The reference of every key, as text and as JSON schemas for editors.

use super::events::event_names;
use super::keys::{self, Allowed, DefaultSource, KeyRow};
use crate::layout::{Action, Event, Input, RegionEvent};
use crate::world;
use serde_json::{Value, json};
use std::fmt::Write;

/// The keys that match a pattern, in words; all without one. A pattern is part of a path or of a sentence, in any case,
/// or the path of one skill's or arm's key, such as `skill.dock.trials`.
pub fn text(pattern: &str) -> String {
    let rows = |rows: &mut dyn Iterator<Item = &'static KeyRow>| -> Vec<(String, String)> {
        rows.filter(|row| matches(row, pattern)).map(entry).collect()
    };
    let names = |title: &'static str, names: Vec<(String, &str)>| {
        let wanted = |(name, doc): &(String, &str)| [title, name, doc].iter().any(|text| holds(text, pattern));
        let found = names.into_iter().filter(wanted).map(|(name, doc)| (name, doc.trim().to_owned()));
        (title, found.collect())
    };
    let events = Event::ALL.iter().map(|event| event.doc()).chain(RegionEvent::ALL.iter().map(|event| event.doc()));
    let width = |input: &Input| format!("{} ({})", input.name(), input.width_in_words());
    let sections = [
        ("Config files", rows(&mut keys::all())),
        names("Actions", Action::ALL.iter().map(|action| (action.name().to_owned(), action.doc())).collect()),
        names("Events", event_names().into_iter().zip(events).collect()),
        names("Inputs", Input::ALL.iter().map(|input| (width(input), input.doc())).collect()),
        ("World files", rows(&mut world::keys::ALL.iter())),
    ];
    let mut out = String::new();
    for (title, entries) in sections.iter().filter(|(_, entries)| !entries.is_empty()) {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{title}\n");
        for (name, said) in entries {
            let _ = writeln!(out, "  {name}\n      {said}\n");
        }
    }
    out
}

/// A key with its default, and what is said of it.
fn entry(row: &KeyRow) -> (String, String) {
    let source = match row.source {
        DefaultSource::Paper => "paper",
        DefaultSource::Ours => "ours",
    };
    let default = row.default.map_or_else(String::new, |text| format!(" = {text}  (default: {source})"));
    (format!("{}{default}", row.path), format!("{}\n      {}", row.allowed, row.doc.trim()))
}

fn holds(text: &str, pattern: &str) -> bool {
    text.to_lowercase().contains(&pattern.to_lowercase())
}

fn matches(row: &KeyRow, pattern: &str) -> bool {
    holds(row.path, pattern) || holds(row.doc, pattern) || keys::is(row.path, &pattern.split('.').collect::<Vec<_>>())
}

/// A JSON schema of config files, for editors that complete and check TOML.
pub fn config_schema() -> Value {
    let mut root = object();
    for row in keys::all() {
        insert(&mut root, &row.path.split('.').collect::<Vec<_>>(), leaf(row));
    }
    let below = |node: &Value, key: &str| node["properties"][key].clone();
    let learning = below(&root, "learning");
    root["properties"]["skill"]["additionalProperties"]["properties"]["learning"] = learning;
    root["properties"]["transfer"]["additionalProperties"]["properties"]["noise"] =
        below(&below(&root, "robot"), "noise");
    for key in ["world", "root", "learning", "skill", "robot", "teacher"] {
        let own = below(&root, key);
        root["properties"]["arm"]["additionalProperties"]["properties"][key] = own;
    }
    // Its other keys are those of the axes, with lists and ranges for values.
    root["properties"]["sweep"]["additionalProperties"] = json!(true);
    document(root, "skilltree config")
}

/// A JSON schema of world files.
pub fn world_schema() -> Value {
    let mut root = object();
    for row in world::keys::ALL {
        insert(&mut root, &row.path.split('.').collect::<Vec<_>>(), leaf(row));
    }
    document(root, "skilltree world")
}

fn document(mut root: Value, title: &str) -> Value {
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!(title);
    root
}

fn object() -> Value {
    json!({ "type": "object", "properties": {}, "additionalProperties": false })
}

/// Puts a leaf under a path, with objects, lists of objects (`name[]`) and objects with free names (`*`) on the way.
fn insert(node: &mut Value, path: &[&str], leaf: Value) {
    let [first, rest @ ..] = path else {
        *node = leaf;
        return;
    };
    let next = match first.strip_suffix("[]") {
        _ if *first == "*" => &mut node["additionalProperties"],
        Some(name) => {
            let list = &mut node["properties"][name];
            if list.is_null() {
                *list = json!({ "type": "array", "items": object() });
            }
            &mut list["items"]
        }
        None => &mut node["properties"][*first],
    };
    if !next.is_object() {
        *next = object();
    }
    insert(next, rest, leaf);
}

fn leaf(row: &KeyRow) -> Value {
    let mut out = match row.allowed {
        Allowed::Number(bounds) => {
            let low = if bounds.open_low { "exclusiveMinimum" } else { "minimum" };
            let high = if bounds.open_high { "exclusiveMaximum" } else { "maximum" };
            json!({ "type": "number", (low): bounds.low, (high): bounds.high })
        }
        Allowed::Whole(low, high) => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Allowed::Flag => json!({ "type": "boolean" }),
        Allowed::Choice(words) => json!({ "enum": words }),
        Allowed::Other(types, _) => json!({ "type": types }),
    };
    out["description"] = match row.allowed {
        Allowed::Other(_, words) => json!(format!("{} ({words})", row.doc.trim())),
        _ => json!(row.doc.trim()),
    };
    let parsed = row.default.and_then(|text| toml::from_str::<toml::Table>(&format!("value = {text}")).ok());
    let default = parsed.and_then(|mut table| table.remove("value"));
    if let Some(default) = default.and_then(|value| serde_json::to_value(value).ok()) {
        out["default"] = default;
    }
    out
}
