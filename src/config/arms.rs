//! The experimental conditions: the base config with each arm's own table laid over it.

use super::arm::{ArmReader, skills};
use super::plan::ArmPlan;
use super::skill::SkillReader;
use super::sweep::SweepSource;
use super::sweep::expand::{self, Base};
use super::{hierarchy, keys};
use crate::toml::document::{KeyValue, Node};
use crate::toml::error::{ConfigError, list, nearest, suggest};
use crate::toml::reader::{Item, TableReader, is_name};

/// Name of the only arm of a config that has no `[arm.NAME]`.
const BASE: &str = "base";
/// What an arm may change.
const ARM_KEYS: [&str; 7] = [EXTENDS, "world", "root", "learning", "skill", "robot", "teacher"];
/// Key of an arm that names the arm over which it is laid.
const EXTENDS: &str = "extends";

/// The arms of a config.
#[derive(Debug)]
pub(super) struct ReadArms {
    /// All arms without the sweep, so that a mistake in one that is not run is found too.
    pub(super) base: Vec<ArmPlan>,
    /// The chosen arms, each at its points of the sweep.
    pub(super) run: Vec<ArmPlan>,
}

/// Reads all arms, and those that are chosen at each point of the sweep. `base` is the complete config without its arms,
/// which are in `own`, and `root` its table.
pub(super) fn read(
    reader: &mut ArmReader<'_>,
    (base, root): (&Node, &TableReader<'_>),
    own: Option<&Node>,
    sweep: Option<&SweepSource<'_>>,
) -> Result<ReadArms, ConfigError> {
    let chosen = root.optional(keys::ARMS);
    // Read below, merged with each arm.
    for key in ARM_KEYS.into_iter().filter(|key| *key != EXTENDS) {
        root.optional(key);
    }
    if let Some(named) = root.optional(keys::ROOT) {
        // It may be in force in no arm.
        named.choice("skills", &base.names("skill"))?;
    }
    let trees = match own {
        Some(own) => trees(base, own)?,
        None => vec![(BASE.to_owned(), base.clone())],
    };
    let mut arms = Vec::new();
    for (name, tree) in &trees {
        arms.push(reader.read((name, 0), tree)?);
    }
    // What is in nobody's tree is held against the first arm's world.
    let (first, tree) = (&arms[0], &trees[0].1);
    let table = skills(tree)?;
    let untrained = reader.skills(tree, first.teacher.lessons, first.skills[0].params);
    let untrained = SkillReader { cached: Some(reader.worlds.cached(first.world)), ..untrained };
    let trained = |name: &str| arms.iter().any(|arm| arm.skills.iter().any(|skill| skill.name == name));
    for link in hierarchy::links(&table)?.iter().filter(|link| !trained(link.name) && link.mirror.is_none()) {
        untrained.skill(link)?;
    }
    let names: Vec<&str> = arms.iter().map(|arm| arm.name.as_str()).collect();
    let wanted = select(&names, chosen.as_ref())?;
    let run = match sweep {
        None => wanted.iter().map(|arm| arms[*arm].clone()).collect(),
        Some(sweep) => {
            let each = arms.iter().zip(&trees).enumerate();
            let bases = each.map(|(n, (arm, (_, tree)))| Base { arm, tree: tree.clone(), run: wanted.contains(&n) });
            expand::at_points(reader, bases.collect(), sweep)?
        }
    };
    Ok(ReadArms { base: arms, run })
}

/// The name and the complete config of each arm.
fn trees(base: &Node, own: &Node) -> Result<Vec<(String, Node)>, ConfigError> {
    let arms = (Item { name: "arm".to_owned(), node: own }).table()?.all();
    if arms.is_empty() {
        let hint = "add [arm.NAME], or remove [arm] to run the config as it stands";
        return Err(own.origin.error("there are no arms", hint));
    }
    let names = base.names("skill");
    let mut trees = Vec::new();
    for (entry, item) in &arms {
        small_name(entry, "an arm")?;
        check(item, &names)?;
        let mut tree = base.clone();
        for layer in layers(&arms, item)? {
            tree.merge(layer.clone());
        }
        tree.remove(EXTENDS);
        trees.push((entry.key.clone(), tree));
    }
    Ok(trees)
}

/// An arm's table, and before it those of the arms that it extends.
fn layers<'a>(arms: &[(&KeyValue, Item<'a>)], arm: &Item<'a>) -> Result<Vec<&'a Node>, ConfigError> {
    let names: Vec<&str> = arms.iter().map(|(entry, _)| entry.key.as_str()).collect();
    let mut layers = vec![arm.node];
    while let Some(extended) = layers[0].get(EXTENDS) {
        let item = Item { name: format!("{}.{EXTENDS}", arm.name), node: extended };
        let at = item.choice("arms", &names)?;
        if layers.len() > names.len() {
            return Err(item.error("the arms extend one another in a circle", "let one of them stand by itself"));
        }
        layers.insert(0, arms[at].1.node);
    }
    Ok(layers)
}

/// An arm changes skills and robots that are there; everything else is common to all arms.
fn check(arm: &Item<'_>, skills: &[&str]) -> Result<(), ConfigError> {
    for (entry, part) in arm.table()?.all() {
        if !ARM_KEYS.contains(&entry.key.as_str()) {
            let common = keys::is_group(&entry.key);
            let message = if common {
                format!("`{}` is the same for all arms", entry.key)
            } else {
                format!("unknown key `{}`", part.name)
            };
            let hint = match nearest(&entry.key, &ARM_KEYS) {
                Some(best) if !common => format!("did you mean `{best}`?"),
                _ => format!("an arm may change {}", list(&ARM_KEYS)),
            };
            return Err(entry.origin.error(message, hint));
        }
        if entry.key == "skill" {
            for (skill, _) in part.table()?.all() {
                if !skills.contains(&skill.key.as_str()) {
                    let hint = suggest(&skill.key, "skills", skills);
                    return Err(skill.origin.error(format!("there is no skill `{}` to change", skill.key), hint));
                }
            }
        }
    }
    Ok(())
}

/// Refuses names of arms and transfers that could not stand in files and on the command line.
pub(super) fn small_name(entry: &KeyValue, what: &str) -> Result<(), ConfigError> {
    let name = &entry.key;
    if is_name(name) && !name.contains(|c: char| c == '_' || c.is_ascii_uppercase()) {
        return Ok(());
    }
    let hint = "use small letters, digits and `-`: the name appears in files and on the command line";
    Err(entry.origin.error(format!("`{name}` cannot be the name of {what}"), hint))
}

/// Indices of the chosen arms, in the order of the file; all if none is.
fn select(names: &[&str], chosen: Option<&Item<'_>>) -> Result<Vec<usize>, ConfigError> {
    let Some(chosen) = chosen else { return Ok((0..names.len()).collect()) };
    let hint = format!("choose among {}, or leave `arms` out", list(names));
    chosen.chosen("arm", &hint, |item| item.choice("arms", names).map(|at| (at, format!("`{}`", names[at]))))
}
