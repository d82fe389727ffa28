//! The keys of one `[skill.NAME]` table.

use super::events::{Complain, EventReader};
use super::hierarchy::Link;
use super::keys;
use super::plan::{Child, SkillPlan, Threshold};
use super::unused_keys::UnusedKeys;
use super::worlds::CachedWorld;
use super::{children, inputs, mirror};
use crate::layout::choices::OPTIMISER_SGD;
use crate::layout::params::{ALWAYS, MAX_TRIALS};
use crate::layout::{HyperParams, MAX_CHILDREN, MAX_STARTS};
use crate::toml::document::{Node, Value};
use crate::toml::error::{ConfigError, suggest};
use crate::toml::reader::{Item, KeyedTable};

/// What the skills of an arm are read with, besides their own tables.
#[derive(Debug)]
pub(super) struct SkillReader<'a> {
    /// What `skill.NAME.learning` lies over.
    pub(super) learning: Option<&'a Node>,
    /// The arm's floor plan. None for skills that the arm does not train: they may belong in another one, so that
    /// regions, events and inputs are not held against it.
    pub(super) cached: Option<CachedWorld<'a>>,
    /// The numbers that the arm's robots have in common.
    pub(super) robot: HyperParams,
    /// Lessons that the teacher demonstrates.
    pub(super) taught: u32,
    /// Trials after which skills are tested that do not name their own.
    pub(super) eval_at: &'a [u32],
    /// The arm's skills, by their places in the file.
    pub(super) order: &'a [usize],
}

impl SkillReader<'_> {
    /// Reads a skill that is no mirror image.
    pub(super) fn skill(&self, link: &Link<'_>, unused: &mut UnusedKeys) -> Result<SkillPlan, ConfigError> {
        let (cached, world) = (self.cached, self.cached.map(|cached| cached.world));
        let section = KeyedTable(link.item.table()?);
        let asked = section.required(&keys::SKILL_INPUTS, "[\"sonar\", \"light\", \"bumpers\"]")?;
        let inputs = inputs::read(&asked, world)?;
        // These two are in the link already.
        section.0.optional(keys::SKILL_CHILDREN.name());
        section.0.optional(keys::SKILL_MIRROR.name());
        let applicable = children::applicable(&section.required(&keys::SKILL_APPLICABLE, "{}")?, &link.children)?;
        let starts = starts(&section.required(&keys::SKILL_STARTS, "\"anywhere\"")?, cached)?;
        let tests = section.required(&keys::SKILL_EVAL_STARTS, "\"anywhere\"")?;
        let eval_starts = region(tests.text()?, &|message, hint| tests.error(message, hint), cached)?;
        let mut events = EventReader::new(world);
        let goal = events.goal(&section.required(&keys::SKILL_GOAL, "[\"docked\"]")?)?;
        let oracle = oracle(&section, link)?;
        let mut params = self.learning(&section, &link.item, unused)?;
        section.fill("skill.*.", HyperParams::rows(), &mut params)?;
        params.reward = events.reward(&section.required(&keys::SKILL_REWARD, "{ docked = 100, collision = -10 }")?)?;
        params.threshold = [ALWAYS; MAX_CHILDREN];
        for (value, own) in params.threshold.iter_mut().zip(&applicable) {
            // A learned one is always exceeded until it is known.
            if let Some(Threshold::Fixed(fixed)) = own {
                *value = *fixed;
            }
        }
        let (training, tests) = children::persistence(&section)?;
        (params.persist_training, params.persist_tests) = (training.into(), tests.into());
        self.check_lessons(params.lessons, &section, link)?;
        if oracle {
            (params.lessons, params.trials) = (0, 0);
        }
        let skill = SkillPlan {
            name: link.name.to_owned(),
            inputs,
            children: link.children.iter().map(|(child, _)| self.child(*child)).collect(),
            applicable,
            mirror: None,
            oracle,
            starts,
            eval_starts,
            eval_at: self.eval_at(&section)?.unwrap_or_else(|| self.eval_at.to_vec()),
            goal,
            regions: events.regions,
            params,
        };
        inputs::check(&asked, &skill, world.map_or(0, |world| world.rooms.len()))?;
        if skill.params.mirror_replays == 1 {
            mirror::check_replays(&skill, &self.mirror_replays(&link.item))?;
        }
        section.0.finish()?;
        Ok(skill)
    }

    /// Checks the table of a mirror image for misspelt keys. They are what the skill is where an arm says
    /// `mirror = false`; until then `eval_at` alone is used, and returned if it is there.
    pub(super) fn unused(&self, link: &Link<'_>, unused: &mut UnusedKeys) -> Result<Option<Vec<u32>>, ConfigError> {
        let section = KeyedTable(link.item.table()?);
        for key in keys::all().filter(|key| key.path.starts_with("skill.*.")) {
            section.0.optional(key.name());
        }
        self.learning(&section, &link.item, unused)?;
        let eval_at = self.eval_at(&section)?;
        section.0.finish()?;
        Ok(eval_at)
    }

    fn eval_at(&self, section: &KeyedTable<'_>) -> Result<Option<Vec<u32>>, ConfigError> {
        section.0.optional(keys::SKILL_EVAL_AT.name()).map(|item| item.ascending(MAX_TRIALS)).transpose()
    }

    /// The place of a skill among the arm's own; below a skill that the arm does not train it has none, and stays.
    pub(super) fn place(&self, number: usize) -> usize {
        self.order.iter().position(|skill| *skill == number).unwrap_or(number)
    }

    fn child(&self, child: Child) -> Child {
        match child {
            Child::Skill(number) => Child::Skill(self.place(number)),
            action => action,
        }
    }

    fn check_lessons(&self, lessons: u32, section: &KeyedTable<'_>, link: &Link<'_>) -> Result<(), ConfigError> {
        let item = section.0.required("lessons", "10")?;
        if lessons > 0 && link.skills().next().is_some() {
            let message = format!("`{}` cannot have lessons: nobody demonstrates skills", link.name);
            return Err(item.error(message, "set lessons = 0; the skills that it chooses among can be taught"));
        }
        if lessons > self.taught {
            let hint = format!("the teacher demonstrates {}; raise `teacher.lessons`", self.taught);
            return Err(item.error(format!("`{}` is {lessons}, more than there are", item.name), hint));
        }
        Ok(())
    }

    /// The numbers of learning, with those of the robot; all others are 0.
    fn learning(
        &self,
        section: &KeyedTable<'_>,
        skill: &Item<'_>,
        unused: &mut UnusedKeys,
    ) -> Result<HyperParams, ConfigError> {
        let mut merged = self.learning.cloned().unwrap_or_else(|| Node::empty(skill.origin().clone()));
        let over = section.0.optional("learning");
        if let Some(over) = &over {
            over.table()?;
            merged.merge(over.node.clone());
        }
        let name = over.map_or_else(|| "learning".to_owned(), |over| over.name);
        let section = KeyedTable(Item { name, node: &merged }.table()?);
        let mut params = self.robot;
        section.fill("learning.", HyperParams::rows(), &mut params)?;
        unused.note(&section, params.optimiser)?;
        let unset = section.0.optional("learning_rate").is_none_or(|item| item.origin().is_default());
        if params.optimiser == OPTIMISER_SGD && unset {
            let chosen = section.0.required("optimiser", "\"sgd\"")?;
            return Err(chosen.error("sgd has no default learning rate", "add `learning_rate = 0.15` beside it"));
        }
        section.0.finish()?;
        params.derive();
        Ok(params)
    }
}

/// Where replays in a mirror are asked for: in the skill's own table, or in the one below it.
impl<'a> SkillReader<'a> {
    fn mirror_replays(&self, skill: &Item<'a>) -> Item<'a> {
        let key = "mirror_replays";
        let own = skill.node.get("learning").and_then(|learning| learning.get(key));
        let node = own.or_else(|| self.learning.and_then(|learning| learning.get(key))).unwrap_or(skill.node);
        Item { name: "learning.mirror_replays".to_owned(), node }
    }
}

fn oracle(section: &KeyedTable<'_>, link: &Link<'_>) -> Result<bool, ConfigError> {
    let item = section.required(&keys::SKILL_ORACLE, "false")?;
    let oracle = item.flag()?;
    if oracle && link.skills().next().is_some() {
        let message = format!("`{}` chooses among skills and cannot be an oracle", link.name);
        return Err(
            item.error(message, "the planner knows actions only; let the skills that it chooses among be oracles")
        );
    }
    Ok(oracle)
}

/// The name of a region in which a trial can start.
fn region(name: &str, place: &Complain<'_>, cached: Option<CachedWorld<'_>>) -> Result<String, ConfigError> {
    let Some(cached) = cached else { return Ok(name.to_owned()) };
    let world = cached.world;
    let names = world.region_names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    match cached.region_is_empty(name) {
        None => {
            let message = format!("the world `{}` has no region `{name}`", world.name);
            Err(place(message, suggest(name, "regions", &names)))
        }
        Some(true) => {
            let hint = "no part of it is 14 inches from everything solid; enlarge it or choose another one";
            Err(place(format!("the robot fits nowhere in the region `{name}`"), hint.to_owned()))
        }
        Some(false) => Ok(name.to_owned()),
    }
}

/// At least one region with its share.
fn starts(item: &Item<'_>, cached: Option<CachedWorld<'_>>) -> Result<Vec<(String, f32)>, ConfigError> {
    if let Value::Text(name) = &item.node.value {
        return Ok(vec![(region(name, &|message, hint| item.error(message, hint), cached)?, 1.0)]);
    }
    if !matches!(item.node.value, Value::Table(_)) {
        let message = format!("`{}` must be a region or a table of shares, not {}", item.name, item.node.kind());
        return Err(item.error(message, "write \"light-area\" or { light-area = 0.8, anywhere = 0.2 }"));
    }
    let mut starts = Vec::new();
    let mut sum = 0.0;
    for (entry, share) in item.table()?.all() {
        let name = region(&entry.key, &|message, hint| entry.origin.error(message, hint), cached)?;
        sum += share.double(keys::START_SHARE)?;
        starts.push((name, share.number(keys::START_SHARE)?));
    }
    if starts.len() > MAX_STARTS {
        return Err(
            item.error(format!("`{}` has {} regions", item.name, starts.len()), format!("at most {MAX_STARTS} fit"))
        );
    }
    if (sum - 1.0).abs() > 1e-6 {
        let hint = "the shares must sum to 1, such as { light-area = 0.8, anywhere = 0.2 }";
        return Err(item.error(format!("the shares of `{}` sum to {}", item.name, (sum * 1e6).round() / 1e6), hint));
    }
    Ok(starts)
}
