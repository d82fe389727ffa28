//! What a skill chooses among, and how.

use super::keys;
use super::plan::{Action, Child, SkillPlan, Threshold};
use crate::layout::MAX_CHILDREN;
use crate::toml::document::Value;
use crate::toml::error::{ConfigError, suggest};
use crate::toml::reader::{Item, TableReader, argument};

/// Reads the children, with where each is written. A skill is numbered by its place in `skills`.
pub(super) fn read<'a>(item: &Item<'a>, skills: &[&str]) -> Result<Vec<(Child, Item<'a>)>, ConfigError> {
    let known: Vec<&str> = Action::ALL.iter().map(|action| action.name()).chain(skills.iter().copied()).collect();
    let children = item.distinct(MAX_CHILDREN, |one| {
        let text = one.text()?;
        match known.iter().position(|name| *name == text) {
            Some(code) if code < Action::ALL.len() => Ok(Child::Action(Action::ALL[code])),
            Some(code) => Ok(Child::Skill(code - Action::ALL.len())),
            None => {
                let hint = suggest(text, "actions and skills", &known);
                Err(one.error(format!("`{text}` is neither an action nor a skill"), hint))
            }
        }
    })?;
    Ok(children.into_iter().zip(item.items()?).collect())
}

/// Reads from what value on each child is applicable.
pub(super) fn applicable(
    item: &Item<'_>,
    children: &[(Child, Item<'_>)],
) -> Result<Vec<Option<Threshold>>, ConfigError> {
    let names = children.iter().map(|(_, child)| child.text()).collect::<Result<Vec<_>, _>>()?;
    let skill = |number: &usize| matches!(children[*number].0, Child::Skill(_));
    let mut thresholds = vec![None; children.len()];
    for (entry, value) in item.table()?.all() {
        match names.iter().position(|name| *name == entry.key) {
            Some(number) if skill(&number) => thresholds[number] = Some(threshold(&value)?),
            Some(_) => {
                let message = format!("`{}` has no threshold: actions always are applicable", entry.key);
                return Err(entry.origin.error(message, "drop it; only skills among the children have one"));
            }
            None => {
                let skills: Vec<&str> = (0..names.len()).filter(skill).map(|number| names[number]).collect();
                let hint = suggest(&entry.key, "skills among the children", &skills);
                return Err(entry.origin.error(format!("`{}` is not among the children", entry.key), hint));
            }
        }
    }
    Ok(thresholds)
}

/// Refuses thresholds that nothing would teach: they are learned of the root's children, from trials that may fail.
pub(super) fn learnable(item: &Item<'_>, root: bool, own: &SkillPlan, skills: &[SkillPlan]) -> Result<(), ConfigError> {
    for (child, threshold) in own.children.iter().zip(&own.applicable) {
        let (Child::Skill(below), Some(Threshold::Learned(_))) = (child, threshold) else { continue };
        let child = &skills[*below];
        let problem = if !root {
            format!("`{}` is not the root", own.name)
        } else if child.mirror.is_some() {
            format!("`{}` is a mirror image", child.name)
        } else if child.oracle {
            format!("`{}` is an oracle", child.name)
        } else if child.params.trials == 0 {
            format!("`{}` has no trials", child.name)
        } else if child.goal == 0 {
            format!("`{}` has no goal", child.name)
        } else {
            continue;
        };
        let written = item.node.get(keys::SKILL_APPLICABLE.name()).and_then(|table| table.get(&child.name));
        let place = Item { name: item.name.clone(), node: written.unwrap_or(item.node) };
        let message = format!("the threshold of `{}` in `{}` cannot be learned: {problem}", child.name, own.name);
        return Err(place.error(message, format!("give it a number {}", keys::THRESHOLD)));
    }
    Ok(())
}

fn threshold(item: &Item<'_>) -> Result<Threshold, ConfigError> {
    let Value::Text(text) = &item.node.value else { return Ok(Threshold::Fixed(item.number(keys::THRESHOLD)?)) };
    if text == "learned" {
        return Ok(Threshold::Learned(keys::PROBABILITY_DEFAULT));
    }
    let Some(probability) = argument(text, "learned") else {
        let hint = format!("use a number {}, \"learned\", or \"learned(0.8)\"", keys::THRESHOLD);
        return Err(item.error(format!("`{text}` is not a threshold"), hint));
    };
    match probability.parse::<f64>() {
        Ok(value) if keys::PROBABILITY.holds(value) => Ok(Threshold::Learned(value as f32)),
        _ => {
            let hint = format!("use a number {}, such as learned(0.8)", keys::PROBABILITY);
            Err(item.error(format!("`{probability}` cannot be the probability of success"), hint))
        }
    }
}

/// Reads whether a skill keeps to the chosen child, in training and in tests.
pub(super) fn persistence(section: &TableReader<'_>) -> Result<(bool, bool), ConfigError> {
    let item = section.value(&keys::SKILL_PERSISTENCE)?;
    match &item.node.value {
        Value::Flag(flag) => Ok((*flag, *flag)),
        Value::Text(text) if text == "training" => Ok((true, false)),
        _ => {
            let message = format!("`{}` must be true, false or \"training\"", item.name);
            Err(item.error(message, "\"training\" keeps to a child in training trials, but not in tests"))
        }
    }
}
