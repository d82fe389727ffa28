//! A tree back to TOML text.

use super::document::{Node, SWEEP, Value};
use super::reader::is_name;
use std::fmt::Write;

/// The text of a document: plain values first, then tables under headers, in the order of the tree.
pub(crate) fn document(tree: &Node) -> String {
    let mut out = String::new();
    table(tree, "", &mut out);
    out
}

fn table(node: &Node, path: &str, out: &mut String) {
    for entry in node.entries().iter().filter(|entry| !is_table(&entry.node)) {
        line(&key(&entry.key), &entry.node, out);
    }
    for entry in node.entries().iter().filter(|entry| is_table(&entry.node)) {
        let (path, entries) = (below(path, &entry.key), entry.node.entries());
        // A table of tables needs no header of its own.
        if path == SWEEP || entries.is_empty() || entries.iter().any(|entry| !is_table(&entry.node)) {
            // Writing to a String cannot fail.
            let _ = writeln!(out, "\n[{path}]");
        }
        if path == SWEEP { axes(&entry.node, "", out) } else { table(&entry.node, &path, out) }
    }
}

/// The axes of a sweep in their order, which numbers the points: no header may come between.
fn axes(node: &Node, path: &str, out: &mut String) {
    for entry in node.entries() {
        let path = below(path, &entry.key);
        if is_table(&entry.node) && !entry.node.is_axis() {
            axes(&entry.node, &path, out);
        } else {
            line(&path, &entry.node, out);
        }
    }
}

fn line(path: &str, node: &Node, out: &mut String) {
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{path} = {}", value(node));
}

fn below(path: &str, name: &str) -> String {
    if path.is_empty() { key(name) } else { format!("{path}.{}", key(name)) }
}

fn is_table(node: &Node) -> bool {
    matches!(node.value, Value::Table(_))
}

fn key(key: &str) -> String {
    if is_name(key) { key.to_owned() } else { text(key) }
}

fn text(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn value(node: &Node) -> String {
    match &node.value {
        Value::Text(content) => text(content),
        Value::Integer(number) => number.to_string(),
        // Debug of f64 is the shortest text that reads back as the same number, and always has a point or an exponent.
        Value::Float(number) => format!("{number:?}"),
        Value::Flag(flag) => flag.to_string(),
        Value::List(items) => format!("[{}]", items.iter().map(value).collect::<Vec<_>>().join(", ")),
        Value::Table(entries) => {
            let each = entries.iter().map(|entry| format!("{} = {}", key(&entry.key), value(&entry.node)));
            format!("{{ {} }}", each.collect::<Vec<_>>().join(", "))
        }
    }
}
