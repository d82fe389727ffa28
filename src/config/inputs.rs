//! What a skill's nets see.

use super::keys;
use super::plan::{Input, SkillPlan};
use crate::layout::{MAX_GROUPS, MAX_INPUTS};
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, argument};
use crate::world::World;

/// Reads the inputs, all of which there must be something to sense for in the world, if one is given.
pub(super) fn read(item: &Item<'_>, world: Option<&World>) -> Result<Vec<Input>, ConfigError> {
    item.distinct(MAX_GROUPS, |one| {
        let input = input(one)?;
        let Some((world, part)) = world.and_then(|world| Some((world, world.lacks(input.needs())?))) else {
            return Ok(input);
        };
        let hint = format!("add {} to the world file, or drop this input", part.key());
        Err(one.error(
            format!("`{}` has nothing to show: the world `{}` has no {}", input.name(), world.name, part.name()),
            hint,
        ))
    })
}

/// An input by its name, with the scale in brackets if it has one.
fn input(item: &Item<'_>) -> Result<Input, ConfigError> {
    let text = item.text()?;
    let scaled = |input: &Input| argument(text, input.name()).map(|scale| (*input, scale));
    let Some((input, scale)) = Input::ALL.iter().filter(|input| input.scale().is_some()).find_map(scaled) else {
        let names: Vec<&str> = Input::ALL.iter().map(|input| input.name()).collect();
        return Ok(Input::ALL[item.choice("inputs", &names)?]);
    };
    let value = scale.parse().ok().filter(|scale| keys::SONAR_SCALE.holds(*scale));
    value.and_then(|scale| input.with_scale(scale as f32)).ok_or_else(|| {
        let hint = format!("use a number of inches {}, such as {}(60)", keys::SONAR_SCALE, input.name());
        item.error(format!("`{scale}` cannot be the scale of the sonar"), hint)
    })
}

/// Refuses inputs that have nothing to show in this skill, and too many of them for a world of so many rooms.
pub(super) fn check(item: &Item<'_>, skill: &SkillPlan, rooms: usize) -> Result<(), ConfigError> {
    for (input, one) in skill.inputs.iter().zip(item.items()?) {
        let (lacking, hint) = match input {
            Input::Values | Input::Applicable if skill.thresholds() == 0 => {
                ("no child has a threshold", "give skills among the children one, as in applicable = { dock = 0.25 }")
            }
            Input::Running if skill.children.len() < 2 => ("there is one child only", "add children"),
            _ => continue,
        };
        let message = format!("the input `{}` of `{}` has nothing to show: {lacking}", input.name(), skill.name);
        return Err(one.error(message, format!("{hint}, or drop this input")));
    }
    let width = skill.width(rooms);
    if width as usize > MAX_INPUTS {
        let message = format!("the inputs have {width} values, more than {MAX_INPUTS}");
        let widths: Vec<String> =
            Input::ALL.iter().map(|input| format!("{} {}", input.name(), input.width_in_words())).collect();
        let hint = format!("they take: {}", widths.join(", "));
        return Err(item.error(message, hint));
    }
    Ok(())
}
