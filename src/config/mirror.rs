//! Skills that are the mirror image of another one and use its nets.

use super::error::ConfigError;
use super::inputs;
use super::plan::{Event, Input, Skill};
use super::read::Item;

/// The mirror image of `source`, which is the arm's skill of that number; `item` is where it is named.
pub(super) fn image(name: &str, (number, source): (usize, &Skill), item: &Item<'_>) -> Result<Skill, ConfigError> {
    let mirrored =
        |input: &&Input| matches!(input, Input::Sonar { .. } | Input::SonarFar | Input::Light | Input::Bumpers);
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
