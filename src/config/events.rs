//! What rewards and goals are made of: events, and events of regions such as `left(room:A)`.

use super::keys;
use super::plan::{Event, RegionEvent};
use crate::layout::{MAX_REGIONS, SKILL_EVENTS};
use crate::toml::document::SourceSpan;
use crate::toml::error::{ConfigError, suggest};
use crate::toml::reader::{Item, argument};
use crate::world::World;

/// Reads the events of one skill, and collects the regions that they name.
#[derive(Debug)]
pub(super) struct EventReader<'a> {
    /// The floor plan in which they must be able to happen, if there is one.
    world: Option<&'a World>,
    /// The regions named so far; their places are those of [`RegionEvent::number`].
    pub(super) regions: Vec<String>,
}

impl<'a> EventReader<'a> {
    pub(super) fn new(world: Option<&'a World>) -> Self {
        Self { world, regions: Vec::new() }
    }

    /// Amount paid for each event.
    pub(super) fn reward(&mut self, item: &Item<'_>) -> Result<[f32; SKILL_EVENTS], ConfigError> {
        let mut reward = [0.0; SKILL_EVENTS];
        for (entry, amount) in item.table()?.all() {
            let number = self.number(&entry.key, &entry.origin)?;
            reward[number] = amount.number(keys::AMOUNT)?;
        }
        if reward == [0.0; SKILL_EVENTS] {
            let message = format!("`{}` pays for nothing, so there is nothing to learn", item.name);
            return Err(item.error(message, "write { docked = 100, collision = -10 }, or other events and amounts"));
        }
        Ok(reward)
    }

    /// Bits of the events that end a trial; a skill may go on until its step limit.
    pub(super) fn goal(&mut self, item: &Item<'_>) -> Result<u32, ConfigError> {
        let mut goal = 0;
        for one in item.items()? {
            let bit = 1 << self.number(one.text()?, one.origin())?;
            if goal & bit != 0 {
                return Err(one.error(format!("`{}` is there twice", one.text()?), "name each once"));
            }
            goal |= bit;
        }
        Ok(goal)
    }

    /// The number of an event that can happen in this world.
    fn number(&mut self, name: &str, origin: &SourceSpan) -> Result<usize, ConfigError> {
        let of_region = |event: &RegionEvent| argument(name, event.name()).map(|region| (*event, region));
        if let Some((event, region)) = RegionEvent::ALL.iter().find_map(of_region) {
            return Ok(event.number(self.region(region, origin)?));
        }
        let Some(event) = Event::ALL.into_iter().find(|event| event.name() == name) else {
            let hint = match RegionEvent::ALL.into_iter().find(|event| event.name() == name) {
                Some(event) => format!("name a region, such as {}(room:A)", event.name()),
                None => suggest(name, "events", &event_names().iter().map(String::as_str).collect::<Vec<_>>()),
            };
            return Err(origin.error(format!("`{name}` is not one of the events"), hint));
        };
        match self.world.and_then(|world| impossible(event, world)) {
            None => Ok(event as usize),
            Some((message, lacking)) => {
                Err(origin.error(message, format!("add {lacking} to the world file, or drop this event")))
            }
        }
    }

    /// The place of a region among those of the skill.
    fn region(&mut self, name: &str, origin: &SourceSpan) -> Result<usize, ConfigError> {
        if let Some(place) = self.regions.iter().position(|known| known == name) {
            return Ok(place);
        }
        if let Some(world) = self.world.filter(|world| world.region_area(name).is_none()) {
            return Err(origin.error(lacking_region(name, world), known_regions(name, world)));
        }
        if self.regions.len() == MAX_REGIONS {
            let message = format!("`{name}` is one region more than the events of a skill can name");
            return Err(origin.error(message, format!("at most {MAX_REGIONS} fit")));
        }
        self.regions.push(name.to_owned());
        Ok(self.regions.len() - 1)
    }
}

/// How configs write the events.
pub(super) fn event_names() -> Vec<String> {
    let plain = Event::ALL.iter().map(|event| event.name().to_owned());
    plain.chain(RegionEvent::ALL.iter().map(|event| format!("{}(REGION)", event.name()))).collect()
}

/// That an event cannot happen in a world, and what the world lacks for it.
pub(super) fn impossible(event: Event, world: &World) -> Option<(String, &'static str)> {
    let lacking = world.lacks(event.needs())?.name();
    Some((format!("`{}` cannot happen: the world `{}` has no {lacking}", event.name(), world.name), lacking))
}

/// That a region has no events in a world: it is not there, or no rectangle.
pub(super) fn lacking_region(name: &str, world: &World) -> String {
    format!("the world `{}` has no room or rectangle `{name}` that a robot could enter or leave", world.name)
}

/// Which regions of a world have events.
fn known_regions(name: &str, world: &World) -> String {
    let names = world.rectangular_regions();
    suggest(name, "rooms and rectangles", &names.iter().map(String::as_str).collect::<Vec<_>>())
}
