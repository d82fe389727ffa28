//! The world: one floor plan, read from TOML, checked, and turned into what the kernels need.
//!
//! Inches, x right, y up; headings in degrees, 0 = east, counter-clockwise.

mod check;
pub mod geometry;
pub mod keys;
pub mod load;
pub mod regions;
mod solids;
pub mod tables;

pub use load::{load, parse};
pub use tables::Tables;

use crate::layout::WorldPart;
use glam::Vec2;

/// Radius of the robot's body in inches (paper, Figure 1).
pub const ROBOT_RADIUS: f32 = 12.0;

/// A place and a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Inches to the right.
    pub x: f32,
    /// Inches up.
    pub y: f32,
    /// Degrees, 0 = east, counter-clockwise, in [0, 360).
    pub heading: f32,
}

impl Pose {
    /// With a heading of any number of turns.
    pub fn new(x: f32, y: f32, heading: f32) -> Self {
        let turned = heading.rem_euclid(360.0);
        // A tiny negative heading rounds up to a full turn.
        Self { x, y, heading: if turned < 360.0 { turned } else { 0.0 } }
    }
}

/// An axis-parallel rectangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left bottom corner.
    pub min: Vec2,
    /// Right top corner.
    pub max: Vec2,
}

impl Rect {
    /// Whether the point lies in the rectangle, its left and bottom edges counted in.
    pub fn contains(&self, point: Vec2) -> bool {
        point.cmpge(self.min).all() && point.cmplt(self.max).all()
    }
}

/// A named part of the floor. A robot is in the room that holds its centre.
#[derive(Debug, Clone, PartialEq)]
pub struct Room {
    /// Short name, `A`.
    pub name: String,
    /// Its extent.
    pub area: Rect,
}

/// An opening between two rooms.
#[derive(Debug, Clone, PartialEq)]
pub struct Door {
    /// Name, `left`.
    pub name: String,
    /// Indices of the two rooms.
    pub rooms: [usize; 2],
    /// Middle of the opening, halfway through the wall.
    pub centre: Vec2,
    /// Free width in inches.
    pub width: f32,
    /// Unit vector through the door, from the first room to the second.
    pub normal: Vec2,
    /// Thickness of the wall at the door: the gap between the two rooms along the normal.
    pub depth: f32,
}

/// The battery charger: a solid box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Charger {
    /// Its extent.
    pub area: Rect,
    /// Largest angle in degrees between the heading and the contact point that still connects.
    pub tolerance: f32,
}

/// The light on the charger.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Where it stands.
    pub at: Vec2,
    /// Distance in inches at which a bearing that points at it is just lit.
    pub range: f32,
    /// Radius in inches of the region `light-area`, within which the light must also be in line of sight.
    pub area: f32,
}

/// A straight piece of anything solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallSegment {
    /// One end.
    pub a: Vec2,
    /// The other end.
    pub b: Vec2,
    /// Whether it belongs to the charger.
    pub charger: bool,
}

/// A checked floor plan.
#[derive(Debug, Clone, PartialEq)]
pub struct World {
    /// The name that the file gives, or else the file's stem.
    pub name: String,
    /// Outer size in inches.
    pub size: Vec2,
    /// Everything solid: the outer walls first, then walls, boxes and the charger in the file's order. Edges of
    /// boxes that nothing can touch or see, against the outer walls or inside other boxes, are left out.
    pub segments: Vec<WallSegment>,
    /// Solid boxes in the file's order, without the charger: for drawing and for finding free space.
    pub boxes: Vec<Rect>,
    /// At least one.
    pub rooms: Vec<Room>,
    /// Possibly none.
    pub doors: Vec<Door>,
    /// What docking connects to.
    pub charger: Option<Charger>,
    /// What the light sensor sees.
    pub light: Option<Light>,
    /// Named poses, in the file's order.
    pub places: Vec<(String, Pose)>,
    /// Start regions that the file names itself, in its order.
    pub regions: Vec<(String, Rect)>,
}

impl World {
    /// Whether the floor plan has this part.
    pub fn has(&self, part: WorldPart) -> bool {
        match part {
            WorldPart::Charger => self.charger.is_some(),
            WorldPart::Doors => !self.doors.is_empty(),
            WorldPart::Light => self.light.is_some(),
        }
    }

    /// What of the floor plan is needed and not there.
    pub fn lacks(&self, needed: Option<WorldPart>) -> Option<WorldPart> {
        needed.filter(|part| !self.has(*part))
    }
}
