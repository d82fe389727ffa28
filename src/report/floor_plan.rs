//! The floor plan, and what the sensors read at a place, drawn as in the paper's Figure 1.

use super::figure::axis::PlotAxis;
use super::figure::color::{BLUE, Color, GREEN, GREY, INK, ORANGE, PALE, VERMILION, WHITE};
use super::figure::svg::{Stroke, TextAnchor};
use super::figure::{Figure, PlotArea, Swatch};
use super::format::file_word;
use crate::run_folder::PlaceReading;
use crate::world::{Light, Pose, ROBOT_RADIUS, Rect, World};
use glam::Vec2;

const MARGIN: f64 = 34.0;
/// Points that the longer side of a floor takes, and the shortest width that holds the headings.
const LARGE: (f64, f64) = (560.0, 440.0);
const SMALL: (f64, f64) = (340.0, 267.0);
/// Inches that the scale shows.
const SCALE: f64 = 60.0;

const SOLID: Color = Color(0xc8, 0xc8, 0xc8);
const ROOM: Color = Color(0xb4, 0xb4, 0xb4);

/// The floor plan, large, and what the sensors read at its places.
pub fn draw_all(world: &World, places: &[PlaceReading]) -> Vec<Figure> {
    let sensors = places.iter().flat_map(|reading| [sonar(world, reading), light(world, reading)]);
    std::iter::once(plan(world, true)).chain(sensors).collect()
}

/// Another floor plan of the run, small.
pub fn draw_elsewhere(world: &World, file: &str) -> Figure {
    let name = file.trim_start_matches("worlds/").trim_end_matches(".toml");
    Figure { name: format!("world-{}", file_word(name)), section: "transfer", ..plan(world, false) }
}

/// A floor without anything on it, large or small: axes in inches.
pub fn empty(world: &World, large: bool) -> Figure {
    let (width, height) = (f64::from(world.size.x), f64::from(world.size.y));
    let (side, narrowest) = if large { LARGE } else { SMALL };
    let points = side / width.max(height).max(1.0);
    let margin = MARGIN.max((narrowest - width * points) / 2.0);
    let axis = |length: f64| PlotAxis { range: (0.0, length), ..PlotAxis::default() };
    Figure {
        section: "world",
        area: PlotArea { left: margin, right: margin, width: width * points, height: height * points, large },
        x: axis(width),
        y: axis(height),
        ..Figure::default()
    }
}

/// The floor plan with its rooms, doors, charger, light and places.
fn plan(world: &World, large: bool) -> Figure {
    let ring = if world.light.is_some() { " Dashed: range of the light." } else { "" };
    let legend = if large { format!(" Arrows: named places.{ring}") } else { String::new() };
    let mut figure = Figure {
        name: "world".into(),
        title: format!("Floor plan: {}", world.name),
        subtitle: format!("{} by {} inches.{legend}", world.size.x, world.size.y),
        ..empty(world, large)
    };
    if let Some(light) = &world.light {
        light_range(&mut figure, world, light);
    }
    rooms(&mut figure, world);
    solids(&mut figure, world);
    for (name, pose) in &world.places {
        robot(&mut figure, pose, BLUE);
        let behind = Vec2::from_angle(pose.heading.to_radians()) * -(ROBOT_RADIUS + 9.0);
        figure.text(name, xy(centre(pose) + behind), if large { 14.0 } else { 11.5 }, INK, TextAnchor::Middle);
    }
    figure
}

/// 24 sonar rays of the measured lengths around the robot (Figure 1b).
fn sonar(world: &World, reading: &PlaceReading) -> Figure {
    let mut figure = Figure {
        name: format!("sonar-{}", file_word(&reading.place)),
        title: format!("Sonar at {}", reading.place),
        subtitle: "24 noise-free sonar readings, every 15 degrees from the heading, drawn to scale.".into(),
        ..empty(world, true)
    };
    solids(&mut figure, world);
    let pose = pose(reading);
    for (i, &length) in reading.sonar.iter().enumerate() {
        let end = xy(bearing_point(&pose, i, length as f32));
        figure.line(&[xy(centre(&pose)), end], Stroke::solid(VERMILION, 1.0));
        figure.disc(end, 2.2, VERMILION);
    }
    robot(&mut figure, &pose, BLUE);
    figure
}

/// The 24 bearings of the light sensor, lit or dark (Figure 1c).
fn light(world: &World, reading: &PlaceReading) -> Figure {
    let lit = reading.light.iter().filter(|&&bit| bit != 0).count();
    let mut figure = Figure {
        name: format!("light-{}", file_word(&reading.place)),
        title: format!("Light at {}", reading.place),
        subtitle: format!("24 light bearings, every 15 degrees from the heading: {lit} lit (filled), the others dark."),
        ..empty(world, true)
    };
    solids(&mut figure, world);
    let pose = pose(reading);
    for (i, &bit) in reading.light.iter().enumerate() {
        let [near, far] = [3.0, 18.0].map(|distance| xy(bearing_point(&pose, i, ROBOT_RADIUS + distance)));
        let (color, width) = if bit != 0 { (ORANGE, 2.5) } else { (PALE, 1.0) };
        figure.line(&[near, far], Stroke::solid(color, width));
        if bit != 0 {
            figure.disc(far, 4.5, ORANGE);
        }
        figure.ring(far, 4.5, Stroke::solid(GREY, 0.8));
    }
    robot(&mut figure, &pose, BLUE);
    figure
}

fn pose(reading: &PlaceReading) -> Pose {
    Pose { x: reading.x, y: reading.y, heading: reading.heading }
}

/// Where a pose's robot stands.
pub fn centre(pose: &Pose) -> Vec2 {
    Vec2::new(pose.x, pose.y)
}

/// A place on the floor in the figure's numbers.
pub fn xy(point: Vec2) -> (f64, f64) {
    (f64::from(point.x), f64::from(point.y))
}

/// The point at a distance in inches from the robot's centre along bearing `index`, counter-clockwise from the heading.
fn bearing_point(pose: &Pose, index: usize, distance: f32) -> Vec2 {
    centre(pose) + Vec2::from_angle((pose.heading + 15.0 * index as f32).to_radians()) * distance
}

/// Where in a room its name is least in the way: far from boxes and places, and near the middle if that is as good.
fn clearest_point(room: &Rect, world: &World) -> Vec2 {
    const STEPS: u16 = 12;
    /// Clearance in inches beyond which a point is as good as any.
    const ENOUGH: f32 = 34.0;
    let middle = (room.min + room.max) / 2.0;
    let clearance = |point: Vec2| {
        let boxes = world.boxes.iter().map(|area| point.distance(point.clamp(area.min, area.max)));
        let places = world.places.iter().map(|(_, pose)| point.distance(centre(pose)) - 26.0);
        boxes.chain(places).fold(ENOUGH, f32::min) - point.distance(middle) / 100.0
    };
    let share = |i: u16| f32::from(i) / f32::from(STEPS);
    let grid = (1..STEPS).flat_map(|i| (1..STEPS).map(move |j| Vec2::new(share(i), share(j))));
    let points = grid.map(|shares| room.min + (room.max - room.min) * shares);
    points.max_by(|&a, &b| clearance(a).total_cmp(&clearance(b))).unwrap_or(middle)
}

/// Points of the figure per inch.
fn points_per_inch(figure: &Figure) -> f64 {
    figure.area.width / figure.x.range.1
}

fn rooms(figure: &mut Figure, world: &World) {
    for room in &world.rooms {
        let size = 25.0 * points_per_inch(figure);
        figure.text(&room.name, xy(clearest_point(&room.area, world)), size, ROOM, TextAnchor::Middle);
    }
    for door in &world.doors {
        let along = Vec2::new(-door.normal.y, door.normal.x) * door.width / 2.0;
        let stroke = Stroke { color: GREY, width: 1.2, dash: 3.0 };
        figure.line(&[xy(door.centre - along), xy(door.centre + along)], stroke);
        let (gap, anchor) = match door.normal.x.abs() > door.normal.y.abs() {
            true if door.normal.x > 0.0 => (6.0, TextAnchor::Start),
            true => (6.0, TextAnchor::End),
            false => (11.0, TextAnchor::Middle),
        };
        let beyond = door.depth / 2.0 + gap / points_per_inch(figure) as f32;
        let label = format!("door {}", door.name);
        figure.text(&label, xy(door.centre + door.normal * beyond), 11.5, GREY, anchor);
    }
}

/// Walls, boxes, charger and light, with the legend to them and the scale.
pub fn solids(figure: &mut Figure, world: &World) {
    // The lines come first, so that none shows inside a solid where two boxes overlap.
    for segment in &world.segments {
        figure.line(&[xy(segment.a), xy(segment.b)], Stroke::solid(INK, 3.0));
    }
    for area in &world.boxes {
        figure.rectangle(xy(area.min), xy(area.max), SOLID, 1.0);
    }
    if let Some(charger) = &world.charger {
        figure.rectangle(xy(charger.area.min), xy(charger.area.max), GREEN, 1.0);
        figure.explain("charger", Swatch::Square(GREEN));
    }
    if let Some(light) = &world.light {
        figure.disc(xy(light.at), 6.0, ORANGE);
        figure.ring(xy(light.at), 6.0, Stroke::solid(INK, 1.0));
        figure.explain("light", Swatch::Disc(ORANGE));
    }
    figure.explain("solid", Swatch::Square(SOLID));
    figure.explain(format!("{SCALE} in"), Swatch::Length(SCALE * points_per_inch(figure)));
}

/// The circle within which a bearing that points at the light is lit, as far as it lies on the floor.
fn light_range(figure: &mut Figure, world: &World, light: &Light) {
    let floor = Rect { min: Vec2::ZERO, max: world.size };
    let on_circle = |degrees: i32| light.at + Vec2::from_angle((degrees as f32).to_radians()) * light.range;
    for degrees in (0..360).step_by(4) {
        let ends = [on_circle(degrees), on_circle(degrees + 2)];
        if ends.iter().all(|&end| floor.contains(end)) {
            figure.line(&ends.map(xy), Stroke::solid(ORANGE, 1.4));
        }
    }
}

/// The robot's body, and an arrow ahead of it.
pub fn robot(figure: &mut Figure, pose: &Pose, color: Color) {
    let body = centre(pose);
    let forward = Vec2::from_angle(pose.heading.to_radians());
    let radius = f64::from(ROBOT_RADIUS) * points_per_inch(figure);
    figure.disc(xy(body), radius, WHITE);
    figure.ring(xy(body), radius, Stroke::solid(color, 1.6));
    let tip = body + forward * (ROBOT_RADIUS + 12.0);
    figure.line(&[xy(body), xy(tip - forward * 6.0)], Stroke::solid(color, 2.0));
    let (back, side) = (tip - forward * 9.0, forward.perp() * 4.5);
    figure.polygon(&[tip, back + side, back - side].map(xy), color, 1.0);
}
