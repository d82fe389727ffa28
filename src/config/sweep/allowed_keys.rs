//! Which keys may be an axis, and what their values may be.

use crate::config::keys::{self, Allowed};
use crate::config::set;
use crate::toml::document::{Node, SourceSpan};
use crate::toml::error::{ConfigError, nearest, suggest};

/// First parts of the keys that arms have of their own.
const OWN: [&str; 6] = ["world", "root", "learning", "skill", "robot", "teacher"];
/// Tables of a skill whose members may be axes, and what those may be.
const MEMBERS: [(&str, Allowed); 3] = [
    ("applicable", Allowed::Number(keys::THRESHOLD)),
    ("reward", Allowed::Number(keys::AMOUNT)),
    ("starts", Allowed::Number(keys::START_SHARE)),
];

/// The names that paths are made of.
#[derive(Debug)]
pub(super) struct AxisNames<'a> {
    skills: Vec<&'a str>,
}

impl<'a> AxisNames<'a> {
    /// From the complete config.
    pub(super) fn new(base: &'a Node) -> Self {
        Self { skills: set::names(base, "skill") }
    }

    /// Whether keys lie below this path, and no value.
    pub(super) fn inner(&self, path: &[&str]) -> bool {
        match path {
            ["skill"] | ["skill", _] | ["skill", _, "learning"] => true,
            ["skill", _, member] => MEMBERS.iter().any(|(name, _)| name == member),
            _ => {
                let start = path.join(".") + ".";
                keys::all().any(|key| key.path.starts_with(&start))
            }
        }
    }

    /// What the values of the key with this path may be.
    ///
    /// # Errors
    /// If there is no such key, or if it is the same at all points.
    pub(super) fn allowed(&self, path: &[&str], origin: &SourceSpan) -> Result<Allowed, ConfigError> {
        let key = path.join(".");
        if let ["skill", skill, ..] = path
            && !self.skills.contains(skill)
        {
            return Err(origin.error(format!("there is no skill `{skill}`"), suggest(skill, "skills", &self.skills)));
        }
        if let ["skill", _, table, _] = path
            && let Some((_, allowed)) = MEMBERS.iter().find(|(name, _)| name == table)
        {
            return Ok(*allowed);
        }
        let known = match path {
            ["skill", _, "learning", name] => format!("learning.{name}"),
            ["skill", _, name] => format!("skill.*.{name}"),
            _ => key.clone(),
        };
        let first = path.first().copied().unwrap_or_default();
        match keys::all().find(|entry| entry.path == known) {
            Some(entry) if OWN.contains(&first) => return Ok(entry.allowed),
            _ if !OWN.contains(&first) && keys::is_group(first) => {
                let hint = format!("an axis may run over the keys of {}", crate::toml::error::list(&OWN));
                return Err(origin.error(format!("`{key}` is the same at all points"), hint));
            }
            _ => {}
        }
        let all = self.all(path);
        let all: Vec<&str> = all.iter().map(String::as_str).collect();
        let hint = match nearest(&key, &all) {
            Some(best) if best == key => "write the key without quotes".to_owned(),
            Some(best) => format!("did you mean `{best}`?"),
            None => "name a key as elsewhere in a config, such as learning.gamma or skill.dock.trials".to_owned(),
        };
        Err(origin.error(format!("unknown key `{key}`"), hint))
    }

    /// All keys that may be axes; of skills, those of the one that the path names.
    fn all(&self, path: &[&str]) -> Vec<String> {
        let own = keys::all().filter(|key| key.path.split('.').next().is_some_and(|first| OWN.contains(&first)));
        let mut all: Vec<String> = own.map(|key| key.path.replace('*', path.get(1).unwrap_or(&"*"))).collect();
        if let ["skill", skill, ..] = path {
            let learning = keys::all().filter(|key| key.path.starts_with("learning."));
            all.extend(learning.map(|key| format!("skill.{skill}.{}", key.path)));
        }
        all
    }
}
