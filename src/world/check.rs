//! What a world must satisfy as a whole. Every complaint points at the line that has to change.

use super::geometry::distance;
use super::{Door, ROBOT_RADIUS, Rect, Room, WallSegment, World};
use crate::toml::ConfigError;
use crate::toml::document::SourceSpan;
use crate::toml::reader::Item;
use glam::Vec2;

/// Where the parts of a world were written, in the order of the world's own lists.
#[derive(Debug, Default)]
pub(super) struct Written {
    pub(super) doors: Vec<SourceSpan>,
    pub(super) light: Option<SourceSpan>,
    pub(super) places: Vec<SourceSpan>,
}

/// Refuses rooms that share floor, at the later one of the two.
pub(super) fn overlap(rooms: &[Room], written: &[SourceSpan]) -> Result<(), ConfigError> {
    for (i, (room, origin)) in rooms.iter().zip(written).enumerate() {
        for other in &rooms[..i] {
            let low = room.area.min.max(other.area.min);
            let high = room.area.max.min(other.area.max);
            if high.cmpgt(low).all() {
                let message = format!("the rooms `{}` and `{}` overlap", other.name, room.name);
                let hint = format!("both hold {}, {} to {}, {}", low.x, low.y, high.x, high.y);
                return Err(origin.error(message, hint));
            }
        }
    }
    Ok(())
}

/// Where the parts of a door are written.
pub(super) struct DoorItems<'a> {
    pub(super) rooms: Item<'a>,
    pub(super) centre: Item<'a>,
    pub(super) width: Item<'a>,
}

/// Finds the wall that a door goes through: the gap between its rooms, along one axis.
pub(super) fn door(
    name: String,
    rooms: &[Room],
    joined: [usize; 2],
    (centre, width): (Vec2, f32),
    written: &DoorItems<'_>,
) -> Result<Door, ConfigError> {
    let [first, second] = joined.map(|i| &rooms[i]);
    let pair = format!("`{}` and `{}`", first.name, second.name);
    if joined[0] == joined[1] {
        let message = format!("the door `{name}` joins `{}` to itself", first.name);
        return Err(written.rooms.error(message, "name two rooms"));
    }
    if width <= 2.0 * ROBOT_RADIUS {
        let message = format!("the door `{name}` is {width} inches wide, too narrow for the robot");
        let hint = format!("the robot is {} inches across; 36 to 50 inches work well", 2.0 * ROBOT_RADIUS);
        return Err(written.width.error(message, hint));
    }
    let (low, high) = (first.area, second.area);
    // Signed gaps from the first room to the second: right, left, up, down. Exactly one direction leads through a wall.
    let ways = [
        (Vec2::X, low.max.x, high.min.x),
        (Vec2::NEG_X, high.max.x, low.min.x),
        (Vec2::Y, low.max.y, high.min.y),
        (Vec2::NEG_Y, high.max.y, low.min.y),
    ];
    let along = |v: Vec2, normal: Vec2| v.dot(normal.abs());
    let across = |v: Vec2, normal: Vec2| v.dot(Vec2::ONE - normal.abs());
    let faces = ways.iter().find(|(normal, from, to)| {
        let overlap = across(low.max, *normal).min(across(high.max, *normal))
            - across(low.min, *normal).max(across(high.min, *normal));
        to >= from && overlap > 0.0
    });
    let Some(&(normal, from, to)) = faces else {
        let message = format!("the rooms {pair} of the door `{name}` do not face each other");
        return Err(written.rooms.error(message, "a door needs two rooms side by side, a wall's thickness apart"));
    };
    let at = along(centre, normal);
    if at < from || at > to {
        let axis = if normal.x == 0.0 { "y" } else { "x" };
        let message = format!("the door `{name}` is not between its rooms {pair}");
        let hint = format!("its centre's {axis} must lie between {from} and {to}");
        return Err(written.centre.error(message, hint));
    }
    let start = across(low.min, normal).max(across(high.min, normal));
    let end = across(low.max, normal).min(across(high.max, normal));
    let half = width / 2.0;
    if across(centre, normal) - half < start || across(centre, normal) + half > end {
        let axis = if normal.x == 0.0 { "x" } else { "y" };
        let message = format!("the door `{name}` reaches beyond its rooms {pair}");
        let hint = format!(
            "they share the {axis} from {start} to {end}, and the door needs {half} on each side of its centre"
        );
        return Err(written.centre.error(message, hint));
    }
    // The plan's centre lies halfway through the wall whatever the file says.
    let middle = (from + to) / 2.0;
    let centre = normal.abs() * middle + (Vec2::ONE - normal.abs()) * centre;
    Ok(Door { name, rooms: joined, centre, width, normal, depth: to - from })
}

/// Checks that need the whole world.
pub(super) fn check(world: &World, written: &Written, whole: &SourceSpan) -> Result<(), ConfigError> {
    if world.rooms.is_empty() {
        let hint = "add [[rooms]] with name = \"A\" and box = [0, 0, 360, 420]";
        return Err(whole.error("the world has no rooms", hint));
    }
    doors(world, written)?;
    light(world, written)?;
    for ((name, pose), origin) in world.places.iter().zip(&written.places) {
        let clearance = world.clearance(Vec2::new(pose.x, pose.y));
        if clearance < ROBOT_RADIUS {
            let message = format!("the robot does not fit at the place `{name}`");
            return Err(origin.error(message, fit(clearance)));
        }
    }
    if world.region_is_empty(super::regions::ANYWHERE) != Some(false) {
        let hint = "no room has a spot that is 14 inches from everything solid; make rooms larger or remove boxes";
        return Err(whole.error("the world has no free space", hint));
    }
    Ok(())
}

fn fit(clearance: f32) -> String {
    if clearance <= 0.0 {
        "it lies inside something solid; the robot needs 12 inches on every side".to_owned()
    } else {
        format!("the nearest solid is {clearance:.1} inches away; the robot needs 12")
    }
}

fn doors(world: &World, written: &Written) -> Result<(), ConfigError> {
    for (door, origin) in world.doors.iter().zip(&written.doors) {
        let across = Vec2::ONE - door.normal.abs();
        let half = (across * door.width + door.normal.abs() * door.depth) / 2.0;
        let solids = world.boxes.iter().chain(world.charger.iter().map(|charger| &charger.area));
        // Solids may touch the sides of the opening, as its jambs do, but not its faces.
        let slack = (across - door.normal.abs()) * 0.01;
        let (low, high) = (door.centre - half + slack, door.centre + half - slack);
        let free = |solid: &Rect| solid.max.cmple(low).any() || solid.min.cmpge(high).any();
        let boxed = solids.into_iter().any(|solid| !free(solid));
        let walled = world.segments.iter().any(|segment| crosses(segment.a, segment.b, low, high));
        let reach = door.normal * door.depth / 2.0;
        let tight = [door.centre - reach, door.centre, door.centre + reach]
            .iter()
            .any(|&point| world.clearance(point) < ROBOT_RADIUS - 0.01);
        if boxed || walled || tight {
            let message = format!("the door `{}` is blocked by something solid", door.name);
            let (low, high) = (door.centre - half, door.centre + half);
            let hint = format!(
                "keep {}, {} to {}, {} free, and {ROBOT_RADIUS} inches round the middle of both faces",
                low.x, low.y, high.x, high.y
            );
            return Err(origin.error(message, hint));
        }
    }
    Ok(())
}

/// Whether the open segment enters the open rectangle (clipping, Liang and Barsky).
fn crosses(a: Vec2, b: Vec2, low: Vec2, high: Vec2) -> bool {
    let (mut enter, mut leave) = (0.0_f32, 1.0_f32);
    for axis in 0..2 {
        let (start, step) = (a[axis], b[axis] - a[axis]);
        if step == 0.0 {
            if start <= low[axis] || start >= high[axis] {
                return false;
            }
        } else {
            let (t0, t1) = ((low[axis] - start) / step, (high[axis] - start) / step);
            enter = enter.max(t0.min(t1));
            leave = leave.min(t0.max(t1));
        }
    }
    enter < leave
}

fn light(world: &World, written: &Written) -> Result<(), ConfigError> {
    let (Some(light), Some(origin)) = (&world.light, &written.light) else { return Ok(()) };
    let buried = world.boxes.iter().any(|solid| light.at.cmpgt(solid.min).all() && light.at.cmplt(solid.max).all());
    let touching = |s: &&WallSegment| !s.charger && distance(light.at.as_dvec2(), s) < 0.01;
    if buried || world.segments.iter().any(|segment| touching(&segment)) {
        let hint = "move it off walls and boxes; only the charger lets light through";
        return Err(origin.error("the light is on or inside something solid, where nothing can see it", hint));
    }
    Ok(())
}
