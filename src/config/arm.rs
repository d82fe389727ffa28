//! One arm, read from its complete config.

use super::hierarchy::{self, Link};
use super::plan::{ArmPlan, SkillPlan, TeacherPlan};
use super::skill::SkillReader;
use super::unused_keys::UnusedKeys;
use super::worlds::Worlds;
use super::{children, keys, mirror, robot};
use crate::layout::HyperParams;
use crate::toml::document::Node;
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, TableReader};

/// Reads arms, and keeps what they have in common.
#[derive(Debug)]
pub(super) struct ArmReader<'a> {
    /// Trials after which skills are tested that do not name their own.
    pub(super) eval_at: &'a [u32],
    pub(super) worlds: Worlds<'a>,
    pub(super) unused: UnusedKeys,
}

impl ArmReader<'_> {
    /// Reads skills that are not trained; those that are also need a world and an order.
    pub(super) fn skills<'b>(&'b self, tree: &'b Node, taught: u32, robot: HyperParams) -> SkillReader<'b> {
        let (learning, unused) = (tree.get("learning"), &self.unused);
        SkillReader { learning, robot, cached: None, taught, eval_at: self.eval_at, order: &[], unused }
    }

    /// Reads an arm at a point from its complete config.
    pub(super) fn read(&mut self, (name, point): (&str, u32), tree: &Node) -> Result<ArmPlan, ConfigError> {
        let root = Item::root(tree).table()?;
        let world = self.worlds.place(&root.required(keys::WORLD, "\"worlds/office.toml\"")?)?;
        let teacher = teacher(&root.required("teacher", "{}")?)?;
        let robot = robot::read(&root.required("robot", "{}")?)?;
        let table = skills(tree)?;
        let links = hierarchy::links(&table)?;
        let top = hierarchy::root(root.optional(keys::ROOT).as_ref(), &links)?;
        let order = hierarchy::order(&links, top)?;
        let untrained = self.skills(tree, teacher.lessons, robot);
        let reader = SkillReader { cached: Some(self.worlds.cached(world)), order: &order, ..untrained };
        let mut skills: Vec<SkillPlan> = Vec::new();
        for &number in &order {
            let skill = trained(&links[number], &reader, &skills)?;
            children::learnable(&links[number].item, number == top, &skill, &skills)?;
            skills.push(skill);
        }
        for (_, link) in links.iter().enumerate().filter(|(number, _)| !order.contains(number)) {
            match link.mirror {
                None => drop(untrained.skill(link)?),
                Some(_) => drop(untrained.unused(link)?),
            }
        }
        Ok(ArmPlan { name: name.to_owned(), point, world, skills, noise: robot.noise, teacher })
    }
}

/// Reads a skill of an arm's tree; `earlier` ones are those that stand before it.
fn trained(link: &Link<'_>, reader: &SkillReader<'_>, earlier: &[SkillPlan]) -> Result<SkillPlan, ConfigError> {
    let Some((source, item)) = &link.mirror else { return reader.skill(link) };
    let own = reader.unused(link)?;
    let number = reader.place(*source);
    let image = mirror::image(link.name, (number, &earlier[number]), item)?;
    Ok(SkillPlan { eval_at: own.unwrap_or_else(|| image.eval_at.clone()), ..image })
}

fn teacher(item: &Item<'_>) -> Result<TeacherPlan, ConfigError> {
    let table = item.table()?;
    let teacher = TeacherPlan {
        lessons: table.word(&keys::TEACHER_LESSONS)?,
        discount: table.number(&keys::TEACHER_DISCOUNT)?,
        backward_cost: table.number(&keys::TEACHER_BACKWARD_COST)?,
        collision_cost: table.number(&keys::TEACHER_COLLISION_COST)?,
        eval_episodes: table.word(&keys::TEACHER_EVAL_EPISODES)?,
    };
    table.finish()?;
    Ok(teacher)
}

/// The table of all skills.
pub(super) fn skills(tree: &Node) -> Result<TableReader<'_>, ConfigError> {
    let hint = "add [skill.dock] with inputs, reward, starts, goal and the number of trials";
    let none = || tree.origin.error("the config has no skill", hint);
    let table = Item::root(tree).table()?.optional("skill").ok_or_else(none)?.table()?;
    if table.all().is_empty() { Err(none()) } else { Ok(table) }
}
