//! Example trials drawn in the floor plan, colored by the child that drove.

use super::figure::color::{Color, INK, palette};
use super::figure::svg::{Stroke, TextAnchor};
use super::figure::{Figure, Swatch};
use super::floor_plan::{centre, empty, robot, solids, xy};
use super::format::file_word;
use crate::run_folder::{Trajectory, TrajectoryPoint};
use crate::world::{Pose, World};
use glam::Vec2;
use std::collections::BTreeMap;

/// Arms whose example trials are drawn.
const ARMS: usize = 2;
/// A stretch of the way begins with a dot, which shows turns on the spot too.
const DOT: f64 = 2.6;
/// Inches from a robot's centre to the word that marks it.
const BESIDE: f32 = 26.0;
/// Of the robot where a trial ended.
const GHOST: Color = Color(0x88, 0x88, 0x88);

/// A stretch of a trial that one child drove.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenStretch {
    /// Index into the trajectory's children.
    pub child: u32,
    /// The positions on it, the one at which it ended among them.
    pub way: Vec<Vec2>,
}

/// Cuts a trajectory where another child takes over. The last point is where the trial ended: nobody drives there.
pub fn stretches(points: &[TrajectoryPoint]) -> Vec<DrivenStretch> {
    let place = |point: &TrajectoryPoint| Vec2::new(point.x, point.y);
    let mut stretches: Vec<DrivenStretch> = Vec::new();
    for step in points.windows(2) {
        match stretches.last_mut() {
            Some(stretch) if stretch.child == step[0].child => stretch.way.push(place(&step[1])),
            _ => stretches.push(DrivenStretch { child: step[0].child, way: step.iter().map(place).collect() }),
        }
    }
    stretches
}

/// Draws the trials of the arms that lead the comparison, or of the first ones where those have none.
pub fn draw_some(worlds: &BTreeMap<String, World>, trajectories: &[Trajectory], leaders: &[&str]) -> Vec<Figure> {
    let mut arms: Vec<&str> = Vec::new();
    for trajectory in trajectories {
        if !arms.contains(&trajectory.arm.as_str()) {
            arms.push(&trajectory.arm);
        }
    }
    arms.sort_by_key(|arm| leaders.iter().position(|leader| leader == arm).unwrap_or(leaders.len()));
    arms.truncate(ARMS);
    let of_arm = |arm: &str| trajectories.iter().filter(|trajectory| trajectory.arm == arm).collect::<Vec<_>>();
    let chosen = arms.into_iter().flat_map(of_arm);
    chosen.filter_map(|trajectory| Some(draw(worlds.get(&trajectory.world)?, trajectory))).collect()
}

/// Draws the way of one trial.
pub fn draw(world: &World, trajectory: &Trajectory) -> Figure {
    let Trajectory { arm, skill, place, seed, points, children, .. } = trajectory;
    let steps = points.len().saturating_sub(1);
    let end = if trajectory.achieved { "goal achieved" } else { "goal not achieved" };
    let mut figure = Figure {
        name: format!("trial-{}-{}", file_word(arm), file_word(place)),
        section: "trajectories",
        title: format!("{arm}: {skill} from {place}"),
        subtitle: format!("{steps} steps, {end} (seed {seed})"),
        ..empty(world, false)
    };
    solids(&mut figure, world);
    let pose = |point: &TrajectoryPoint| Pose { x: point.x, y: point.y, heading: point.heading };
    if let (Some(first), Some(last)) = (points.first().map(pose), points.last().map(pose)) {
        robot(&mut figure, &last, GHOST);
        robot(&mut figure, &first, INK);
        for stretch in stretches(points) {
            let (way, color) = (stretch.way.into_iter().map(xy).collect::<Vec<_>>(), palette(stretch.child as usize));
            figure.line(&way, Stroke::solid(color, 2.4));
            figure.disc(way[0], DOT, color);
        }
        // It left forwards, and came from behind.
        mark(&mut figure, &first, 180.0, "start");
        if centre(&first).distance(centre(&last)) > BESIDE {
            mark(&mut figure, &last, 90.0, "end");
        }
    }
    let driven = |child: usize| points.iter().take(steps).any(|point| point.child as usize == child);
    for (child, name) in children.iter().enumerate().filter(|(child, _)| driven(*child)) {
        figure.explain(name, Swatch::DottedLine(palette(child)));
    }
    figure
}

/// Writes beside a robot what it marks, at an angle from its heading.
fn mark(figure: &mut Figure, pose: &Pose, angle: f32, text: &str) {
    let beside = Vec2::from_angle((pose.heading + angle).to_radians()) * BESIDE;
    figure.text(text, xy(centre(pose) + beside), 12.0, INK, TextAnchor::Middle);
}
