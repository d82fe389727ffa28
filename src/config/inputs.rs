//! What a skill's nets see.

use super::keys;
use super::plan::{Input, Skill};
use crate::layout::{MAX_GROUPS, MAX_INPUTS};
use crate::toml::error::ConfigError;
use crate::toml::reader::{Item, argument};
use crate::world::World;
use std::mem::discriminant;

const ALL: [(&str, Input); 15] = [
    ("sonar", Input::Sonar { scale: keys::SONAR_DEFAULT }),
    ("sonar-far", Input::SonarFar),
    ("sonar-compass", Input::SonarCompass { scale: keys::SONAR_DEFAULT }),
    ("light", Input::Light),
    ("lit", Input::Lit),
    ("bumpers", Input::Bumpers),
    ("compass", Input::Compass),
    ("compass2", Input::Compass2),
    ("values", Input::Values),
    ("applicable", Input::Applicable),
    ("running", Input::Running),
    ("light-trace", Input::LightTrace),
    ("door-trace", Input::DoorTrace),
    ("range-means", Input::RangeMeans),
    ("room", Input::Room),
];

/// The name used in configs, without a scale.
pub(super) fn name(input: Input) -> &'static str {
    ALL.iter().find(|(_, known)| discriminant(known) == discriminant(&input)).map_or("", |(name, _)| name)
}

/// Reads the inputs, all of which there must be something to sense for in the world, if one is given.
pub(super) fn read(item: &Item<'_>, world: Option<&World>) -> Result<Vec<Input>, ConfigError> {
    item.distinct(MAX_GROUPS, |one| {
        let input = input(one)?;
        let lacking = world.and_then(|world| match input {
            Input::Light | Input::Lit | Input::LightTrace if world.light.is_none() => {
                Some((world, "light to see", "[light]"))
            }
            Input::DoorTrace if world.doors.is_empty() => Some((world, "doors to pass", "[[doors]]")),
            _ => None,
        });
        let Some((world, what, key)) = lacking else { return Ok(input) };
        let hint = format!("add {key} to the world file, or drop this input");
        Err(one.error(format!("the world `{}` has no {what}", world.name), hint))
    })
}

fn input(item: &Item<'_>) -> Result<Input, ConfigError> {
    let text = item.text()?;
    let scaled = |name| argument(text, name).map(|scale| (name, scale));
    let Some((name, scale)) = scaled("sonar").or_else(|| scaled("sonar-compass")) else {
        return Ok(ALL[item.choice("inputs", &ALL.map(|(name, _)| name))?].1);
    };
    match scale.parse::<f64>() {
        Ok(scale) if !keys::SONAR_SCALE.holds(scale) => Err(()),
        Ok(scale) if name == "sonar" => Ok(Input::Sonar { scale: scale as f32 }),
        Ok(scale) => Ok(Input::SonarCompass { scale: scale as f32 }),
        Err(_) => Err(()),
    }
    .map_err(|()| {
        let hint = format!("use a number of inches {}, such as {name}(60)", keys::SONAR_SCALE);
        item.error(format!("`{scale}` cannot be the scale of the sonar"), hint)
    })
}

/// Refuses inputs that have nothing to show in this skill, and too many of them for a world of so many rooms.
pub(super) fn check(item: &Item<'_>, skill: &Skill, rooms: usize) -> Result<(), ConfigError> {
    for (input, one) in skill.inputs.iter().zip(item.items()?) {
        let (lacking, hint) = match input {
            Input::Values | Input::Applicable if skill.thresholds() == 0 => {
                ("no child has a threshold", "give skills among the children one, as in applicable = { dock = 0.25 }")
            }
            Input::Running if skill.children.len() < 2 => ("there is one child only", "add children"),
            _ => continue,
        };
        let message = format!("the input `{}` of `{}` has nothing to show: {lacking}", name(*input), skill.name);
        return Err(one.error(message, format!("{hint}, or drop this input")));
    }
    let width = skill.width(rooms);
    if width as usize > MAX_INPUTS {
        let message = format!("the inputs have {width} values, more than {MAX_INPUTS}");
        let hint = "sonar, sonar-far, sonar-compass and light take 24 each; bumpers 4; door-trace 3; compass, compass2 \
                    and range-means 2; lit and light-trace 1; values and applicable 1 per threshold; running 1 per \
                    child; room 1 per room";
        return Err(item.error(message, hint));
    }
    Ok(())
}
