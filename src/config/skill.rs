//! The keys of one `[skill.NAME]` table.

use super::error::{ConfigError, list, suggest};
use super::keys;
use super::learning::{self, Idle};
use super::plan::{Action, Event, Input, Skill};
use super::read::{Item, Section};
use super::tree::{Node, Value};
use crate::learner::layout::{MAX_CHILDREN, MAX_GROUPS, MAX_INPUTS, MAX_STARTS};
use crate::world::World;

/// Reads a skill from its complete table; `learning` holds what it does not override, `bank` the lessons there are.
pub(super) fn read(
    (name, item): (&str, &Item<'_>),
    learning: Option<&Node>,
    (world, bank): (&World, u32),
    idle: &mut Idle,
) -> Result<Skill, ConfigError> {
    let section = Section(item.table()?);
    let inputs = inputs(&section.required(&keys::SKILL_INPUTS, "[\"sonar\", \"light\", \"bumpers\"]")?, world)?;
    let children = children(&section.required(&keys::SKILL_CHILDREN, "[\"turn+15\", \"move+12\"]")?, name)?;
    let reward = reward(&section.required(&keys::SKILL_REWARD, "{ docked = 100, collision = -10 }")?, world)?;
    let starts = starts(&section.required(&keys::SKILL_STARTS, "\"anywhere\"")?, world)?;
    let tests = section.required(&keys::SKILL_TESTS, "\"anywhere\"")?;
    let tests = region(tests.text()?, &|message, hint| tests.error(message, hint), world)?;
    let ends = ends(&section.required(&keys::SKILL_ENDS, "[\"docked\"]")?, world)?;

    let mut merged = learning.cloned().unwrap_or_else(|| Node::empty(item.origin().clone()));
    let over = section.0.optional("learning");
    if let Some(over) = &over {
        over.table()?;
        merged.merge(over.node.clone());
    }
    let lessons = section.whole(&keys::SKILL_LESSONS)?;
    if lessons > bank {
        let item = section.required(&keys::SKILL_LESSONS, "10")?;
        let hint = format!("the teacher's bank has {bank}; raise `teacher.bank`");
        return Err(item.error(format!("`{}` is {lessons}, more than there are", item.name), hint));
    }
    let place = over.map_or_else(|| "learning".to_owned(), |over| over.name);
    let learning = learning::read(&Item { name: place, node: &merged }, idle)?;
    let skill = Skill {
        name: name.to_owned(),
        inputs,
        children,
        reward,
        starts,
        tests,
        ends,
        max_steps: section.whole(&keys::SKILL_MAX_STEPS)?,
        lessons,
        trials: section.whole(&keys::SKILL_TRIALS)?,
        learning,
    };
    section.0.finish()?;
    Ok(skill)
}

/// Makes a complaint, from its message and hint, about the place of a name.
type Place<'a> = dyn Fn(String, String) -> ConfigError + 'a;

/// A list that is not empty, not too long, and in which nothing is twice.
fn distinct<'a, T: PartialEq>(
    item: &Item<'a>,
    most: usize,
    read: impl Fn(&Item<'a>) -> Result<T, ConfigError>,
) -> Result<Vec<T>, ConfigError> {
    let mut out = Vec::new();
    for one in item.items()? {
        let value = read(&one)?;
        if out.contains(&value) {
            return Err(one.error(format!("`{}` is there twice", one.text()?), "name each once"));
        }
        out.push(value);
    }
    if out.is_empty() {
        return Err(item.error(format!("`{}` is empty", item.name), "name at least one"));
    }
    if out.len() > most {
        return Err(item.error(format!("`{}` has {} entries", item.name, out.len()), format!("at most {most} fit")));
    }
    Ok(out)
}

fn inputs(item: &Item<'_>, world: &World) -> Result<Vec<Input>, ConfigError> {
    let inputs = distinct(item, MAX_GROUPS, |one| input(one, world))?;
    let width: u32 = inputs.iter().map(|input| input.width()).sum();
    if width as usize > MAX_INPUTS {
        let message = format!("the inputs have {width} values, more than {MAX_INPUTS}");
        return Err(item.error(message, "sonar, sonar-far and light take 24 each, bumpers 4, compass 2"));
    }
    Ok(inputs)
}

fn input(item: &Item<'_>, world: &World) -> Result<Input, ConfigError> {
    const NAMES: [&str; 5] = ["sonar", "sonar-far", "light", "bumpers", "compass"];
    let text = item.text()?;
    if let Some(scale) = text.strip_prefix("sonar(").and_then(|rest| rest.strip_suffix(')')) {
        return match scale.trim().parse::<f64>() {
            Ok(scale) if keys::SONAR_SCALE.holds(scale) => Ok(Input::Sonar { scale: scale as f32 }),
            _ => {
                let hint = format!("use a number of inches {}, such as sonar(60)", keys::SONAR_SCALE);
                Err(item.error(format!("`{scale}` cannot be the scale of the sonar"), hint))
            }
        };
    }
    match item.choice("inputs", &NAMES)? {
        0 => Ok(Input::Sonar { scale: keys::SONAR_DEFAULT }),
        1 => Ok(Input::SonarFar),
        2 if world.light.is_none() => {
            Err(item.error("the world has no light to see", "add [light] to the world file, or drop this input"))
        }
        2 => Ok(Input::Light),
        3 => Ok(Input::Bumpers),
        _ => Ok(Input::Compass),
    }
}

fn children(item: &Item<'_>, skill: &str) -> Result<Vec<Action>, ConfigError> {
    let names = Action::ALL.map(Action::name);
    distinct(item, MAX_CHILDREN, |one| {
        let text = one.text()?;
        match names.iter().position(|name| *name == text) {
            Some(code) => Ok(Action::ALL[code]),
            None => {
                let hint = match super::error::nearest(text, &names) {
                    Some(best) => format!("did you mean `{best}`?"),
                    None => format!("allowed are {}; skills as children come with a later version", list(&names)),
                };
                Err(one.error(format!("`{text}` is not an action that `{skill}` can choose"), hint))
            }
        }
    })
}

/// An event that can happen in this world.
fn event(name: &str, place: &Place<'_>, world: &World) -> Result<Event, ConfigError> {
    let names = Event::ALL.map(Event::name);
    let Some(code) = names.iter().position(|known| *known == name) else {
        return Err(place(format!("`{name}` is not one of the events"), suggest(name, "events", &names)));
    };
    let lacking = match Event::ALL[code] {
        Event::Docked if world.charger.is_none() => "charger",
        Event::PassedDoor if world.doors.is_empty() => "doors",
        event => return Ok(event),
    };
    let message = format!("`{name}` cannot happen: the world has no {lacking}");
    Err(place(message, format!("add {lacking} to the world file, or drop this event")))
}

fn reward(item: &Item<'_>, world: &World) -> Result<[f32; Event::ALL.len()], ConfigError> {
    let mut reward = [0.0; Event::ALL.len()];
    for (entry, amount) in item.table()?.all() {
        let event = event(&entry.key, &|message, hint| entry.origin.error(message, hint), world)?;
        reward[event as usize] = amount.number(keys::AMOUNT)?;
    }
    if reward == [0.0; Event::ALL.len()] {
        let message = format!("`{}` pays for nothing, so there is nothing to learn", item.name);
        return Err(item.error(message, "write { docked = 100, collision = -10 }, or other events and amounts"));
    }
    Ok(reward)
}

fn ends(item: &Item<'_>, world: &World) -> Result<u32, ConfigError> {
    // A skill may go on until its step limit.
    if item.items()?.is_empty() {
        return Ok(0);
    }
    let events =
        distinct(item, Event::ALL.len(), |one| event(one.text()?, &|message, hint| one.error(message, hint), world))?;
    Ok(events.iter().fold(0, |bits, event| bits | event.bit()))
}

/// The name of a region in which a trial can start.
fn region(name: &str, place: &Place<'_>, world: &World) -> Result<String, ConfigError> {
    let names = world.region_names();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    match world.region_is_empty(name) {
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
fn starts(item: &Item<'_>, world: &World) -> Result<Vec<(String, f32)>, ConfigError> {
    if let Value::Text(name) = &item.node.value {
        return Ok(vec![(region(name, &|message, hint| item.error(message, hint), world)?, 1.0)]);
    }
    if !matches!(item.node.value, Value::Table(_)) {
        let message = format!("`{}` must be a region or a table of shares, not {}", item.name, item.node.kind());
        return Err(item.error(message, "write \"light-area\" or { light-area = 0.8, anywhere = 0.2 }"));
    }
    let mut starts = Vec::new();
    let mut sum = 0.0;
    for (entry, share) in item.table()?.all() {
        let name = region(&entry.key, &|message, hint| entry.origin.error(message, hint), world)?;
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
