//! One arm, read from its complete config.

use super::hierarchy::{self, Link};
use super::plan::{ArmPlan, SkillPlan};
use super::skill::SkillReader;
use super::unused_keys::UnusedKeys;
use super::worlds::Worlds;
use super::{children, keys, mirror, robot, teacher};
use crate::layout::HyperParams;
use crate::toml::document::Node;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, TableReader};

/// Reads arms.
#[derive(Debug, Clone, Copy)]
pub(super) struct ArmReader<'a> {
    /// Trials after which skills are tested that do not name their own.
    pub(super) eval_at: &'a [u32],
}

impl ArmReader<'_> {
    /// Reads skills that are not trained; those that are also need a world and an order.
    pub(super) fn reader<'b>(&'b self, tree: &'b Node, taught: u32, robot: HyperParams) -> SkillReader<'b> {
        let learning = tree.get("learning");
        SkillReader { learning, robot, cached: None, taught, eval_at: self.eval_at, order: &[] }
    }

    /// Reads an arm at a point from its complete config.
    pub(super) fn read(
        &self,
        (name, point): (&str, u32),
        tree: &Node,
        worlds: &mut Worlds<'_>,
        unused: &mut UnusedKeys,
    ) -> Result<ArmPlan, ConfigError> {
        let root = Item::root(tree).table()?;
        let world = worlds.place(&root.required(keys::WORLD.name(), "\"worlds/office.toml\"")?)?;
        let teacher = teacher::read(&root.required("teacher", "{}")?)?;
        let robot = robot::read(&root.required("robot", "{}")?)?;
        let table = skills(tree)?;
        let links = hierarchy::links(&table)?;
        let top = hierarchy::root(root.optional(keys::ROOT.name()).as_ref(), &links)?;
        let order = hierarchy::order(&links, top)?;
        let reader = SkillReader {
            cached: Some(worlds.cached(world)),
            order: &order,
            ..self.reader(tree, teacher.lessons, robot)
        };
        let mut skills: Vec<SkillPlan> = Vec::new();
        for &number in &order {
            let skill = trained(&links[number], &reader, &skills, unused)?;
            children::learnable(&links[number].item, number == top, &skill, &skills)?;
            skills.push(skill);
        }
        let reader = self.reader(tree, teacher.lessons, robot);
        for (_, link) in links.iter().enumerate().filter(|(number, _)| !order.contains(number)) {
            match link.mirror {
                None => drop(reader.skill(link, unused)?),
                Some(_) => drop(reader.unused(link, unused)?),
            }
        }
        Ok(ArmPlan { name: name.to_owned(), point, world, skills, noise: robot.noise, teacher })
    }
}

/// Reads a skill of an arm's tree; `earlier` ones are those that stand before it.
fn trained(
    link: &Link<'_>,
    reader: &SkillReader<'_>,
    earlier: &[SkillPlan],
    unused: &mut UnusedKeys,
) -> Result<SkillPlan, ConfigError> {
    let Some((source, item)) = &link.mirror else { return reader.skill(link, unused) };
    let own = reader.unused(link, unused)?;
    let number = reader.place(*source);
    let image = mirror::image(link.name, (number, &earlier[number]), item)?;
    Ok(match own {
        Some(eval_at) => SkillPlan { eval_at, ..image },
        None => image,
    })
}

/// The table of all skills.
pub(super) fn skills(tree: &Node) -> Result<TableReader<'_>, ConfigError> {
    let hint = "add [skill.dock] with inputs, reward, starts, goal and the number of trials";
    let none = || tree.origin.file_error("the config has no skill", hint);
    let table = Item::root(tree).table()?.optional("skill").ok_or_else(none)?.table()?;
    if table.all().is_empty() { Err(none()) } else { Ok(table) }
}
