//! Which keys may be an axis, and what their values may be.

use crate::config::keys::{self, Allowed};
use crate::toml::document::SourceSpan;
use crate::toml::error::{ConfigError, list, nearest, suggest};

/// First parts of the keys that arms have of their own.
const OWN: [&str; 6] = ["world", "root", "learning", "skill", "robot", "teacher"];
/// Tables of a skill whose members may be axes, and what those may be.
const MEMBERS: [(&str, Allowed); 3] = [
    ("applicable", Allowed::Number(keys::THRESHOLD)),
    ("reward", Allowed::Number(keys::AMOUNT)),
    ("starts", Allowed::Number(keys::START_SHARE)),
];

/// Whether keys lie below this path, and no value.
pub(super) fn is_inner(path: &[&str]) -> bool {
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
pub(super) fn allowed(path: &[&str], skills: &[&str], origin: &SourceSpan) -> Result<Allowed, ConfigError> {
    let key = path.join(".");
    if let ["skill", skill, ..] = path
        && !skills.contains(skill)
    {
        return Err(origin.error(format!("there is no skill `{skill}`"), suggest(skill, "skills", skills)));
    }
    if let ["skill", _, table, _] = path
        && let Some((_, allowed)) = MEMBERS.iter().find(|(name, _)| name == table)
    {
        return Ok(*allowed);
    }
    let first = path.first().copied().unwrap_or_default();
    let own = OWN.contains(&first);
    if let Some(row) = keys::all().find(|row| own && keys::is(row.path, path)) {
        return Ok(row.allowed);
    }
    if !own && keys::is_group(first) {
        let hint = format!("an axis may run over the keys of {}", list(&OWN));
        return Err(origin.error(format!("`{key}` is the same at all points"), hint));
    }
    let all = all(path);
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    let hint = match nearest(&key, &all) {
        Some(best) if best == key => "write the key without quotes".to_owned(),
        Some(best) => format!("did you mean `{best}`?"),
        None => "name a key as elsewhere in a config, such as learning.gamma or skill.dock.trials".to_owned(),
    };
    Err(origin.error(format!("unknown key `{key}`"), hint))
}

/// All keys that may be axes; of skills, those of the one that the path names.
fn all(path: &[&str]) -> Vec<String> {
    let own = keys::all().filter(|key| key.path.split('.').next().is_some_and(|first| OWN.contains(&first)));
    let mut all: Vec<String> = own.map(|key| key.path.replace('*', path.get(1).unwrap_or(&"*"))).collect();
    if let ["skill", skill, ..] = path {
        let learning = keys::all().filter(|key| key.path.starts_with("learning."));
        all.extend(learning.map(|key| format!("skill.{skill}.{}", key.path)));
    }
    all
}
