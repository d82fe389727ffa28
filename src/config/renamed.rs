//! Keys and words of earlier versions, and what they are called now.

use super::keys;
use crate::toml::document::{KeyValue, Node, Value};
use crate::toml::error::ConfigError;

/// Old paths and new ones; `*` stands for a name that the file gives.
const KEYS: &[(&str, &str)] = &[
    ("alter", "transfer"),
    ("arm.*.like", "extends"),
    ("teacher.bank", "lessons"),
    ("teacher.episodes", "eval_episodes"),
    ("robot.memory.light", "light_decay"),
    ("robot.memory.doors", "door_decay"),
    ("robot.memory.ranges", "range_decay"),
    ("learning.init", "init_range"),
    ("learning.rate", "learning_rate"),
    ("learning.rate_end_share", "learning_rate_end_share"),
    ("learning.rate_trials", "learning_rate_trials"),
    ("learning.target_limit", "target_clip"),
    ("learning.memory", "replay_capacity"),
    ("learning.mean_age", "replay_mean_age"),
    ("learning.taught_passes", "pretrain_epochs"),
    ("learning.taught_always", "taught_as_policy"),
    ("learning.inner_share", "intra_skill_share"),
    ("skill.*.choice", "policy"),
    ("skill.*.decision_steps", "child_timeout"),
    ("skill.*.planned", "oracle"),
    ("skill.*.tests", "eval_starts"),
    ("skill.*.tested_at", "eval_at"),
    ("skill.*.ends", "goal"),
];
/// Key, old word and new one.
const WORDS: &[(&str, &str, &str)] = &[("skill.*.policy", "ordered", "fixed-priority")];

/// Refuses the first old key or word, with the new one as the hint.
pub(super) fn refuse(tree: &Node) -> Result<(), ConfigError> {
    walk(tree, &[])
}

fn walk(node: &Node, above: &[&str]) -> Result<(), ConfigError> {
    for entry in node.entries() {
        let path = [above, &[entry.key.as_str()]].concat();
        check(entry, &path)?;
        walk(&entry.node, &path)?;
    }
    Ok(())
}

fn check(entry: &KeyValue, path: &[&str]) -> Result<(), ConfigError> {
    if let Some((_, new)) = KEYS.iter().find(|(old, _)| keys::is(old, path)) {
        let message = format!("`{}` has another name now", path.join("."));
        return Err(entry.origin.error(message, format!("write `{new}`")));
    }
    for (_, old, new) in WORDS.iter().filter(|(key, ..)| keys::is(key, path)) {
        let written = match &entry.node.value {
            Value::List(items) => &items[..],
            _ => std::slice::from_ref(&entry.node),
        };
        if let Some(node) = written.iter().find(|node| matches!(&node.value, Value::Text(text) if text == old)) {
            let message = format!("`{old}` of `{}` has another name now", path.join("."));
            return Err(node.origin.error(message, format!("write \"{new}\"")));
        }
    }
    Ok(())
}
