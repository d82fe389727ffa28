//! A world file's text -> a checked [`World`]. All lengths are inches, all angles degrees.

use super::check::{self, DoorItems, Written};
use super::keys;
use super::solids::{self, holds};
use super::{Charger, Door, Light, Pose, Rect, Room, World};
use crate::layout::{MAX_DOORS, MAX_ROOMS, MAX_SEGMENTS};
use crate::toml::document::Node;
use crate::toml::reader::{Item, TableReader};
use crate::toml::{ConfigError, Files, OsFiles};
use glam::Vec2;
use std::path::Path;

/// Reads and checks a world file; also returns its text.
pub fn load(path: &Path) -> Result<(World, String), ConfigError> {
    let text = OsFiles.read(path).map_err(|error| ConfigError::unreadable(path, "world file", &error))?;
    let world = parse(&text, path)?;
    Ok((world, text))
}

/// Checks a world file's text; `source` names it in messages and, by its stem, the world.
pub fn parse(text: &str, source: &Path) -> Result<World, ConfigError> {
    let document = Node::parse(text, source)?;
    let root = Item::root(&document).table()?;
    let name = match root.optional("name") {
        Some(item) => item.short_name()?.to_owned(),
        None => source.file_stem().map_or_else(|| "world".to_owned(), |stem| stem.to_string_lossy().into_owned()),
    };
    let size = size(&root)?;
    let floor = Rect { min: Vec2::ZERO, max: size };

    let mut written = Written::default();
    let walls = walls(&root, &floor)?;
    let boxes = boxes(&root, &floor)?;
    let rooms = rooms(&root, &floor)?;
    let doors = doors(&root, &rooms, &mut written)?;
    let charger = charger(&root, &floor)?;
    let light = light(&root, &floor, &mut written)?;
    let places = places(&root, &floor, &mut written)?;
    let regions = regions(&root, &floor)?;
    root.finish()?;

    let segments = solids::segments(&floor, &walls, &boxes, charger.as_ref());
    if segments.len() > MAX_SEGMENTS {
        let message = format!("the world has {} segments, more than {MAX_SEGMENTS}", segments.len());
        let hint = "a box counts 4, less its sides against the outer walls; use fewer or larger boxes";
        return Err(document.origin.error(message, hint));
    }
    let world = World { name, size, segments, boxes, rooms, doors, charger, light, places, regions };
    check::check(&world, &written, &document.origin)?;
    Ok(world)
}

fn size(root: &TableReader<'_>) -> Result<Vec2, ConfigError> {
    let item = root.required("size", "[360, 420]")?;
    item.numbers_within("[width, height] in inches", keys::SIDES).map(Vec2::from_array)
}

/// A list that may be missing, with at most `most` items.
fn listed<'a>(root: &TableReader<'a>, key: &str, most: usize) -> Result<Vec<Item<'a>>, ConfigError> {
    let Some(item) = root.optional(key) else { return Ok(Vec::new()) };
    let items = item.items()?;
    match items.get(most) {
        Some(first) => {
            Err(first.error(format!("more than {most} {key}"), format!("at most {most} {key} are possible")))
        }
        None => Ok(items),
    }
}

fn outside(item: &Item<'_>, floor: &Rect) -> ConfigError {
    let hint = format!("the floor reaches from 0, 0 to {}, {} inches", floor.max.x, floor.max.y);
    item.error(format!("`{}` lies outside the floor", item.name), hint)
}

/// A rectangle x1, y1, x2, y2 inside the floor.
fn rect(item: &Item<'_>, floor: &Rect) -> Result<Rect, ConfigError> {
    let [x1, y1, x2, y2] = item.numbers::<4>("[x1, y1, x2, y2] in inches")?;
    if x2 <= x1 || y2 <= y1 {
        let message = format!("`{}` has no area", item.name);
        return Err(item.error(message, "write the left bottom corner, then the right top one: x1 < x2 and y1 < y2"));
    }
    let rect = Rect { min: Vec2::new(x1, y1), max: Vec2::new(x2, y2) };
    if holds(floor, rect.min) && holds(floor, rect.max) { Ok(rect) } else { Err(outside(item, floor)) }
}

fn point(item: &Item<'_>, floor: &Rect) -> Result<Vec2, ConfigError> {
    let point = Vec2::from_array(item.numbers::<2>("[x, y] in inches")?);
    if holds(floor, point) { Ok(point) } else { Err(outside(item, floor)) }
}

fn walls(root: &TableReader<'_>, floor: &Rect) -> Result<Vec<(Vec2, Vec2)>, ConfigError> {
    let mut walls = Vec::new();
    for item in listed(root, "walls", MAX_SEGMENTS)? {
        let [x1, y1, x2, y2] = item.numbers::<4>("[x1, y1, x2, y2] in inches")?;
        let (a, b) = (Vec2::new(x1, y1), Vec2::new(x2, y2));
        if !holds(floor, a) || !holds(floor, b) {
            return Err(outside(&item, floor));
        }
        // Shorter ones have no direction worth the name in f32.
        if a.distance(b) < 0.01 {
            return Err(item.error(format!("`{}` has no length", item.name), "its two ends must differ"));
        }
        walls.push((a, b));
    }
    Ok(walls)
}

fn boxes(root: &TableReader<'_>, floor: &Rect) -> Result<Vec<Rect>, ConfigError> {
    listed(root, "boxes", MAX_SEGMENTS)?.iter().map(|item| rect(item, floor)).collect()
}

/// A name that no earlier one equals.
fn fresh<'a>(item: &Item<'a>, taken: &[&str]) -> Result<&'a str, ConfigError> {
    let name = item.short_name()?;
    if taken.contains(&name) {
        return Err(item.error(format!("`{name}` is there already"), "every name may be used once"));
    }
    Ok(name)
}

fn rooms(root: &TableReader<'_>, floor: &Rect) -> Result<Vec<Room>, ConfigError> {
    let mut rooms: Vec<Room> = Vec::new();
    let mut written = Vec::new();
    for item in listed(root, "rooms", MAX_ROOMS)? {
        let table = item.table()?;
        let taken: Vec<&str> = rooms.iter().map(|room| room.name.as_str()).collect();
        let name = fresh(&table.required("name", "\"A\"")?, &taken)?.to_owned();
        let area = table.required("box", "[0, 0, 176, 200]")?;
        written.push(area.origin().clone());
        rooms.push(Room { name, area: rect(&area, floor)? });
        table.finish()?;
    }
    check::overlap(&rooms, &written)?;
    Ok(rooms)
}

fn doors(root: &TableReader<'_>, rooms: &[Room], written: &mut Written) -> Result<Vec<Door>, ConfigError> {
    let mut doors: Vec<Door> = Vec::new();
    let names: Vec<&str> = rooms.iter().map(|room| room.name.as_str()).collect();
    for item in listed(root, "doors", MAX_DOORS)? {
        let table = item.table()?;
        let taken: Vec<&str> = doors.iter().map(|door| door.name.as_str()).collect();
        let name = fresh(&table.required("name", "\"left\"")?, &taken)?.to_owned();
        let pair = table.required("rooms", "[\"A\", \"C\"]")?;
        let ends = pair.items()?;
        let [first, second] = ends.as_slice() else {
            return Err(pair.error("a door joins two rooms", "write rooms = [\"A\", \"C\"]"));
        };
        let joined = [first.choice("rooms", &names)?, second.choice("rooms", &names)?];
        let centre = table.required("centre", "[64, 204]")?;
        let at = Vec2::from_array(centre.numbers::<2>("[x, y] in inches")?);
        let width = table.required("width", "50")?;
        let origin = centre.origin().clone();
        let items = DoorItems { rooms: pair, centre, width };
        doors.push(check::door(name, rooms, joined, (at, table.number(&keys::DOOR_WIDTH)?), &items)?);
        written.doors.push(origin);
        table.finish()?;
    }
    Ok(doors)
}

fn charger(root: &TableReader<'_>, floor: &Rect) -> Result<Option<Charger>, ConfigError> {
    let Some(item) = root.optional("charger") else { return Ok(None) };
    let table = item.table()?;
    let area = rect(&table.required("box", "[0, 0, 24, 24]")?, floor)?;
    let tolerance = table.number_or_default(&keys::CHARGER_TOLERANCE)?;
    table.finish()?;
    Ok(Some(Charger { area, tolerance }))
}

fn light(root: &TableReader<'_>, floor: &Rect, written: &mut Written) -> Result<Option<Light>, ConfigError> {
    let Some(item) = root.optional("light") else { return Ok(None) };
    let table = item.table()?;
    let place = table.required("at", "[12, 12]")?;
    let at = point(&place, floor)?;
    written.light = Some(place.origin().clone());
    table.required(keys::LIGHT_RANGE, "140")?;
    let range = table.number(&keys::LIGHT_RANGE)?;
    let area = table.number_or_default(&keys::LIGHT_AREA)?;
    table.finish()?;
    Ok(Some(Light { at, range, area }))
}

fn places(root: &TableReader<'_>, floor: &Rect, written: &mut Written) -> Result<Vec<(String, Pose)>, ConfigError> {
    let Some(item) = root.optional("places") else { return Ok(Vec::new()) };
    let mut places = Vec::new();
    for (entry, item) in item.table()?.all() {
        let [x, y, heading] = item.numbers::<3>("[x, y, heading] in inches and degrees")?;
        if !holds(floor, Vec2::new(x, y)) {
            return Err(outside(&item, floor));
        }
        places.push((entry.key.clone(), Pose::new(x, y, heading)));
        written.places.push(item.origin().clone());
    }
    Ok(places)
}

fn regions(root: &TableReader<'_>, floor: &Rect) -> Result<Vec<(String, Rect)>, ConfigError> {
    let mut regions: Vec<(String, Rect)> = Vec::new();
    for item in listed(root, "regions", 64)? {
        let table = item.table()?;
        let named = table.required("name", "\"corner\"")?;
        let mut taken: Vec<&str> = regions.iter().map(|(name, _)| name.as_str()).collect();
        taken.extend(super::regions::BUILT_IN);
        let name = fresh(&named, &taken)?.to_owned();
        regions.push((name, rect(&table.required("box", "[0, 0, 100, 100]")?, floor)?));
        table.finish()?;
    }
    Ok(regions)
}
