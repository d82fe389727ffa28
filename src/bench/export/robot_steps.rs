//! Tensors of `simulate.safetensors`.

use super::tensor::ExportTensors;
use crate::bench::executor::open_cpu;
use crate::bench::robot_walk::RobotWalk;
use crate::bench::{BenchError, compare};
use crate::env::observe::{DRAW_ACTUATOR, DRAW_COMPASS, DRAW_LIGHT, DRAW_SONAR};
use crate::layout::{RAYS, Robot};
use crate::math::rng::{Purpose, StepRandom, Stream, coarse_noise, noise};
use crate::train::observation::SensorValues;
use serde_json::json;

/// Robots of the file.
const ROBOTS: u32 = 4096;
/// Steps of each.
const STEPS: u32 = 16;

/// The noise of a robot's next step, as kernel `step` draws it.
struct StepNoise {
    /// Factor on the length of the turn or travel.
    slip: f32,
    /// Factor on the range of each ray.
    sonar: [f32; RAYS],
    /// Factor on the brightness on each bearing.
    light: [f32; RAYS],
    /// Degrees added to the compass.
    compass: f32,
}

impl StepNoise {
    fn next(robot: &Robot) -> Self {
        let stream = Stream {
            key: [robot.run_seed, robot.robot_seed],
            skill: 0,
            trial: 0,
            step: robot.step,
            purpose: Purpose::Given as u32,
        };
        let mut random = StepRandom::default();
        random.draw_step(stream);
        let kind = robot.noise.kind;
        let own = |number: usize| noise(kind, random.x[number], random.y[number]);
        let shared = |first: usize, bearing: usize| coarse_noise(kind, random.bearing_word(first, bearing));
        Self {
            slip: robot.noise.actuator * own(DRAW_ACTUATOR) + 1.0,
            sonar: std::array::from_fn(|ray| robot.noise.sonar * shared(DRAW_SONAR, ray) + 1.0),
            light: std::array::from_fn(|ray| robot.noise.light * shared(DRAW_LIGHT, ray) + 1.0),
            compass: robot.noise.compass * own(DRAW_COMPASS),
        }
    }
}

/// The robots' inputs and what they read after each step, the same by every executor on the CPU.
pub(super) fn robot_steps() -> Result<ExportTensors, BenchError> {
    let mut walk = RobotWalk::new(ROBOTS)?;
    let mut executors = open_cpu()?;
    let floor = walk.shared.floor.plan;
    let poses =
        |walk: &RobotWalk| walk.robots.iter().flat_map(|robot| [robot.x, robot.y, robot.heading]).collect::<Vec<_>>();
    let start = poses(&walk);
    let seeds: Vec<u32> = walk.robots.iter().flat_map(|robot| [robot.run_seed, robot.robot_seed]).collect();
    let (mut action, mut noises, mut pose, mut sensed) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for round in walk.actions(0..STEPS) {
        action.extend(round.iter().map(|code| *code as i32));
        noises.extend(walk.robots.iter().map(StepNoise::next));
        let (round, before) = ([round], walk.clone());
        for (number, executor) in executors.iter_mut().enumerate() {
            let mut own = before.clone();
            own.advance(executor.backend.as_mut(), &round, 1)?;
            if number > 0 {
                compare("robot-steps", ("reference", walk.words()), (&executor.info.name, own.words()))?;
            }
            walk = own;
        }
        pose.extend(poses(&walk));
        sensed.extend(walk.robots.iter().map(|robot| (robot.events as u8, SensorValues::of(robot))));
    }
    let segments = &floor.segment[..floor.segments as usize];
    let ends: Vec<f32> = segments.iter().flat_map(|s| [s.ax, s.ay, s.bx, s.by, s.tx, s.ty, s.length]).collect();
    let charger: Vec<u8> = segments.iter().map(|segment| segment.charger as u8).collect();
    let slip: Vec<f32> = noises.iter().map(|noise| noise.slip).collect();
    let sonar_noise: Vec<f32> = noises.iter().flat_map(|noise| noise.sonar).collect();
    let light_noise: Vec<f32> = noises.iter().flat_map(|noise| noise.light).collect();
    let compass_noise: Vec<f32> = noises.iter().map(|noise| noise.compass).collect();
    let events: Vec<u8> = sensed.iter().map(|(events, _)| *events).collect();
    let bumpers: Vec<u8> = sensed.iter().flat_map(|(_, values)| values.bumpers).collect();
    let sonar: Vec<u8> = sensed.iter().flat_map(|(_, values)| values.sonar.map(|inches| inches as u8)).collect();
    let light: Vec<u8> = sensed.iter().flat_map(|(_, values)| values.light).collect();
    let compass: Vec<f32> = sensed.iter().map(|(_, values)| values.compass).collect();

    let mut file = ExportTensors::default();
    let (robots, steps) = (ROBOTS as usize, STEPS as usize);
    let (each, rays) = ([steps, robots], [steps, robots, RAYS]);
    file.add("start", "in, in, degree", "x, y, heading before the first step", &[robots, 3], &start);
    let meaning = "the robot's random key; not needed by who uses the noise given here";
    file.add("seed", "", meaning, &[robots, 2], &seeds);
    let meaning = "0 turn+15, 1 turn-15, 2 turn+60, 3 turn-60, 4 move+12, 5 move-12";
    file.add("action", "", meaning, &each, &action);
    file.add("noise.slip", "", "factor on the length of the turn or travel", &each, &slip);
    file.add("noise.sonar", "", "factor on the range of each ray", &rays, &sonar_noise);
    file.add("noise.light", "", "factor on the brightness on each bearing", &rays, &light_noise);
    file.add("noise.compass", "degree", "added to the compass", &each, &compass_noise);
    let meaning = "ax, ay, bx, by: ends; tx, ty: unit vector from a to b; length";
    file.add("segment", "in; tx, ty of length 1", meaning, &[segments.len(), 7], &ends);
    file.add("segment.charger", "", "1 where it is the charger's", &[segments.len()], &charger);
    file.add("expected.pose", "in, in, degree", "x, y, heading after each step", &[steps, robots, 3], &pose);
    let meaning = "front, left, back, right: 1 where touched";
    file.add("expected.bumpers", "", meaning, &[steps, robots, 4], &bumpers);
    file.add("expected.events", "", "1 docked, 2 collision, else 0", &each, &events);
    let meaning = "0 straight ahead, then counter-clockwise every 15 degrees";
    file.add("expected.sonar", "in", meaning, &rays, &sonar);
    file.add("expected.light", "", "1 where lit, in the same order", &rays, &light);
    file.add("expected.compass", "degree", "reading of the compass", &each, &compass);
    file.numbers = json!({
        "light_x": floor.light_x,
        "light_y": floor.light_y,
        "light_range2": floor.light_range2,
        "dock_cosine": floor.dock_cosine,
    });
    Ok(file)
}
