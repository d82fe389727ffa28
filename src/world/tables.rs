//! From a floor plan to the words that the kernels read: the [`WorldUniform`] and the read-only tables.

use super::geometry::{distance, touch};
use super::solids::sides;
use super::{Door, ROBOT_RADIUS, Rect, WallSegment, World};
use crate::layout::{self, Area, WorldUniform};
use bytemuck::Zeroable;
use glam::{DVec2, Vec2};

/// Side in inches of the cells that have their own list of segments.
pub const LIST_CELL: f64 = 12.0;
/// Segments farther than this from every point of a cell are not in its list: the sonar's range and a margin.
pub const LIST_REACH: f64 = 127.5;
/// What is hidden is so by more than this, inches: far more than rounding can move anything by.
const CLEAR: f64 = 0.1;
/// A door is passed when the robot's centre is farther than this beyond the wall's far face. Ours.
pub const PASSED: f64 = 13.0;

/// The floor plan and everything else that all learners of a run read and nobody writes.
#[derive(Debug, Clone, PartialEq)]
pub struct Tables {
    /// The floor plan.
    pub plan: WorldUniform,
    /// `words[plan.cell_starts + cell]` to the next one bound a run of ascending segment indices in these same
    /// words: all segments that a robot centred in the cell can hear. Cells go row by row from the bottom.
    /// `plan.sight_starts` does the same for the segments that decide whether it sees the light.
    pub words: Vec<u32>,
}

impl Tables {
    /// Writes the floor plan and the segment lists of its cells.
    pub fn new(world: &World) -> Self {
        let columns = (f64::from(world.size.x) / LIST_CELL).ceil() as u32;
        let rows = (f64::from(world.size.y) / LIST_CELL).ceil() as u32;
        let mut plan = plan(world);
        (plan.cell_columns, plan.cell_rows) = (columns, rows);
        let mut words = Vec::new();
        let cells: Vec<DVec2> = (0..columns * rows)
            .map(|cell| DVec2::new(f64::from(cell % columns), f64::from(cell / columns)) * LIST_CELL)
            .collect();
        let heard = |corner: DVec2| indices(world, |segment| can_be_heard(world, corner, segment));
        plan.cell_starts = add_lists(&mut words, cells.iter().map(|&corner| heard(corner)));
        let hiding = |corner: DVec2| world.light.map_or_else(Vec::new, |light| hiding(world, corner, light.at));
        plan.sight_starts = add_lists(&mut words, cells.iter().map(|&corner| hiding(corner)));
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

/// Appends lists, one after another, behind the words at which they start; returns where those stand.
fn add_lists(words: &mut Vec<u32>, lists: impl ExactSizeIterator<Item = Vec<u32>>) -> u32 {
    let starts = words.len();
    words.resize(starts + lists.len() + 1, 0);
    for (number, list) in lists.enumerate() {
        words[starts + number] = words.len() as u32;
        words.extend(list);
        words[starts + number + 1] = words.len() as u32;
    }
    starts as u32
}

fn indices(world: &World, wanted: impl Fn(&WallSegment) -> bool) -> Vec<u32> {
    (0..).zip(&world.segments).filter(|(_, segment)| wanted(segment)).map(|(i, _)| i).collect()
}

/// Whether a segment can be the nearest on some ray out of the cell with this left bottom corner.
fn can_be_heard(world: &World, corner: DVec2, segment: &WallSegment) -> bool {
    square_distance(corner, segment) <= LIST_REACH
        && !turned_away(world, corner, segment)
        && !world.segments.iter().any(|other| covers(other, corner, segment))
}

/// All segments that can stand between a robot in the cell and the light, or one that always does.
fn hiding(world: &World, corner: DVec2, light: Vec2) -> Vec<u32> {
    let spot = WallSegment { a: light, b: light, charger: false };
    let mut between = indices(world, |segment| !segment.charger && stands_between(segment, corner, light.as_dvec2()));
    if let Some(cover) = between.iter().position(|i| covers(&world.segments[*i as usize], corner, &spot)) {
        between = vec![between[cover]];
    }
    between
}

/// Whether a segment comes near any straight line from the cell to the light: whether no axis separates the two.
fn stands_between(segment: &WallSegment, corner: DVec2, light: DVec2) -> bool {
    let ends = [segment.a.as_dvec2(), segment.b.as_dvec2()];
    let [c0, c1, c2, c3] = corners(corner);
    let hull = [c0, c1, c2, c3, light];
    let tangents = [c0, c1, c2, c3].map(|c| (light - c).perp());
    let axes = tangents.into_iter().chain([(ends[1] - ends[0]).perp(), DVec2::X, DVec2::Y]);
    let span = |points: &[DVec2], axis: DVec2| {
        let along = points.iter().map(|p| p.dot(axis));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
    };
    axes.filter_map(DVec2::try_normalize).all(|axis| {
        let (one, two) = (span(&ends, axis), span(&hull, axis));
        one.0 <= two.1 + CLEAR && two.0 <= one.1 + CLEAR
    })
}

fn plan(world: &World) -> WorldUniform {
    let mut plan = WorldUniform::zeroed();
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
        *to = room.area.into();
    }
    for (to, from) in plan.doorway.iter_mut().zip(&world.doors) {
        *to = doorway(from);
    }
    plan
}

impl From<Rect> for Area {
    fn from(Rect { min, max }: Rect) -> Self {
        Self { x0: min.x, y0: min.y, x1: max.x, y1: max.y }
    }
}

fn segment(segment: &WallSegment) -> layout::Segment {
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

/// Corners of the list cell with this left bottom corner.
fn corners(corner: DVec2) -> [DVec2; 4] {
    let far = corner + LIST_CELL;
    [corner, DVec2::new(far.x, corner.y), far, DVec2::new(corner.x, far.y)]
}

/// Whether a segment is the side of a box and the whole cell lies behind it. A ray out of the cell has then come
/// through another side of the box before.
fn turned_away(world: &World, corner: DVec2, segment: &WallSegment) -> bool {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let solids = world.boxes.iter().chain(world.charger.iter().map(|charger| &charger.area));
    let solid_on_the_left = solids.flat_map(sides).any(|side| side == (segment.a, segment.b));
    solid_on_the_left && corners(corner).iter().all(|&p| (b - a).perp_dot(p - a) >= 0.0)
}

/// Whether every straight line from the cell to `segment` crosses `cover`, clear of its ends.
///
/// Cell and segment are convex: it is enough that the lines between their corners do.
fn covers(cover: &WallSegment, corner: DVec2, segment: &WallSegment) -> bool {
    let (a, b) = (cover.a.as_dvec2(), cover.b.as_dvec2());
    let length = a.distance(b);
    let along = (b - a) / length;
    let side = |p: DVec2| along.perp_dot(p - a);
    let ends = [segment.a.as_dvec2(), segment.b.as_dvec2()];
    corners(corner).iter().all(|&from| {
        ends.iter().all(|&to| {
            let (near, far) = (side(from), side(to));
            let apart = near.abs() > CLEAR && far.abs() > CLEAR && near * far < 0.0;
            let at = along.dot(from - a + (to - from) * (near / (near - far)));
            apart && at > CLEAR && at < length - CLEAR
        })
    })
}

/// Distance from a segment to the list cell with this left bottom corner.
fn square_distance(corner: DVec2, segment: &WallSegment) -> f64 {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let far = corner + LIST_CELL;
    let corners = corners(corner);
    let inside = |p: DVec2| p.cmpge(corner).all() && p.cmple(far).all();
    let enters = inside(a) || (0..4).any(|i| touch(a, b, corners[i], corners[(i + 1) % 4]));
    if enters {
        return 0.0;
    }
    // Two convex shapes apart: the nearest pair holds an end of the segment or a corner of the square.
    let from_end = |p: DVec2| p.distance(p.clamp(corner, far));
    corners.iter().map(|&p| distance(p, segment)).fold(from_end(a).min(from_end(b)), f64::min)
}
