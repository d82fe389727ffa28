//! The table `transfer`: what was learned is tested once more, without training, in another floor plan, with other noise,
//! or both (paper, section VII).
//!
//! The root skill of every arm is tested after its last trial, with its nets as they are. Rooms are inputs of nets and
//! rows of results, by their order: another floor plan must have the same ones.

use super::arms::small_name;
use super::events::{impossible, lacking_region};
use super::plan::{Alteration, ArmPlan, Event, Noise};
use super::worlds::{CachedWorld, Worlds};
use super::{keys, robot};
use crate::toml::document::{Node, SourceSpan};
use crate::toml::error::ConfigError;
use crate::toml::reader::Item;
use crate::world::World;

/// Reads the table. A test in which some arm's root could not start or not reach its goal is refused.
pub(super) fn read<'a>(
    altered: &Node,
    base: &Node,
    arms: impl Iterator<Item = &'a ArmPlan> + Clone,
    worlds: &mut Worlds<'_>,
) -> Result<Vec<Alteration>, ConfigError> {
    let mut alterations = Vec::new();
    for (entry, item) in (Item { name: "transfer".to_owned(), node: altered }).table()?.all() {
        small_name(entry, "an alteration")?;
        let table = item.table()?;
        let (world, noise) = (table.optional(keys::TRANSFER_WORLD), table.optional(keys::TRANSFER_NOISE));
        table.finish()?;
        let place = match (&world, &noise) {
            (Some(world), _) => world.origin(),
            (None, Some(_)) => &entry.origin,
            (None, None) => {
                let message = format!("`{}` alters nothing", item.name);
                return Err(entry.origin.error(message, "add world = \"worlds/...\", noise = { ... }, or both"));
            }
        };
        let noise = noise.map(|noise| laid_over(&noise, base)).transpose()?;
        let world = world.map(|world| worlds.place(&world)).transpose()?;
        let placed = |world: usize| &worlds.placed[world].world;
        for arm in arms.clone() {
            let own = world.unwrap_or(arm.world);
            check_rooms(placed(own), placed(arm.world), place)?;
            check_root(worlds.cached(own), arm, place)?;
        }
        alterations.push(Alteration { name: entry.key.clone(), world, noise });
    }
    Ok(alterations)
}

/// A table of noise, each amount of which that is left out is that of the config's own robots.
fn laid_over(item: &Item<'_>, base: &Node) -> Result<Noise, ConfigError> {
    item.table()?;
    let noise = base.get("robot").and_then(|robot| robot.get("noise"));
    let mut merged = noise.cloned().unwrap_or_else(|| Node::empty(item.origin().clone()));
    merged.merge(item.node.clone());
    robot::noise(&Item { name: item.name.clone(), node: &merged })
}

/// Refuses a world with other rooms than `usual`, in which the arm was trained.
fn check_rooms(world: &World, usual: &World, place: &SourceSpan) -> Result<(), ConfigError> {
    let names = |world: &World| world.rooms.iter().map(|room| room.name.clone()).collect::<Vec<_>>();
    let (found, wanted) = (names(world), names(usual));
    if found == wanted {
        return Ok(());
    }
    let message =
        format!("the world `{}` has the rooms {}, not those of `{}`", world.name, found.join(", "), usual.name);
    Err(place.error(message, format!("an altered world has the same rooms in the same order: {}", wanted.join(", "))))
}

/// Refuses a world in which a root's tests cannot start, or cannot reach their goal.
fn check_root(cached: CachedWorld<'_>, arm: &ArmPlan, place: &SourceSpan) -> Result<(), ConfigError> {
    let Some(root) = arm.skills.last() else { return Ok(()) };
    let world = cached.world;
    let problem = match cached.region_is_empty(&root.eval_starts) {
        None => Some(format!("the world `{}` has no region `{}`", world.name, root.eval_starts)),
        Some(true) => Some(format!("in the world `{}` the robot fits nowhere in `{}`", world.name, root.eval_starts)),
        Some(false) => None,
    };
    if let Some(problem) = problem {
        let hint = "give the altered world this region, or test in another one";
        return Err(place.error(format!("{problem}, where tests of `{}` start", root.name), hint));
    }
    for event in Event::ALL.into_iter().filter(|event| root.goal & event.bit() != 0) {
        if let Some((message, lacking)) = impossible(event, world) {
            return Err(place.error(message, format!("add {lacking} to it: tests of `{}` end with this", root.name)));
        }
    }
    if let Some(region) = root.regions.iter().find(|region| world.region_area(region).is_none()) {
        let hint = format!("give the altered world this region: `{}` is about it", root.name);
        return Err(place.error(lacking_region(region, world), hint));
    }
    Ok(())
}
