//! Kernel `step`: one robot carries out one given action and senses.
//!
//! For `probe`, benchmarks and callers that decide for themselves. Twin: `shaders/step.wgsl`.

use crate::learner::layout::{BASE_WORDS, Noise, RECORD_WORDS, Robot};
use crate::learner::memory::Shared;
use crate::math::rng::{Purpose, Stream, noise, roll};
use crate::robot::motion::{NO_ACTION, move_body};
use crate::skill::observe::{DICE_ACTUATOR, observe};

/// Carries out the robot's action and senses.
///
/// The shader repeats this `dispatch.quanta` times. Here the backend does: around a loop the compiler would prepare for
/// many turns, and most calls want one.
#[inline(always)]
pub fn step(robot: &mut Robot, shared: &Shared) {
    let mut record = [0; RECORD_WORDS];
    let terms = Noise {
        kind: robot.noise_kind,
        actuator: robot.noise_actuator,
        sonar: robot.noise_sonar,
        light: robot.noise_light,
        compass: robot.noise_compass,
    };
    let stream = Stream {
        key: [robot.run_seed, robot.robot_seed],
        skill: 0,
        trial: 0,
        step: robot.step,
        purpose: Purpose::Given as u32,
    };
    let dice = roll(stream);
    if robot.action != NO_ACTION {
        let slip = terms.actuator * noise(terms.kind, dice.x[DICE_ACTUATOR], dice.y[DICE_ACTUATOR]) + 1.0;
        let moved = move_body(&shared.floor, robot.x, robot.y, robot.heading, robot.action, slip);
        robot.x = moved.x;
        robot.y = moved.y;
        robot.heading = moved.heading;
        robot.bumpers = moved.bumpers;
        robot.events = moved.events;
    }
    observe(shared, &mut record, &dice, robot.x, robot.y, robot.heading, robot.bumpers, terms);
    robot.step += 1;
    robot.record[..BASE_WORDS].copy_from_slice(&record[..BASE_WORDS]);
}
