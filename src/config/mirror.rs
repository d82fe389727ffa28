//! Skills that are the mirror image of another one and use its nets.

use super::plan::{Child, Event, SkillPlan};
use crate::layout::{EVENTS, HyperParams};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;

/// Refuses replays seen in a mirror that would not show the same skill; `item` is where they are asked for.
pub(super) fn check_replays(skill: &SkillPlan, item: &Item<'_>) -> Result<(), ConfigError> {
    let problem = if skill.is_high() {
        Some("which chooses among skills".to_owned())
    } else if let Some(input) = skill.inputs.iter().find(|input| !input.is_mirrored()) {
        Some(format!("whose input `{}` has no mirror image", input.name()))
    } else if let Some(Child::Action(turn)) = skill.children.iter().find(|c| !skill.children.contains(&c.mirrored())) {
        Some(format!("which has no turn the other way than `{}`", turn.name()))
    } else {
        let differs = |seen: &Event| {
            let goal = |event: Event| skill.goal & event.bit() != 0;
            skill.params.reward[*seen as usize] != skill.params.reward[seen.mirrored() as usize]
                || goal(*seen) != goal(seen.mirrored())
        };
        let side = Event::ALL.into_iter().find(differs);
        side.map(|seen| format!("which sees more in `{}` than in `{}`", seen.name(), seen.mirrored().name()))
    };
    let Some(problem) = problem else { return Ok(()) };
    let message = format!("lessons of `{}`, {problem}, cannot be seen in a mirror", skill.name);
    Err(item.error(message, format!("write skill.{}.learning.mirror_replays = false", skill.name)))
}

/// The mirror image of `source`, which is the arm's skill of that number; `item` is where it is named.
pub(super) fn image(
    name: &str,
    (number, source): (usize, &SkillPlan),
    item: &Item<'_>,
) -> Result<SkillPlan, ConfigError> {
    if let Some(input) = source.inputs.iter().find(|input| !input.is_mirrored()) {
        let message = format!(
            "`{name}` cannot be the mirror image of `{}`, whose input `{}` has none",
            source.name,
            input.name()
        );
        let hint = "only sonar, sonar-far, light and bumpers have one; drop that input, or write mirror = false and \
                    give this skill keys of its own";
        return Err(item.error(message, hint));
    }
    let mut params = HyperParams { lessons: 0, trials: 0, ..source.params };
    // Regions stay where they are: what happens there is its own image.
    let mut goal = source.goal >> EVENTS << EVENTS;
    for seen in Event::ALL {
        params.reward[seen.mirrored() as usize] = source.params.reward[seen as usize];
        if source.goal & seen.bit() != 0 {
            goal |= seen.mirrored().bit();
        }
    }
    Ok(SkillPlan {
        name: name.to_owned(),
        children: source.children.iter().map(|child| child.mirrored()).collect(),
        // An oracle has no nets: its image is one too.
        mirror: (!source.oracle).then_some(number),
        goal,
        params,
        ..source.clone()
    })
}
