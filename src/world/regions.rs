//! Named parts of the floor in which trials start, as lists of small cells.
//!
//! A start pose is drawn by picking a cell and a point in it, so a robot must be free anywhere in the cell. All
//! regions keep to the rooms: a robot that started in a doorway would have no first room to leave.

use super::{ROBOT_RADIUS, Rect, World};
use glam::Vec2;
use std::f32::consts::{FRAC_1_SQRT_2, SQRT_2};

/// Side of a start cell in inches. Ours.
pub const CELL: f32 = 2.0;
/// The region that is all free floor.
pub const ANYWHERE: &str = "anywhere";
/// The region round the light, in its line of sight.
pub const LIGHT_AREA: &str = "light-area";
/// The region from which a door can be made out.
pub const NEAR_DOORS: &str = "near-doors";
/// What stands before the name of a room that is a region.
const ROOM: &str = "room:";
/// Regions that have these names in every world; besides, every room `A` is the region `room:A`.
pub const BUILT_IN: [&str; 3] = [ANYWHERE, LIGHT_AREA, NEAR_DOORS];

/// Distance in inches within which a visible door counts as near at any angle. Ours.
const NEAR: f32 = 55.0;
/// Distance in inches within which it counts as near from straight ahead, 45 degrees to either side. Ours.
const NEAR_AHEAD: f32 = 70.0;

impl World {
    /// Names of all regions of this world. A region may still be empty.
    pub fn region_names(&self) -> Vec<String> {
        let mut names = vec![ANYWHERE.to_owned()];
        names.extend(self.light.iter().map(|_| LIGHT_AREA.to_owned()));
        names.extend((!self.doors.is_empty()).then(|| NEAR_DOORS.to_owned()));
        names.extend(self.rooms.iter().map(|room| format!("{ROOM}{}", room.name)));
        names.extend(self.regions.iter().map(|(name, _)| name.clone()));
        names
    }

    /// Cells of a region, packed `ix | iy << 16` in units of [`CELL`], row by row from the bottom; none for an
    /// unknown name. A robot centred anywhere in a cell is free, and the cell's centre is in the region.
    pub fn region_cells(&self, name: &str) -> Option<Vec<u32>> {
        self.cells(name).map(Iterator::collect)
    }

    /// Whether a region has no cell, which is found out sooner than all its cells; none for an unknown name.
    pub fn region_is_empty(&self, name: &str) -> Option<bool> {
        self.cells(name).map(|mut cells| cells.next().is_none())
    }

    /// The rectangle of a room, `room:A`, or of a region that the file names; none for a region of another shape.
    pub fn region_area(&self, name: &str) -> Option<Rect> {
        match name.strip_prefix(ROOM) {
            Some(wanted) => self.rooms.iter().find(|room| room.name == wanted).map(|room| room.area),
            None => self.regions.iter().find(|(known, _)| known == name).map(|(_, area)| *area),
        }
    }

    /// Names of the regions that are rectangles.
    pub fn rectangular_regions(&self) -> Vec<String> {
        self.region_names().into_iter().filter(|name| self.region_area(name).is_some()).collect()
    }

    fn cells(&self, name: &str) -> Option<impl Iterator<Item = u32>> {
        if !self.region_names().iter().any(|known| known == name) {
            return None;
        }
        let [columns, rows] = (self.size / CELL).floor().to_array().map(|n| n as u32);
        let cells = (0..rows).flat_map(move |iy| (0..columns).map(move |ix| (ix, iy)));
        let chosen = cells.filter(move |&(ix, iy)| {
            let centre = cell_centre(ix, iy);
            // The region first: it is cheaper than the clearance.
            self.in_region(name, centre) && self.clearance(centre) >= ROBOT_RADIUS + CELL / 2.0 * SQRT_2
        });
        Some(chosen.map(|(ix, iy)| ix | iy << 16))
    }

    fn in_region(&self, name: &str, point: Vec2) -> bool {
        if self.room_of(point).is_none() {
            return false;
        }
        match name {
            ANYWHERE => true,
            LIGHT_AREA => {
                self.light.is_some_and(|light| point.distance(light.at) <= light.area && self.sees(point, light.at))
            }
            NEAR_DOORS => self.doors.iter().any(|door| {
                let way = point - door.centre;
                let ahead = way.dot(door.normal).abs() >= way.length() * FRAC_1_SQRT_2;
                let reach = if ahead { NEAR_AHEAD } else { NEAR };
                way.length() <= reach && self.sees(point, door.centre)
            }),
            _ => self.region_area(name).is_some_and(|area| area.contains(point)),
        }
    }
}

/// Middle of a start cell, inches.
pub fn cell_centre(ix: u32, iy: u32) -> Vec2 {
    (Vec2::new(ix as f32, iy as f32) + 0.5) * CELL
}
