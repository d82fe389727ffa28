//! `--set a.b=v`: values that the command line lays over a config file.

use crate::toml::document::{KeyValue, Node, SourceSpan, SourceText, Value};
use crate::toml::error::{ConfigError, Place, suggest};
use crate::toml::reader::is_name;
use std::sync::Arc;

const SHAPE: &str = "write --set key=value, such as --set learning.learning_rate=0.01";

/// Lays one `--set` over the tree. It may not invent skills, arms or transfers.
pub(super) fn apply(tree: &mut Node, argument: &str) -> Result<(), ConfigError> {
    let shown = format!("--set {argument}");
    let wrong = |message: &str, hint: &str| ConfigError::new(Place::Argument(shown.clone()), message, hint);
    let Some((path, value)) = argument.split_once('=') else { return Err(wrong("there is no `=`", SHAPE)) };
    let source = Arc::new(SourceText::Argument(shown.clone()));
    let keys: Vec<&str> = path.split('.').map(str::trim).collect();
    if !keys.iter().all(|key| is_name(key)) {
        return Err(wrong(&format!("`{}` is not the name of a key", path.trim()), SHAPE));
    }
    known(tree, &keys, &wrong)?;
    let mut node = read(value.trim(), &source).unwrap_or_else(|| {
        let message = format!("`{}` is not a value", value.trim());
        Err(wrong(&message, "write a number, true, false, a word, \"text in quotes\", or [\"a\", \"list\"]"))
    })?;
    for key in keys.into_iter().rev() {
        let origin = SourceSpan { source: Arc::clone(&source), span: 0..0 };
        let entry = KeyValue { key: key.to_owned(), origin: origin.clone(), node };
        node = Node { value: Value::Table(vec![entry]), origin };
    }
    tree.merge(node);
    Ok(())
}

/// A TOML value, or a bare word as text.
fn read(value: &str, source: &Arc<SourceText>) -> Option<Result<Node, ConfigError>> {
    let word = || {
        let bare = !value.is_empty() && value.chars().all(|c| c.is_ascii_alphanumeric() || "-_.:/+=".contains(c));
        let origin = SourceSpan { source: Arc::clone(source), span: 0..0 };
        bare.then(|| Ok(Node { value: Value::Text(value.to_owned()), origin }))
    };
    Node::parse_value(value, source).or_else(word)
}

/// Skills, arms and transfers that a `--set` path names must be in the file.
fn known(tree: &Node, keys: &[&str], wrong: &dyn Fn(&str, &str) -> ConfigError) -> Result<(), ConfigError> {
    let check = |group: &str, name: &str| {
        let names = names(tree, group);
        if names.contains(&name) {
            return Ok(());
        }
        Err(wrong(&format!("there is no {group} `{name}`"), &suggest(name, &format!("{group}s"), &names)))
    };
    match keys {
        ["skill", skill, ..] | ["sweep", "skill", skill, ..] => check("skill", skill),
        ["arm", arm, "skill", skill, ..] => check("arm", arm).and_then(|()| check("skill", skill)),
        ["arm", arm, ..] => check("arm", arm),
        ["transfer", transfer, ..] => check("transfer", transfer),
        _ => Ok(()),
    }
}

/// Keys of the table under `group`.
pub(super) fn names<'a>(tree: &'a Node, group: &str) -> Vec<&'a str> {
    match tree.get(group).map(|node| &node.value) {
        Some(Value::Table(entries)) => entries.iter().map(|entry| entry.key.as_str()).collect(),
        _ => Vec::new(),
    }
}
