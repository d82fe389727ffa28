//! `--set a.b=v`: values that the command line lays over a config file.

use crate::toml::document::{Node, SourceSpan};
use crate::toml::error::{ConfigError, suggest};
use crate::toml::reader::is_name;

const SHAPE: &str = "write --set key=value, such as --set learning.learning_rate=0.01";

/// Lays one `--set` over the tree. It may not invent skills, arms or transfers.
pub(super) fn apply(tree: &mut Node, argument: &str) -> Result<(), ConfigError> {
    let origin = SourceSpan::Argument(format!("--set {argument}"));
    let Some((path, value)) = argument.split_once('=') else { return Err(origin.error("there is no `=`", SHAPE)) };
    let keys: Vec<&str> = path.split('.').map(str::trim).collect();
    if !keys.iter().all(|key| is_name(key)) {
        return Err(origin.error(format!("`{}` is not the name of a key", path.trim()), SHAPE));
    }
    known(tree, &keys, &origin)?;
    let value = value.trim();
    let is_word = !value.is_empty() && value.chars().all(|c| c.is_ascii_alphanumeric() || "-_.:/+=".contains(c));
    let node = match Node::parse_value(value, &origin)? {
        Some(node) => node,
        None if is_word => Node::text(value, &origin),
        None => {
            let hint = "write a number, true, false, a word, \"text in quotes\", or [\"a\", \"list\"]";
            return Err(origin.error(format!("`{value}` is not a value"), hint));
        }
    };
    tree.merge(node.under(&keys));
    Ok(())
}

/// Skills, arms and transfers that a `--set` path names must be in the file.
fn known(tree: &Node, keys: &[&str], origin: &SourceSpan) -> Result<(), ConfigError> {
    let check = |group: &str, name: &str| {
        let names = tree.names(group);
        if names.contains(&name) {
            return Ok(());
        }
        let hint = suggest(name, &format!("{group}s"), &names);
        Err(origin.error(format!("there is no {group} `{name}`"), hint))
    };
    match keys {
        ["skill", skill, ..] | ["sweep", "skill", skill, ..] => check("skill", skill),
        ["arm", arm, "skill", skill, ..] => check("arm", arm).and_then(|()| check("skill", skill)),
        ["arm", arm, ..] => check("arm", arm),
        ["transfer", transfer, ..] => check("transfer", transfer),
        _ => Ok(()),
    }
}
