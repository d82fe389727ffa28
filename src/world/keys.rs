//! Every key of a world file. All lengths are inches, all angles degrees.

use crate::layout::schema::Allowed::{Number, Other};
use crate::layout::schema::{Bounds, DefaultSource, KeyRow};

macro_rules! keys {
    ($($name:ident = $path:literal, $default:expr, $allowed:expr, $source:ident, $doc:literal;)*) => {
        $(
            #[doc = concat!("`", $path, "`: ", $doc)]
            pub(super) const $name: KeyRow = KeyRow {
                path: $path, default: $default, allowed: $allowed, source: DefaultSource::$source, doc: $doc,
            };
        )*
        /// All keys, in the order in which files show them; `[]` stands behind a table that may be there several times.
        pub const ALL: &[KeyRow] = &[$($name),*];
    };
}

/// Least and largest side of a floor. Ours: cells are packed in 16 bits, and culled lists must stay small.
pub(super) const SIDES: Bounds = Bounds::between(48.0, 2000.0);

const TEXT: &[&str] = &["string"];
const LIST: &[&str] = &["array"];
/// Light range and radius of the light area.
const REACH: Bounds = Bounds::above(0.0, 10_000.0);

keys! {
    NAME = "name", None, Other(TEXT, "letters, digits, - and _"), Ours, "What reports call the world; the file's stem if left out.";
    SIZE = "size", None, Other(LIST, "[width, height], each between 48 and 2000"), Paper, "Size of the floor; x right, y up. The outer walls are implied. Required.";
    WALLS = "walls", None, Other(LIST, "a list of [x1, y1, x2, y2]"), Paper, "Inner walls: segments in any direction.";
    BOXES = "boxes", None, Other(LIST, "a list of [x1, y1, x2, y2] with x1 < x2 and y1 < y2"), Paper, "Solid boxes.";
    ROOM_NAME = "rooms[].name", None, Other(TEXT, "letters, digits, - and _"), Ours, "Name of a room, such as A; room:A is the region of starts in it. A world has at least one room.";
    ROOM_BOX = "rooms[].box", None, Other(LIST, "[x1, y1, x2, y2]"), Ours, "Its extent: a robot is in the room that holds its centre. Rooms do not overlap.";
    DOOR_NAME = "doors[].name", None, Other(TEXT, "letters, digits, - and _"), Ours, "Name of an opening between two rooms.";
    DOOR_ROOMS = "doors[].rooms", None, Other(LIST, "[name, name]"), Ours, "The two rooms, side by side.";
    DOOR_CENTRE = "doors[].centre", None, Other(LIST, "[x, y]"), Ours, "Middle of the opening.";
    DOOR_WIDTH = "doors[].width", None, Number(Bounds::above(0.0, 2000.0)), Ours, "Free width; more than the robot's 24 inches.";
    CHARGER_BOX = "charger.box", None, Other(LIST, "[x1, y1, x2, y2]"), Paper, "The battery charger, a solid box.";
    CHARGER_TOLERANCE = "charger.tolerance", Some("30.0"), Number(Bounds::above(0.0, 180.0)), Ours, "Largest angle between the heading and the contact point that still connects.";
    LIGHT_AT = "light.at", None, Other(LIST, "[x, y]"), Paper, "Where the light stands. From closer than an inch it is not seen, so it should stand where no robot can.";
    LIGHT_RANGE = "light.range", None, Number(REACH), Ours, "Distance at which a bearing that points at it is just lit.";
    LIGHT_AREA = "light.area", Some("140.0"), Number(REACH), Ours, "Radius of the region light-area, within which the light must also be in line of sight.";
    PLACE = "places.*", None, Other(LIST, "[x, y, heading]"), Ours, "A named pose, at which reports show what the robot senses; heading 0 is east, counter-clockwise.";
    REGION_NAME = "regions[].name", None, Other(TEXT, "letters, digits, - and _"), Ours, "Name of a region of starts and of events, besides anywhere, light-area, near-doors and room:NAME.";
    REGION_BOX = "regions[].box", None, Other(LIST, "[x1, y1, x2, y2]"), Ours, "Its extent.";
}
