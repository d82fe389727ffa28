//! The reference of every key, as text and as JSON schemas for editors.

use super::events::event_names;
use super::keys::{self, Allowed, DefaultSource, KeyRow};
use crate::layout::{Action, Event, Input, RegionEvent};
use crate::world;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The keys that match a pattern, in words; all without one. A pattern is part of a path or of a sentence, in any case,
/// or the path of one skill's or arm's key, such as `skill.dock.trials`.
pub fn text(pattern: &str) -> String {
    let mut out = String::new();
    section(&mut out, "Config files", keys::all(), pattern);
    let docs = Event::ALL.iter().map(|event| event.doc()).chain(RegionEvent::ALL.iter().map(|event| event.doc()));
    let names = [
        ("Actions", Action::ALL.iter().map(|a| (a.name().to_owned(), a.doc())).collect::<Vec<_>>()),
        ("Events", event_names().into_iter().zip(docs).collect()),
        ("Inputs", Input::ALL.iter().map(|i| (format!("{} ({})", i.name(), i.width_in_words()), i.doc())).collect()),
    ];
    for (title, rows) in names {
        let wanted = |text: &str| holds(text, pattern);
        let found: Vec<_> =
            rows.into_iter().filter(|(name, doc)| wanted(title) || wanted(name) || wanted(doc)).collect();
        if !found.is_empty() {
            let _ = writeln!(out, "{title}\n");
        }
        for (name, doc) in found {
            let _ = writeln!(out, "  {name}\n      {}\n", doc.trim());
        }
    }
    section(&mut out, "World files", world::keys::ALL.iter(), pattern);
    out
}

fn section(out: &mut String, title: &str, rows: impl Iterator<Item = &'static KeyRow>, pattern: &str) {
    let found: Vec<&KeyRow> = rows.filter(|row| matches(row, pattern)).collect();
    if !found.is_empty() {
        // Writing to a String cannot fail.
        let _ = writeln!(out, "{title}\n");
    }
    for row in found {
        let default = row.default.map_or_else(String::new, |text| format!(" = {text}"));
        let source = match (row.default, row.source) {
            (None, _) => "",
            (_, DefaultSource::Paper) => "  (default: paper)",
            (_, DefaultSource::Ours) => "  (default: ours)",
        };
        let _ = writeln!(out, "  {}{default}{source}", row.path);
        let _ = writeln!(out, "      {}", row.allowed);
        let _ = writeln!(out, "      {}\n", row.doc.trim());
    }
}

fn holds(text: &str, pattern: &str) -> bool {
    text.to_lowercase().contains(&pattern.to_lowercase())
}

fn matches(row: &KeyRow, pattern: &str) -> bool {
    // What lies below an arm, a point of a sweep or a skill is named as it is elsewhere.
    let inner = |path: &str| {
        let names: Vec<&str> = path.split('.').collect();
        let parts: Vec<&str> = row.path.split('.').collect();
        let same = |names: &[&str]| {
            parts.len() == names.len() && parts.iter().zip(names).all(|(part, name)| *part == "*" || part == name)
        };
        match names[..] {
            ["skill", _, "learning", ..] => same(&names[2..]),
            _ => same(&names),
        }
    };
    let arm = pattern.strip_prefix("arm.").and_then(|rest| rest.split_once('.')).map(|(_, rest)| rest);
    let paths = [Some(pattern), arm, pattern.strip_prefix("sweep.")];
    holds(row.path, pattern) || holds(row.doc, pattern) || paths.into_iter().flatten().any(inner)
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
    let mut out = Map::new();
    match row.allowed {
        Allowed::Number(bounds) => {
            out.insert("type".to_owned(), json!("number"));
            let low = if bounds.open_low { "exclusiveMinimum" } else { "minimum" };
            let high = if bounds.open_high { "exclusiveMaximum" } else { "maximum" };
            out.insert(low.to_owned(), json!(bounds.low));
            out.insert(high.to_owned(), json!(bounds.high));
        }
        Allowed::Whole(low, high) => {
            out.insert("type".to_owned(), json!("integer"));
            out.insert("minimum".to_owned(), json!(low));
            out.insert("maximum".to_owned(), json!(high));
        }
        Allowed::Flag => drop(out.insert("type".to_owned(), json!("boolean"))),
        Allowed::Choice(words) => drop(out.insert("enum".to_owned(), json!(words))),
        Allowed::Other(types, _) => drop(out.insert("type".to_owned(), json!(types))),
    }
    let said = match row.allowed {
        Allowed::Other(_, words) => format!("{} ({words})", row.doc.trim()),
        _ => row.doc.trim().to_owned(),
    };
    out.insert("description".to_owned(), json!(said));
    let parsed = row.default.and_then(|text| toml::from_str::<toml::Table>(&format!("value = {text}")).ok());
    let default = parsed.and_then(|mut table| table.remove("value"));
    if let Some(default) = default.and_then(|value| serde_json::to_value(value).ok()) {
        out.insert("default".to_owned(), default);
    }
    Value::Object(out)
}
