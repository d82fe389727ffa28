//! What a report shows besides numbers: example trials in `trajectories.json`, and in `places.json` what the sensors read
//! at the world's named places, without noise.

use super::json::JsonFile;
use serde::{Deserialize, Serialize};

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

impl JsonFile for Vec<Trajectory> {
    const NAME: &'static str = "trajectories.json";
    const PRETTY: bool = false;

    fn problem(&self) -> Option<String> {
        let sound = |trajectory: &Trajectory| {
            let known = |child: u32| (child as usize) < trajectory.children.len();
            trajectory.points.iter().all(|p| is_finite([p.x, p.y, p.heading]) && known(p.child))
        };
        let wrong = self.iter().find(|trajectory| !sound(trajectory))?;
        Some(format!("a point of `{}` from `{}` is not sound", wrong.arm, wrong.place))
    }
}

/// One reading of the sensors at a named place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceReading {
    /// The place's name in the world file.
    pub place: String,
    /// Inches to the right.
    pub x: f32,
    /// Inches up.
    pub y: f32,
    /// Degrees, 0 = east, counter-clockwise.
    pub heading: f32,
    /// Distances in inches from the robot's centre; index 0 straight ahead, then counter-clockwise every 15 degrees.
    pub sonar: [u32; 24],
    /// 1 where the light is seen, in the same order.
    pub light: [u8; 24],
}

impl JsonFile for Vec<PlaceReading> {
    const NAME: &'static str = "places.json";
    const PRETTY: bool = true;

    fn problem(&self) -> Option<String> {
        let wrong = self.iter().find(|reading| !is_finite([reading.x, reading.y, reading.heading]))?;
        Some(format!("the pose of `{}` is not finite", wrong.place))
    }
}

fn is_finite(pose: [f32; 3]) -> bool {
    pose.iter().all(|number| number.is_finite())
}
