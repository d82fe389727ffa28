//! Puts the values of a point into an arm's config.

use super::SweepSource;
use crate::toml::document::{Node, Value};

/// Lays a point over a tree: every other key stays, also beside a member of an inline table.
pub(in crate::config) fn lay(tree: &mut Node, sweep: &SweepSource<'_>, point: &[usize]) {
    for (axis, value) in sweep.axes.iter().zip(sweep.values(point)) {
        if has(tree, &axis.path) {
            put(tree, &axis.path, value);
        }
    }
}

/// Whether the key makes sense in this arm: only a child has a threshold.
pub(in crate::config) fn has(tree: &Node, path: &[String]) -> bool {
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    let ["skill", skill, "applicable", child] = path[..] else { return true };
    let children = tree.get("skill").and_then(|skills| skills.get(skill)).and_then(|skill| skill.get("children"));
    match children.map(|children| &children.value) {
        Some(Value::List(children)) => children.iter().any(|node| matches!(&node.value, Value::Text(t) if t == child)),
        _ => true,
    }
}

fn put(tree: &mut Node, path: &[String], value: &Node) {
    let [first, rest @ ..] = path else { return tree.clone_from(value) };
    if !matches!(tree.value, Value::Table(_)) {
        *tree = Node::empty(value.origin.clone());
    }
    if tree.get(first).is_none() {
        tree.put(first, Node::empty(value.origin.clone()));
    }
    if let Some(node) = tree.get_mut(first) {
        put(node, rest, value);
    }
}
