//! Example trials drawn in the floor plan, coloured by the child that drove.

use super::canvas::{Anchor, INK};
use super::curves::COLORS;
use super::floor::{Floor, SMALL};
use crate::run_folder::{Trajectory, TrajectoryPoint};
use crate::world::{Pose, World};
use glam::Vec2;
use plotters::style::RGBColor;

const WIDTH: f64 = 2.4;
/// A piece of the way begins with a dot, which shows turns on the spot too.
const DOT: f64 = 2.6;
const LEGEND_ROOM: f64 = 18.0;
const LEGEND_TEXT: f64 = 12.0;
/// Inches from a robot's centre to the word that marks it.
const BESIDE: f32 = 26.0;
/// Of the robot where a trial ended.
const GHOST: RGBColor = RGBColor(0x88, 0x88, 0x88);

/// A stretch of a trial that one child drove.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// Index into the trajectory's children.
    pub child: u32,
    /// The poses on it, the one at which it ended among them.
    pub way: Vec<Vec2>,
}

/// Cuts a trajectory where another child takes over. The last point is where the trial ended: nobody drives there.
pub fn pieces(points: &[TrajectoryPoint]) -> Vec<Piece> {
    let place = |point: &TrajectoryPoint| Vec2::new(point.x, point.y);
    let mut pieces: Vec<Piece> = Vec::new();
    for step in points.windows(2) {
        match pieces.last_mut() {
            Some(piece) if piece.child == step[0].child => piece.way.push(place(&step[1])),
            _ => pieces.push(Piece { child: step[0].child, way: step.iter().map(place).collect() }),
        }
    }
    pieces
}

/// Draws the way of one trial.
pub fn draw(world: &World, trajectory: &Trajectory) -> String {
    let steps = trajectory.points.len().saturating_sub(1);
    let end = if trajectory.achieved { "goal achieved" } else { "goal not achieved" };
    let title = format!("{}: {} from {}", trajectory.arm, trajectory.skill, trajectory.place);
    let subtitle = format!("{steps} steps, {end} (seed {})", trajectory.seed);
    let used = |child: &u32| trajectory.points.iter().take(steps).any(|point| point.child == *child);
    let shown: Vec<u32> = (0..trajectory.children.len() as u32).filter(used).collect();
    let rows = shown.len().div_ceil(2);
    let mut floor = Floor::new(world, &title, &subtitle, (SMALL, LEGEND_ROOM * rows as f64));
    floor.solids(world);
    let pose = |point: &TrajectoryPoint| Pose { x: point.x, y: point.y, heading: point.heading };
    if let (Some(first), Some(last)) = (trajectory.points.first(), trajectory.points.last()) {
        floor.robot(&pose(last), GHOST);
        floor.robot(&pose(first), INK);
        for piece in pieces(&trajectory.points) {
            let way: Vec<_> = piece.way.iter().map(|&point| floor.at(point)).collect();
            floor.canvas.line(&way, color(piece.child), WIDTH);
            floor.canvas.disc(way[0], DOT, color(piece.child));
        }
        // It left forwards, and came from behind.
        mark(&mut floor, &pose(first), 180.0, "start");
        if Vec2::new(last.x - first.x, last.y - first.y).length() > BESIDE {
            mark(&mut floor, &pose(last), 90.0, "end");
        }
    }
    legend(&mut floor, trajectory, &shown);
    floor.canvas.finish()
}

fn color(child: u32) -> RGBColor {
    COLORS[child as usize % COLORS.len()]
}

/// Writes beside a robot what it marks, at an angle from its heading.
fn mark(floor: &mut Floor, pose: &Pose, angle: f32, text: &str) {
    let beside = Vec2::from_angle((pose.heading + angle).to_radians()) * BESIDE;
    let at = floor.at(Vec2::new(pose.x, pose.y) + beside);
    floor.canvas.text(text, at, LEGEND_TEXT, INK, Anchor::Middle);
}

fn legend(floor: &mut Floor, trajectory: &Trajectory, shown: &[u32]) {
    let (left, top) = (floor.left, floor.bottom + 48.0);
    for (number, &child) in shown.iter().enumerate() {
        let x = left + 140.0 * (number % 2) as f64;
        let y = top + LEGEND_ROOM * (number / 2) as f64;
        floor.canvas.line(&[(x, y), (x + 22.0, y)], color(child), WIDTH);
        floor.canvas.disc((x, y), DOT, color(child));
        floor.canvas.text(&trajectory.children[child as usize], (x + 30.0, y), LEGEND_TEXT, INK, Anchor::Start);
    }
}
