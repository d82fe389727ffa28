//! Tensors of `simulate.safetensors`.

use super::{ROBOTS, STEPS, Tensor, object};
use crate::backend::cpu::CpuBackend;
use crate::bench::simulate::{StepNoise, Walk};
use crate::bench::workload::{self, DOCKING};
use crate::bench::{BenchError, same};
use crate::train::observation::SensorValues;
use safetensors::tensor::Dtype;
use serde_json::{Map, Value, json};

/// The robots' inputs and what they read after each step, made by the CPU backend and checked by the reference.
pub(super) fn simulate() -> Result<(Vec<Tensor>, Map<String, Value>), BenchError> {
    let plan = workload::plan(DOCKING, &["arms=[\"taught-adam\"]"], 1)?;
    let mut walk = Walk::new(&plan, ROBOTS);
    let mut scalar = walk.clone();
    let mut backend = CpuBackend::new(0, None)?;
    let floor = walk.shared.floor.plan;
    let poses =
        |walk: &Walk| walk.robots.iter().flat_map(|robot| [robot.x, robot.y, robot.heading]).collect::<Vec<_>>();
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
        let round = [round];
        walk.advance(&mut backend, &round, 1)?;
        scalar.advance_scalar(&round, 1);
        same("robot-steps", ("cpu", walk.words()), ("scalar", scalar.words()))?;
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
    let tensors = vec![
        Tensor::floats(("start", "in, in, degree", "x, y, heading before the first step"), &[robots, 3], &start),
        Tensor::of(
            ("seed", "", "the robot's random key; not needed by who uses the noise given here"),
            Dtype::U32,
            &[robots, 2],
            &seeds,
        ),
        Tensor::codes(
            ("action", "", "0 turn+15, 1 turn-15, 2 turn+60, 3 turn-60, 4 move+12, 5 move-12"),
            &[steps, robots],
            &action,
        ),
        Tensor::floats(("noise.slip", "", "factor on the length of the turn or travel"), &[steps, robots], &slip),
        Tensor::floats(("noise.sonar", "", "factor on the range of each ray"), &[steps, robots, 24], &sonar_noise),
        Tensor::floats(
            ("noise.light", "", "factor on the brightness on each bearing"),
            &[steps, robots, 24],
            &light_noise,
        ),
        Tensor::floats(("noise.compass", "degree", "added to the compass"), &[steps, robots], &compass_noise),
        Tensor::floats(
            ("segment", "in; tx, ty of length 1", "ax, ay, bx, by: ends; tx, ty: unit vector from a to b; length"),
            &[used.len(), 7],
            &segments,
        ),
        Tensor::of(("segment.charger", "", "1 where it is the charger's"), Dtype::U8, &[used.len()], &charger),
        Tensor::floats(
            ("expected.pose", "in, in, degree", "x, y, heading after each step"),
            &[steps, robots, 3],
            &pose,
        ),
        Tensor::of(
            ("expected.bumpers", "", "front, left, back, right: 1 where touched"),
            Dtype::U8,
            &[steps, robots, 4],
            &bumpers,
        ),
        Tensor::of(("expected.events", "", "1 docked, 2 collision, else 0"), Dtype::U8, &[steps, robots], &events),
        Tensor::of(
            ("expected.sonar", "in", "0 straight ahead, then counter-clockwise every 15 degrees"),
            Dtype::U8,
            &[steps, robots, 24],
            &sonar,
        ),
        Tensor::of(("expected.light", "", "1 where lit, in the same order"), Dtype::U8, &[steps, robots, 24], &light),
        Tensor::floats(("expected.compass", "degree", "reading of the compass"), &[steps, robots], &compass),
    ];
    let numbers = json!({
        "light_x": floor.light_x,
        "light_y": floor.light_y,
        "light_range2": floor.light_range2,
        "dock_cosine": floor.dock_cosine,
    });
    Ok((tensors, object(numbers)))
}
