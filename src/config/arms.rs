//! The experimental conditions: the base config with each arm's own table laid over it.

use super::error::{ConfigError, list, nearest, suggest};
use super::learning::Idle;
use super::plan::{Arm, Noise, NoiseKind};
use super::read::{Item, Section, Table, is_name};
use super::tree::Node;
use super::{keys, set, skill};
use crate::learner::layout::MAX_SKILLS;
use crate::world::World;

/// Name of the only arm of a config that has no `[arm.NAME]`.
const BASE: &str = "base";
/// What an arm may change.
const ARM_KEYS: [&str; 3] = ["learning", "skill", "robot"];

/// What the arms of a config are read from.
pub(super) struct Arms<'a> {
    /// The complete config without its arms.
    pub(super) base: &'a Node,
    /// The tables of the arms, if there are any.
    pub(super) own: Option<&'a Node>,
    pub(super) world: &'a World,
    /// Lessons in the teacher's bank.
    pub(super) bank: u32,
}

impl Arms<'_> {
    /// Reads all arms, so that a mistake in one that is not run is found too; returns those that are run.
    pub(super) fn read(&self, root: &Table<'_>) -> Result<Vec<Arm>, ConfigError> {
        let chosen = root.optional(keys::ARMS.name());
        // Read below, merged with each arm.
        for key in ARM_KEYS {
            root.optional(key);
        }
        let mut idle = Idle::default();
        let mut arms = Vec::new();
        match self.own {
            None => arms.push(self.arm(BASE, self.base, &mut idle)?),
            Some(own) => {
                for (entry, item) in (Item { name: "arm".to_owned(), node: own }).table()?.all() {
                    let name = &entry.key;
                    if !is_name(name) || name.contains(|c: char| c == '_' || c.is_ascii_uppercase()) {
                        let hint =
                            "use small letters, digits and `-`: the name appears in files and on the command line";
                        return Err(entry.origin.error(format!("`{name}` cannot be the name of an arm"), hint));
                    }
                    self.check(&item)?;
                    let mut tree = self.base.clone();
                    tree.merge(item.node.clone());
                    arms.push(self.arm(name, &tree, &mut idle)?);
                }
            }
        }
        if arms.is_empty() {
            let hint = "add [arm.NAME], or remove [arm] to run the config as it stands";
            return Err(self.own.unwrap_or(self.base).origin.error("there are no arms", hint));
        }
        idle.finish()?;
        match chosen {
            Some(chosen) => select(arms, &chosen),
            None => Ok(arms),
        }
    }

    /// An arm changes skills and robots that are there; everything else is common to all arms.
    fn check(&self, item: &Item<'_>) -> Result<(), ConfigError> {
        for (entry, part) in item.table()?.all() {
            if !ARM_KEYS.contains(&entry.key.as_str()) {
                let common = self.base.get(&entry.key).is_some();
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
            let skills = set::names(self.base, "skill");
            if entry.key == "skill" {
                for (skill, _) in part.table()?.all() {
                    if !skills.contains(&skill.key.as_str()) {
                        let hint = suggest(&skill.key, "skills", &skills);
                        return Err(skill.origin.error(format!("there is no skill `{}` to change", skill.key), hint));
                    }
                }
            }
        }
        Ok(())
    }

    fn arm(&self, name: &str, tree: &Node, idle: &mut Idle) -> Result<Arm, ConfigError> {
        let root = Item::root(tree).table()?;
        let mut skills = Vec::new();
        let table = root.required("skill", "{ ... }").map_err(|_| no_skill(tree))?.table()?;
        for (entry, item) in table.all() {
            if !is_name(&entry.key) {
                let message = format!("`{}` cannot be the name of a skill", entry.key);
                return Err(entry.origin.error(message, "use letters, digits, `-` and `_` only"));
            }
            skills.push(skill::read((&entry.key, &item), tree.get("learning"), (self.world, self.bank), idle)?);
            if skills.len() > MAX_SKILLS {
                return Err(entry
                    .origin
                    .error("there are too many skills", format!("at most {MAX_SKILLS} are possible")));
            }
        }
        if skills.is_empty() {
            return Err(no_skill(tree));
        }
        let robot = root.required("robot", "{}")?.table()?;
        let noise = noise(Section(robot.required("noise", "{}")?.table()?))?;
        robot.finish()?;
        Ok(Arm { name: name.to_owned(), skills, noise })
    }
}

fn no_skill(tree: &Node) -> ConfigError {
    let hint = "add [skill.dock] with inputs, reward, starts, ends and the number of trials";
    tree.origin.file_error("the config has no skill", hint)
}

fn noise(section: Section<'_>) -> Result<Noise, ConfigError> {
    let kind = if section.choice(&keys::NOISE_KIND)? == 0 { NoiseKind::Gaussian } else { NoiseKind::Uniform };
    let noise = Noise {
        kind,
        actuator: section.number(&keys::NOISE_ACTUATOR)?,
        sonar: section.number(&keys::NOISE_SONAR)?,
        light: section.number(&keys::NOISE_LIGHT)?,
        compass: section.number(&keys::NOISE_COMPASS)?,
    };
    section.0.finish()?;
    Ok(noise)
}

/// The chosen arms, in the order of the file.
fn select(arms: Vec<Arm>, chosen: &Item<'_>) -> Result<Vec<Arm>, ConfigError> {
    let names: Vec<&str> = arms.iter().map(|arm| arm.name.as_str()).collect();
    let mut wanted = vec![false; arms.len()];
    for item in chosen.items()? {
        let at = item.choice("arms", &names)?;
        if wanted[at] {
            return Err(item.error(format!("the arm `{}` is there twice", names[at]), "name each once"));
        }
        wanted[at] = true;
    }
    if !wanted.contains(&true) {
        return Err(chosen.error("no arm is chosen", format!("choose among {}, or leave `arms` out", list(&names))));
    }
    Ok(arms.into_iter().zip(wanted).filter(|(_, wanted)| *wanted).map(|(arm, _)| arm).collect())
}
