//! From a floor plan to the words that the kernels read: the [`WorldPlan`] and the read-only atlas.

use super::geometry::{distance, touch};
use super::{Door, ROBOT_RADIUS, Segment, World};
use crate::learner::layout::{self, Area, WorldPlan};
use bytemuck::Zeroable;
use glam::DVec2;

/// Side in inches of the cells that have their own list of segments.
pub const LIST_CELL: f64 = 12.0;
/// Segments farther than this from every point of a cell are not in its list: the sonar's range and a margin.
pub const LIST_REACH: f64 = 127.5;
/// A door is passed when the robot's centre is farther than this beyond the wall's far face. Ours.
pub const PASSED: f64 = 13.0;

/// The floor plan and everything else that all learners of a run read and nobody writes.
#[derive(Debug, Clone, PartialEq)]
pub struct Atlas {
    /// The floor plan.
    pub plan: WorldPlan,
    /// `words[plan.cell_starts + cell]` to the next one bound a run of ascending segment indices in these same
    /// words: all segments that a robot centred in the cell can touch or hear. Cells go row by row from the bottom.
    pub words: Vec<u32>,
}

impl Atlas {
    /// Writes the floor plan and the segment lists of its cells.
    pub fn new(world: &World) -> Self {
        let columns = (f64::from(world.size.x) / LIST_CELL).ceil() as u32;
        let rows = (f64::from(world.size.y) / LIST_CELL).ceil() as u32;
        let mut plan = plan(world);
        (plan.cell_columns, plan.cell_rows, plan.cell_starts) = (columns, rows, 0);

        let starts = (columns * rows) as usize + 1;
        let mut words = vec![0; starts];
        for cell in 0..columns * rows {
            let corner = DVec2::new(f64::from(cell % columns), f64::from(cell / columns)) * LIST_CELL;
            words[cell as usize] = words.len() as u32;
            let near = |(_, segment): &(u32, &Segment)| square_distance(corner, segment) <= LIST_REACH;
            let numbered = (0..).zip(&world.segments);
            words.extend(numbered.filter(near).map(|(i, _)| i));
        }
        words[starts - 1] = words.len() as u32;
        Self { plan, words }
    }

    /// Appends a list of cells; returns its word offset and its count.
    pub fn add_cells(&mut self, cells: &[u32]) -> (u32, u32) {
        let offset = self.words.len() as u32;
        self.words.extend_from_slice(cells);
        (offset, cells.len() as u32)
    }

    /// Appends the bits of a table of numbers; returns its word offset.
    pub fn add_table(&mut self, table: &[f32]) -> u32 {
        let offset = self.words.len() as u32;
        self.words.extend(table.iter().map(|value| value.to_bits()));
        offset
    }
}

fn plan(world: &World) -> WorldPlan {
    let mut plan = WorldPlan::zeroed();
    plan.segments = world.segments.len() as u32;
    plan.rooms = world.rooms.len() as u32;
    plan.doors = world.doors.len() as u32;
    if let Some(light) = world.light {
        plan.lit = 1;
        (plan.light_x, plan.light_y) = (light.at.x, light.at.y);
        plan.light_range2 = f64::from(light.range).powi(2) as f32;
    }
    // No cosine reaches 2: without a charger nothing docks.
    plan.dock_cosine = world.charger.map_or(2.0, |c| f64::from(c.tolerance).to_radians().cos() as f32);
    for (to, from) in plan.segment.iter_mut().zip(&world.segments) {
        *to = segment(from);
    }
    for (to, room) in plan.room.iter_mut().zip(&world.rooms) {
        let (min, max) = (room.area.min, room.area.max);
        *to = Area { x0: min.x, y0: min.y, x1: max.x, y1: max.y };
    }
    for (to, from) in plan.doorway.iter_mut().zip(&world.doors) {
        *to = doorway(from);
    }
    plan
}

fn segment(segment: &Segment) -> layout::Segment {
    let along = segment.b.as_dvec2() - segment.a.as_dvec2();
    let unit = along / along.length();
    layout::Segment {
        ax: segment.a.x,
        ay: segment.a.y,
        bx: segment.b.x,
        by: segment.b.y,
        tx: unit.x as f32,
        ty: unit.y as f32,
        length: along.length() as f32,
        charger: u32::from(segment.charger),
    }
}

/// The opening, a robot's radius wider on each side and as deep as the robot must go to have passed it.
fn doorway(door: &Door) -> Area {
    let normal = door.normal.abs().as_dvec2();
    let across = DVec2::ONE - normal;
    let half = across * (f64::from(door.width) / 2.0 + f64::from(ROBOT_RADIUS))
        + normal * (f64::from(door.depth) / 2.0 + PASSED);
    let (low, high) = (door.centre.as_dvec2() - half, door.centre.as_dvec2() + half);
    Area { x0: low.x as f32, y0: low.y as f32, x1: high.x as f32, y1: high.y as f32 }
}

/// Distance from a segment to the list cell with this left bottom corner.
fn square_distance(corner: DVec2, segment: &Segment) -> f64 {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let far = corner + LIST_CELL;
    let corners = [corner, DVec2::new(far.x, corner.y), far, DVec2::new(corner.x, far.y)];
    let inside = |p: DVec2| p.cmpge(corner).all() && p.cmple(far).all();
    let enters = inside(a) || (0..4).any(|i| touch(a, b, corners[i], corners[(i + 1) % 4]));
    if enters {
        return 0.0;
    }
    // Two convex shapes apart: the nearest pair holds an end of the segment or a corner of the square.
    let from_end = |p: DVec2| p.distance(p.clamp(corner, far));
    corners.iter().map(|&p| distance(p, segment)).fold(from_end(a).min(from_end(b)), f64::min)
}
