//! What a robot senses, as a person reads it.

use crate::backend::{Backend, BackendError};
use crate::env::motion::NO_ACTION;
use crate::env::segments::SegmentGrid;
use crate::env::workgroup::CohortData;
use crate::layout::choices::NOISE_GAUSSIAN;
use crate::layout::{Noise, RAYS, Robot};
use crate::run_folder::PlaceReading;
use crate::world::tables::Tables;
use crate::world::{Pose, World};
use bytemuck::Zeroable;

/// One reading of all sensors.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SensorValues {
    /// Inches; index 0 straight ahead, then counter-clockwise every 15 degrees.
    pub sonar: [u32; RAYS],
    /// 0 or 1, in the same order.
    pub light: [u8; RAYS],
    /// 0 or 1: front, left, back, right.
    pub bumpers: [u8; 4],
    /// Degrees.
    pub compass: f32,
}

impl SensorValues {
    /// What the robot sensed last.
    pub fn of(robot: &Robot) -> Self {
        Self {
            sonar: std::array::from_fn(|ray| robot.sensed.sonar_inches(ray)),
            light: std::array::from_fn(|ray| ((robot.sensed.lit_bearings() >> ray) & 1) as u8),
            bumpers: std::array::from_fn(|side| ((robot.sensed.bumper_bits() >> side) & 1) as u8),
            compass: robot.sensed.compass_degrees(),
        }
    }
}

/// The memory that robots under given actions need: the floor and its segment lists, no skills.
pub fn floor_only(world: &World) -> CohortData {
    let tables = Tables::new(world);
    CohortData {
        floor: SegmentGrid::new(&tables.plan, &tables.words),
        skills: Vec::new(),
        tables: tables.words,
        bank: Vec::new(),
    }
}

/// A robot that stands at a pose.
pub fn robot_at(pose: Pose, noise: &Noise, run_seed: u32, robot_seed: u32) -> Robot {
    Robot {
        x: pose.x,
        y: pose.y,
        heading: pose.heading,
        action: NO_ACTION,
        run_seed,
        robot_seed,
        noise: *noise,
        ..Robot::zeroed()
    }
}

/// No noise at all.
pub const SILENT: Noise = Noise { kind: NOISE_GAUSSIAN, actuator: 0.0, sonar: 0.0, light: 0.0, compass: 0.0 };

/// What a robot senses at the world's named places, without noise.
pub fn places(world: &World, backend: &mut dyn Backend) -> Result<Vec<PlaceReading>, BackendError> {
    let shared = floor_only(world);
    let mut robots: Vec<Robot> = world.places.iter().map(|(_, pose)| robot_at(*pose, &SILENT, 0, 0)).collect();
    if robots.is_empty() {
        return Ok(Vec::new());
    }
    backend.step(&shared, &mut robots, 1)?;
    let reading = |((place, pose), robot): (&(String, Pose), &Robot)| {
        let observed = SensorValues::of(robot);
        PlaceReading {
            place: place.clone(),
            x: pose.x,
            y: pose.y,
            heading: pose.heading,
            sonar: observed.sonar,
            light: observed.light,
        }
    };
    Ok(world.places.iter().zip(&robots).map(reading).collect())
}
