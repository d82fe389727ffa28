//! Tensors of `simulate.safetensors`.

use super::tensor::{ExportTensor, ROBOTS, STEPS, object};
use crate::bench::embedded_configs::{DOCKING, embedded_plan};
use crate::bench::executor::open_cpu;
use crate::bench::robot_walk::RobotWalk;
use crate::bench::{BenchError, compare};
use crate::env::observe::{DRAW_ACTUATOR, DRAW_COMPASS, DRAW_LIGHT, DRAW_SONAR};
use crate::layout::{RAYS, Robot};
use crate::math::rng::{Purpose, StepRandom, Stream, coarse_noise, noise};
use crate::train::observation::SensorValues;
use safetensors::tensor::Dtype;
use serde_json::{Map, Value, json};

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
pub(super) fn robot_steps() -> Result<(Vec<ExportTensor>, Map<String, Value>), BenchError> {
    let plan = embedded_plan(DOCKING, &["arms=[\"taught-adam\"]"], 1)?;
    let mut walk = RobotWalk::new(&plan, ROBOTS);
    let mut executors = open_cpu()?;
    let floor = walk.shared.floor.plan;
    let poses =
        |walk: &RobotWalk| walk.robots.iter().flat_map(|robot| [robot.x, robot.y, robot.heading]).collect::<Vec<_>>();
    let start = poses(&walk);
    let seeds: Vec<u32> = walk.robots.iter().flat_map(|robot| [robot.run_seed, robot.robot_seed]).collect();
    let (mut action, mut slip, mut sonar_noise) = (Vec::new(), Vec::new(), Vec::new());
    let (mut light_noise, mut compass_noise) = (Vec::new(), Vec::new());
    let (mut pose, mut bumpers, mut events) = (Vec::new(), Vec::<u8>::new(), Vec::<u8>::new());
    let (mut sonar, mut light, mut compass) = (Vec::<u8>::new(), Vec::<u8>::new(), Vec::new());
    for round in walk.actions(0..STEPS) {
        action.extend(round.iter().map(|code| *code as i32));
        for robot in &walk.robots {
            let noise = StepNoise::next(robot);
            slip.push(noise.slip);
            sonar_noise.extend(noise.sonar);
            light_noise.extend(noise.light);
            compass_noise.push(noise.compass);
        }
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
        for robot in &walk.robots {
            let senses = SensorValues::of(robot);
            bumpers.extend(senses.bumpers);
            events.push(robot.events as u8);
            sonar.extend(senses.sonar.map(|reading| reading as u8));
            light.extend(senses.light);
            compass.push(senses.compass);
        }
    }
    let (robots, steps) = (ROBOTS as usize, STEPS as usize);
    let used = &floor.segment[..floor.segments as usize];
    let segments: Vec<f32> = used.iter().flat_map(|s| [s.ax, s.ay, s.bx, s.by, s.tx, s.ty, s.length]).collect();
    let charger: Vec<u8> = used.iter().map(|segment| segment.charger as u8).collect();
    let floats = ExportTensor::floats;
    let bytes = |text, shape: &[usize], values: &[u8]| ExportTensor::new(text, Dtype::U8, shape, values);
    let tensors = vec![
        floats(("start", "in, in, degree", "x, y, heading before the first step"), &[robots, 3], &start),
        ExportTensor::new(
            ("seed", "", "the robot's random key; not needed by who uses the noise given here"),
            Dtype::U32,
            &[robots, 2],
            &seeds,
        ),
        ExportTensor::codes(
            ("action", "", "0 turn+15, 1 turn-15, 2 turn+60, 3 turn-60, 4 move+12, 5 move-12"),
            &[steps, robots],
            &action,
        ),
        floats(("noise.slip", "", "factor on the length of the turn or travel"), &[steps, robots], &slip),
        floats(("noise.sonar", "", "factor on the range of each ray"), &[steps, robots, RAYS], &sonar_noise),
        floats(("noise.light", "", "factor on the brightness on each bearing"), &[steps, robots, RAYS], &light_noise),
        floats(("noise.compass", "degree", "added to the compass"), &[steps, robots], &compass_noise),
        floats(
            ("segment", "in; tx, ty of length 1", "ax, ay, bx, by: ends; tx, ty: unit vector from a to b; length"),
            &[used.len(), 7],
            &segments,
        ),
        bytes(("segment.charger", "", "1 where it is the charger's"), &[used.len()], &charger),
        floats(("expected.pose", "in, in, degree", "x, y, heading after each step"), &[steps, robots, 3], &pose),
        bytes(("expected.bumpers", "", "front, left, back, right: 1 where touched"), &[steps, robots, 4], &bumpers),
        bytes(("expected.events", "", "1 docked, 2 collision, else 0"), &[steps, robots], &events),
        bytes(
            ("expected.sonar", "in", "0 straight ahead, then counter-clockwise every 15 degrees"),
            &[steps, robots, RAYS],
            &sonar,
        ),
        bytes(("expected.light", "", "1 where lit, in the same order"), &[steps, robots, RAYS], &light),
        floats(("expected.compass", "degree", "reading of the compass"), &[steps, robots], &compass),
    ];
    let numbers = json!({
        "light_x": floor.light_x,
        "light_y": floor.light_y,
        "light_range2": floor.light_range2,
        "dock_cosine": floor.dock_cosine,
    });
    Ok((tensors, object(numbers)))
}
