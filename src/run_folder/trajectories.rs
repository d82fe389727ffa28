//! `trajectories.json`: example trials, step by step.

use super::{RecordError, json};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The file's name in a run folder.
pub const FILE: &str = "trajectories.json";

/// One greedy trial from a named place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trajectory {
    /// The arm's name.
    pub arm: String,
    /// Seed of the learner.
    pub seed: u32,
    /// The skill pursued.
    pub skill: String,
    /// Named place at which it begins.
    pub place: String,
    /// World file in the run folder.
    pub world: String,
    /// What the skill chooses among; points name them by index.
    pub children: Vec<String>,
    /// Whether the goal was achieved.
    pub achieved: bool,
    /// The pose before each step and the child chosen there; the last one is where the trial ended.
    pub points: Vec<TrajectoryPoint>,
}

/// One step of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryPoint {
    /// Inches to the right.
    pub x: f32,
    /// Inches up.
    pub y: f32,
    /// Degrees, 0 = east, counter-clockwise.
    pub heading: f32,
    /// Index into the trajectory's children.
    pub child: u32,
}

/// JSON text of `trajectories.json`.
///
/// # Errors
/// [`RecordError::Invalid`] if a number has no JSON form.
pub fn write_trajectories(trajectories: &[Trajectory]) -> Result<Vec<u8>, RecordError> {
    json::write(FILE, &trajectories, false)
}

/// Reads the content of `trajectories.json`; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`] for anything but an array of trajectories with finite poses and known children.
pub fn read_trajectories(bytes: &[u8], path: &Path) -> Result<Vec<Trajectory>, RecordError> {
    let trajectories: Vec<Trajectory> = json::read(bytes, path)?;
    let sound = |trajectory: &Trajectory| {
        let point = |p: &TrajectoryPoint| {
            p.x.is_finite()
                && p.y.is_finite()
                && p.heading.is_finite()
                && (p.child as usize) < trajectory.children.len()
        };
        trajectory.points.iter().all(point)
    };
    match trajectories.iter().find(|trajectory| !sound(trajectory)) {
        Some(trajectory) => {
            let problem = format!("a point of `{}` from `{}` is not sound", trajectory.arm, trajectory.place);
            Err(RecordError::damaged(path, problem))
        }
        None => Ok(trajectories),
    }
}
