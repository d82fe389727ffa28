//! Kernel `step`, sixteen robots side by side through each stage: their stages need not wait for one another as those of
//! one robot do, and where a robot has only one number, a lane is a robot.

use super::contact::travel;
use super::draws::{BATCH, bearing_words, draws};
use super::observe::{light_scan, pack_bytes, sonar_scan};
use super::sonar::rays;
use crate::env::motion::{NO_ACTION, heading_after};
use crate::env::observe::{DRAW_ACTUATOR, DRAW_COMPASS, compass_reading};
use crate::env::workgroup::CohortData;
use crate::layout::{BUMPERS_FROM, Robot};
use crate::math::functions::sin_cos;
use crate::math::rng::{Purpose, Stream, noise};
use std::hint::black_box;

/// Robots that step side by side: lanes of a vector.
pub const ABREAST: usize = 16;

/// One number of each robot.
type Each<T> = [T; ABREAST];

/// What a turn needs of each robot.
#[derive(Default)]
struct Before {
    kind: Each<u32>,
    action: Each<u32>,
    heading: Each<f32>,
    actuator: Each<f32>,
    compass: Each<f32>,
    /// Words of the random that slip the actuators.
    slip: [Each<u32>; 2],
    /// Words of the random that turn the compass.
    error: [Each<u32>; 2],
}

/// What a turn leaves of each robot.
#[derive(Default)]
struct After {
    slip: Each<f32>,
    heading: Each<f32>,
    sine: Each<f32>,
    cosine: Each<f32>,
    /// What the compass shows.
    shown: Each<f32>,
}

/// At most [`ABREAST`] robots carry out their actions and sense.
///
/// The backend repeats this: around a loop the compiler would prepare for many turns, and most calls want one.
#[inline(always)]
pub fn step(robots: &mut [Robot], shared: &CohortData) {
    let floor = &shared.floor;
    let mut random = [[[0; BATCH]; 4]; ABREAST];
    for i in 0..robots.len() {
        random[i] = draws(stream_of(&robots[i]), 0);
    }
    let mut before = Before::default();
    for i in 0..robots.len() {
        let robot = &robots[i];
        before.kind[i] = robot.noise.kind;
        before.action[i] = robot.action;
        before.heading[i] = robot.heading;
        before.actuator[i] = robot.noise.actuator;
        before.compass[i] = robot.noise.compass;
        for word in 0..2 {
            before.slip[word][i] = random[i][word][DRAW_ACTUATOR];
            before.error[word][i] = random[i][word][DRAW_COMPASS];
        }
    }
    let mut after = After::default();
    turn(&before, &mut after);
    let after = black_box(&after);
    for i in 0..robots.len() {
        let robot = &mut robots[i];
        if robot.action != NO_ACTION {
            let (heading, sine, cosine) = (after.heading[i], after.sine[i], after.cosine[i]);
            let moved = travel(floor, robot.x, robot.y, heading, sine, cosine, robot.action, after.slip[i]);
            robot.x = moved.x;
            robot.y = moved.y;
            robot.heading = moved.heading;
            robot.bumpers = moved.bumpers;
            robot.events = moved.events;
        }
    }
    for i in 0..robots.len() {
        let robot = &mut robots[i];
        let (ux, uy) = rays(after.cosine[i], after.sine[i]);
        let words = bearing_words(&random[i][0], &random[i][1], &random[i][2], &random[i][3]);
        let readings = sonar_scan(floor, &words, robot.x, robot.y, &ux, &uy, robot.noise);
        robot.sensed.sonar = pack_bytes(&readings);
    }
    for i in 0..robots.len() {
        let robot = &mut robots[i];
        let (ux, uy) = rays(after.cosine[i], after.sine[i]);
        let lit = light_scan(floor, stream_of(robot), robot.x, robot.y, &ux, &uy, robot.noise);
        robot.sensed.light_bumpers = lit | robot.bumpers << BUMPERS_FROM;
        robot.sensed.compass = after.shown[i];
        robot.step += 1;
    }
}

/// Turns every robot and its compass. A robot without an action stays as it is.
#[inline(always)]
fn turn(before: &Before, after: &mut After) {
    for i in 0..ABREAST {
        let kind = before.kind[i];
        let slip = before.actuator[i] * noise(kind, before.slip[0][i], before.slip[1][i]) + 1.0;
        let wanted = heading_after(before.heading[i], before.action[i], slip);
        let heading = if before.action[i] == NO_ACTION { before.heading[i] } else { wanted };
        (after.sine[i], after.cosine[i]) = sin_cos(heading);
        let error = noise(kind, before.error[0][i], before.error[1][i]);
        after.shown[i] = compass_reading(heading, error, before.compass[i]);
        after.heading[i] = heading;
        after.slip[i] = slip;
    }
}

#[inline(always)]
fn stream_of(robot: &Robot) -> Stream {
    Stream {
        key: [robot.run_seed, robot.robot_seed],
        skill: 0,
        trial: 0,
        step: robot.step,
        purpose: Purpose::Given as u32,
    }
}
