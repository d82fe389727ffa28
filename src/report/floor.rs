//! The floor plan, and what the sensors read at a place, drawn as in the paper's Figure 1.

use super::canvas::{Anchor, Canvas, GREY, INK, PALE};
use crate::run_folder::PlaceReading;
use crate::world::{Light, Pose, ROBOT_RADIUS, Rect, World};
use glam::Vec2;
use plotters::style::RGBColor;

const MARGIN: f64 = 34.0;
const TOP: f64 = 62.0;
const BOTTOM: f64 = 44.0;
/// Points that the longer side of a large floor takes.
pub(super) const LARGE: f64 = 560.0;
/// The same of one of three side by side.
pub(super) const SMALL: f64 = 340.0;
/// Shortest width that holds the headings of a large floor.
const NARROWEST: f64 = 440.0;

const SOLID: RGBColor = RGBColor(0xc8, 0xc8, 0xc8);
const CHARGER: RGBColor = RGBColor(0x00, 0x9e, 0x73);
const LIGHT: RGBColor = RGBColor(0xe6, 0x9f, 0x00);
const ROBOT: RGBColor = RGBColor(0x00, 0x72, 0xb2);
const RAY: RGBColor = RGBColor(0xd5, 0x5e, 0x00);
const ROOM: RGBColor = RGBColor(0xb4, 0xb4, 0xb4);

/// Draws the floor plan with its rooms, doors, charger, light and places, large or small.
pub fn draw_world(world: &World, side: f64) -> String {
    let ring = if world.light.is_some() { " Dashed: range of the light." } else { "" };
    let legend = if side < LARGE { String::new() } else { format!(" Arrows: named places.{ring}") };
    let subtitle = format!("{} by {} inches.{legend}", world.size.x, world.size.y);
    let mut floor = Floor::new(world, &format!("Floor plan: {}", world.name), &subtitle, (side, 0.0));
    if let Some(light) = &world.light {
        floor.range(world, light);
    }
    floor.rooms(world);
    floor.solids(world);
    for (name, pose) in &world.places {
        floor.robot(pose, ROBOT);
        let behind = Vec2::from_angle(pose.heading.to_radians()) * -(ROBOT_RADIUS + 9.0);
        let at = floor.at(Vec2::new(pose.x, pose.y) + behind);
        floor.canvas.text(name, at, if side < LARGE { 11.5 } else { 14.0 }, INK, Anchor::Middle);
    }
    floor.canvas.finish()
}

/// Draws 24 sonar rays of the measured lengths around the robot (Figure 1b).
pub fn draw_sonar(world: &World, reading: &PlaceReading) -> String {
    let subtitle = "24 noise-free sonar readings, every 15 degrees from the heading, drawn to scale.";
    let mut floor = Floor::new(world, &format!("Sonar at {}", reading.place), subtitle, (LARGE, 0.0));
    floor.solids(world);
    let pose = pose(reading);
    for (i, &length) in reading.sonar.iter().enumerate() {
        let end = floor.at(bearing_point(&pose, i, length as f32));
        floor.canvas.line(&[floor.at(Vec2::new(pose.x, pose.y)), end], RAY, 1.0);
        floor.canvas.disc(end, 2.2, RAY);
    }
    floor.robot(&pose, ROBOT);
    floor.canvas.finish()
}

/// Draws the 24 bearings of the light sensor, lit or dark (Figure 1c).
pub fn draw_light(world: &World, reading: &PlaceReading) -> String {
    let lit = reading.light.iter().filter(|&&bit| bit != 0).count();
    let subtitle =
        format!("24 light bearings, every 15 degrees from the heading: {lit} lit (filled), the others dark.");
    let mut floor = Floor::new(world, &format!("Light at {}", reading.place), &subtitle, (LARGE, 0.0));
    floor.solids(world);
    let pose = pose(reading);
    for (i, &bit) in reading.light.iter().enumerate() {
        let (near, far) = (bearing_point(&pose, i, ROBOT_RADIUS + 3.0), bearing_point(&pose, i, ROBOT_RADIUS + 18.0));
        let far = floor.at(far);
        floor.canvas.line(
            &[floor.at(near), far],
            if bit != 0 { LIGHT } else { PALE },
            if bit != 0 { 2.5 } else { 1.0 },
        );
        if bit != 0 {
            floor.canvas.disc(far, 4.5, LIGHT);
        }
        floor.canvas.ring(far, 4.5, GREY, 0.8);
    }
    floor.robot(&pose, ROBOT);
    floor.canvas.finish()
}

fn pose(reading: &PlaceReading) -> Pose {
    Pose { x: reading.x, y: reading.y, heading: reading.heading }
}

/// The point at a distance in inches from the robot's centre along bearing `index`, counter-clockwise from the heading.
fn bearing_point(pose: &Pose, index: usize, distance: f32) -> Vec2 {
    let angle = pose.heading + 15.0 * index as f32;
    Vec2::new(pose.x, pose.y) + Vec2::from_angle(angle.to_radians()) * distance
}

/// Where in a room its name is least in the way: far from boxes and places, and near the middle if that is as good.
fn clearest_point(room: &Rect, world: &World) -> Vec2 {
    const STEPS: u16 = 12;
    /// Clearance in inches beyond which a point is as good as any.
    const ENOUGH: f32 = 34.0;
    let middle = (room.min + room.max) / 2.0;
    let clearance = |point: Vec2| {
        let boxes = world.boxes.iter().map(|area| point.distance(point.clamp(area.min, area.max)));
        let places = world.places.iter().map(|(_, pose)| point.distance(Vec2::new(pose.x, pose.y)) - 26.0);
        boxes.chain(places).fold(ENOUGH, f32::min) - point.distance(middle) / 100.0
    };
    let share = |i: u16| f32::from(i) / f32::from(STEPS);
    let grid = (1..STEPS).flat_map(|i| (1..STEPS).map(move |j| Vec2::new(share(i), share(j))));
    let points = grid.map(|shares| room.min + (room.max - room.min) * shares);
    points.max_by(|&a, &b| clearance(a).total_cmp(&clearance(b))).unwrap_or(middle)
}

/// A canvas with the floor's own coordinates.
pub(super) struct Floor {
    pub(super) canvas: Canvas,
    pub(super) left: f64,
    pub(super) bottom: f64,
    scale: f64,
    size: (f64, f64),
}

impl Floor {
    /// A surface of [`LARGE`] or [`SMALL`] size, with `below` points to spare under the key.
    pub(super) fn new(world: &World, title: &str, subtitle: &str, (side, below): (f64, f64)) -> Self {
        let (width, height) = (f64::from(world.size.x), f64::from(world.size.y));
        let scale = side / width.max(height).max(1.0);
        let size =
            ((width * scale + 2.0 * MARGIN).max(NARROWEST * side / LARGE), height * scale + TOP + BOTTOM + below);
        let mut canvas = Canvas::new(size.0, size.1, title);
        canvas.text(title, (MARGIN, 22.0), if side < LARGE { 14.5 } else { 18.0 }, INK, Anchor::Start);
        canvas.text(subtitle, (MARGIN, 44.0), 11.5, GREY, Anchor::Start);
        Self { canvas, scale, left: (size.0 - width * scale) / 2.0, bottom: TOP + height * scale, size }
    }

    /// Where a point of the floor lies on the canvas.
    pub(super) fn at(&self, point: Vec2) -> (f64, f64) {
        (self.left + f64::from(point.x) * self.scale, self.bottom - f64::from(point.y) * self.scale)
    }

    fn fill(&mut self, area: &Rect, color: RGBColor) {
        self.canvas.rectangle(self.at(area.min), self.at(area.max), color, 1.0);
    }

    fn rooms(&mut self, world: &World) {
        for room in &world.rooms {
            let clear = self.at(clearest_point(&room.area, world));
            self.canvas.text(&room.name, clear, 25.0 * self.scale, ROOM, Anchor::Middle);
        }
        for door in &world.doors {
            let along = Vec2::new(-door.normal.y, door.normal.x) * door.width / 2.0;
            let (a, b) = (self.at(door.centre - along), self.at(door.centre + along));
            self.canvas.dashes(a, b, GREY, 1.2, 3.0);
            let (x, y) = self.at(door.centre + door.normal * door.depth / 2.0);
            let label = format!("door {}", door.name);
            if door.normal.x.abs() > door.normal.y.abs() {
                let (gap, anchor) = if door.normal.x > 0.0 { (6.0, Anchor::Start) } else { (-6.0, Anchor::End) };
                self.canvas.text(&label, (x + gap, y), 11.5, GREY, anchor);
            } else {
                self.canvas.text(&label, (x, y - 11.0 * f64::from(door.normal.y)), 11.5, GREY, Anchor::Middle);
            }
        }
    }

    /// Walls, boxes, charger and light, with the key to them.
    pub(super) fn solids(&mut self, world: &World) {
        // The lines come first, so that none shows inside a solid where two boxes overlap.
        for segment in &world.segments {
            let (a, b) = (self.at(segment.a), self.at(segment.b));
            self.canvas.line(&[a, b], INK, 3.0);
        }
        for area in &world.boxes {
            self.fill(area, SOLID);
        }
        if let Some(charger) = &world.charger {
            self.fill(&charger.area, CHARGER);
        }
        if let Some(light) = &world.light {
            let centre = self.at(light.at);
            self.canvas.disc(centre, 6.0, LIGHT);
            self.canvas.ring(centre, 6.0, INK, 1.0);
        }
        self.key(world);
    }

    /// Below the floor: what the colours mean, and the scale.
    fn key(&mut self, world: &World) {
        let y = self.bottom + 26.0;
        let mut x = self.left;
        if world.charger.is_some() {
            self.canvas.rectangle((x, y - 6.0), (x + 12.0, y + 6.0), CHARGER, 1.0);
            self.canvas.text("charger", (x + 18.0, y), 12.0, INK, Anchor::Start);
            x += 84.0;
        }
        if world.light.is_some() {
            self.canvas.disc((x + 6.0, y), 5.0, LIGHT);
            self.canvas.text("light", (x + 18.0, y), 12.0, INK, Anchor::Start);
            x += 64.0;
        }
        self.canvas.rectangle((x, y - 6.0), (x + 12.0, y + 6.0), SOLID, 1.0);
        self.canvas.text("solid", (x + 18.0, y), 12.0, INK, Anchor::Start);
        let right = self.size.0 - self.left;
        let length = 60.0 * self.scale;
        self.canvas.line(&[(right - length, y + 4.0), (right, y + 4.0)], INK, 2.0);
        self.canvas.text("60 in", (right - length / 2.0, y - 6.0), 12.0, INK, Anchor::Middle);
    }

    /// The circle within which a bearing that points at the light is lit, as far as it lies on the floor.
    fn range(&mut self, world: &World, light: &Light) {
        let floor = Rect { min: Vec2::ZERO, max: world.size };
        let on_circle = |degrees: i32| light.at + Vec2::from_angle((degrees as f32).to_radians()) * light.range;
        for degrees in (0..360).step_by(4) {
            let ends = [on_circle(degrees), on_circle(degrees + 2)];
            if ends.iter().all(|&end| floor.contains(end)) {
                self.canvas.line(&ends.map(|end| self.at(end)), LIGHT, 1.4);
            }
        }
    }

    /// The robot's body, and an arrow ahead of it.
    pub(super) fn robot(&mut self, pose: &Pose, color: RGBColor) {
        let centre = Vec2::new(pose.x, pose.y);
        let forward = Vec2::from_angle(pose.heading.to_radians());
        let side = forward.perp();
        let body = self.at(centre);
        self.canvas.disc(body, f64::from(ROBOT_RADIUS) * self.scale, RGBColor(0xff, 0xff, 0xff));
        self.canvas.ring(body, f64::from(ROBOT_RADIUS) * self.scale, color, 1.6);
        let tip = centre + forward * (ROBOT_RADIUS + 12.0);
        self.canvas.line(&[body, self.at(tip - forward * 6.0)], color, 2.0);
        let head =
            [tip, tip - forward * 9.0 + side * 4.5, tip - forward * 9.0 - side * 4.5].map(|point| self.at(point));
        self.canvas.polygon(&head, color, 1.0);
    }
}
