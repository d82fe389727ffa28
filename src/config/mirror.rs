//! Skills that are the mirror image of another one and use its nets.

use super::inputs;
use super::plan::{Child, Event, Input, Skill};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;

/// Whether a mirror shows an input as another reading of the same kind.
fn mirrored(input: &Input) -> bool {
    matches!(input, Input::Sonar { .. } | Input::SonarFar | Input::Light | Input::Bumpers)
}

/// Refuses replays seen in a mirror that would not show the same skill; `item` is where they are asked for.
pub(super) fn check_replays(skill: &Skill, item: &Item<'_>) -> Result<(), ConfigError> {
    let problem = if skill.is_high() {
        Some("which chooses among skills".to_owned())
    } else if let Some(input) = skill.inputs.iter().find(|input| !mirrored(input)) {
        Some(format!("whose input `{}` has no mirror image", inputs::name(*input)))
    } else if let Some(Child::Action(turn)) = skill.children.iter().find(|c| !skill.children.contains(&c.mirrored())) {
        Some(format!("which has no turn the other way than `{}`", turn.name()))
    } else {
        let differs = |seen: &Event| {
            let ends = |event: Event| skill.ends & event.bit() != 0;
            skill.reward[*seen as usize] != skill.reward[event(*seen) as usize] || ends(*seen) != ends(event(*seen))
        };
        let side = Event::ALL.into_iter().find(differs);
        side.map(|seen| format!("which sees more in `{}` than in `{}`", seen.name(), event(seen).name()))
    };
    let Some(problem) = problem else { return Ok(()) };
    let message = format!("lessons of `{}`, {problem}, cannot be seen in a mirror", skill.name);
    Err(item.error(message, format!("write skill.{}.learning.mirror_replays = false", skill.name)))
}

/// The mirror image of `source`, which is the arm's skill of that number; `item` is where it is named.
pub(super) fn image(name: &str, (number, source): (usize, &Skill), item: &Item<'_>) -> Result<Skill, ConfigError> {
    if let Some(input) = source.inputs.iter().find(|input| !mirrored(input)) {
        let message = format!(
            "`{name}` cannot be the mirror image of `{}`, whose input `{}` has none",
            source.name,
            inputs::name(*input)
        );
        let hint = "only sonar, sonar-far, light and bumpers have one; drop that input, or write mirror = false and \
                    give this skill keys of its own";
        return Err(item.error(message, hint));
    }
    let mut reward = [0.0; Event::ALL.len()];
    let mut ends = 0;
    for seen in Event::ALL {
        reward[event(seen) as usize] = source.reward[seen as usize];
        if source.ends & seen.bit() != 0 {
            ends |= event(seen).bit();
        }
    }
    Ok(Skill {
        name: name.to_owned(),
        children: source.children.iter().map(|child| child.mirrored()).collect(),
        // A planned skill has no nets: its image is planned too.
        mirror: (!source.planned).then_some(number),
        reward,
        ends,
        lessons: 0,
        trials: 0,
        ..source.clone()
    })
}

fn event(seen: Event) -> Event {
    match seen {
        Event::BesideRight => Event::BesideLeft,
        Event::BesideLeft => Event::BesideRight,
        Event::Docked | Event::Collision | Event::PassedDoor => seen,
    }
}
