//! Robots under random actions, and the simulator's step as one would write it without lanes: one ray, one
//! segment at a time.
//!
//! The reference has the same formulas in the same order as the twins, so that results can be compared as bytes; the
//! loops are the other way round, and what cannot matter is skipped.

use super::BenchError;
use crate::backend::Backend;
use crate::config::plan::Plan;
use crate::env::contact::{BUMPER_GAP, RADIUS};
use crate::env::motion::{BACKWARD, COLLISION, DOCKED, FORWARD, turn_of};
use crate::env::observe::{DRAW_ACTUATOR, DRAW_COMPASS, DRAW_LIGHT};
use crate::env::sonar::{LINES, reading};
use crate::env::workgroup::CohortData;
use crate::layout::{Robot, Segment, WorldUniform};
use crate::math::functions::{exponential, reciprocal, reciprocal_sqrt, sin_cos, square_root, wrap_degrees};
use crate::math::rng::{Purpose, Stream, below, coarse_noise, draw, noise, philox};
use crate::train::observation::{floor_only, robot_at};
use crate::world::Pose;
use glam::Vec2;
use std::ops::Range;

/// Robots all over a floor, each under its own random actions.
#[derive(Debug, Clone)]
pub struct Walk {
    /// The floor and its segment lists.
    pub shared: CohortData,
    /// The robots, before their next action.
    pub robots: Vec<Robot>,
}

impl Walk {
    /// `count` robots in free space of the plan's world, with the noise of its first arm.
    pub fn new(plan: &Plan, count: u32) -> Self {
        let (world, noise) = (plan.world(), &plan.arms[0].noise);
        let part = |word: u32| (word >> 8) as f32 / 16_777_216.0;
        let poses = (0..u32::MAX).map(|number| philox([number, 0, 0, 0], [1, 1])).map(|words| Pose {
            x: part(words[0]) * world.size.x,
            y: part(words[1]) * world.size.y,
            heading: part(words[2]) * 360.0,
        });
        let free = poses.filter(|pose| world.is_free(Vec2::new(pose.x, pose.y)));
        let robots = (0..count).zip(free).map(|(number, pose)| robot_at(pose, noise, plan.run_seed, number)).collect();
        Self { shared: floor_only(world), robots }
    }

    /// Codes of the robots' actions in some rounds, round by round: any of the six.
    pub fn actions(&self, rounds: Range<u32>) -> Vec<Vec<u32>> {
        let action = |number, round| below(philox([number, round, 0, 0], [2, 2])[0], 6);
        rounds.map(|round| (0..self.robots.len() as u32).map(|number| action(number, round)).collect()).collect()
    }

    /// Every robot carries out its `actions`, each of them `times` times, on a backend.
    ///
    /// # Errors
    /// Where the backend fails.
    pub fn advance(&mut self, backend: &mut dyn Backend, actions: &[Vec<u32>], times: u32) -> Result<(), BenchError> {
        for round in actions {
            for (robot, action) in self.robots.iter_mut().zip(round) {
                (robot.action, robot.events) = (*action, 0);
            }
            backend.step(&self.shared, &mut self.robots, times)?;
        }
        Ok(())
    }

    /// The same by the scalar reference.
    pub fn advance_scalar(&mut self, actions: &[Vec<u32>], times: u32) {
        for round in actions {
            for (robot, action) in self.robots.iter_mut().zip(round) {
                robot.action = *action;
                for _time in 0..times {
                    step(robot, &self.shared.floor.plan, &self.shared.tables);
                }
            }
        }
    }

    /// All that the robots hold, word by word.
    pub fn words(&self) -> &[u32] {
        bytemuck::cast_slice(&self.robots)
    }
}

/// The noise of a robot's next step, as the reference and the twins draw it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepNoise {
    /// Factor on the length of the turn or travel.
    pub slip: f32,
    /// Factor on the range of each ray.
    pub sonar: [f32; 24],
    /// Factor on the brightness on each bearing.
    pub light: [f32; 24],
    /// Degrees added to the compass.
    pub compass: f32,
}

impl StepNoise {
    /// The noise of the step that `robot` takes next.
    pub fn next(robot: &Robot) -> Self {
        let stream = stream_of(robot);
        let apart = |number: usize| {
            let [x, y, ..] = draw(stream, number as u32);
            noise(robot.noise.kind, x, y)
        };
        let shared = |first: u32, bearing: usize| coarse_noise(robot.noise.kind, bearing_word(stream, first, bearing));
        Self {
            slip: robot.noise.actuator * apart(DRAW_ACTUATOR) + 1.0,
            sonar: std::array::from_fn(|ray| robot.noise.sonar * shared(0, ray) + 1.0),
            light: std::array::from_fn(|ray| robot.noise.light * shared(DRAW_LIGHT, ray) + 1.0),
            compass: robot.noise.compass * apart(DRAW_COMPASS),
        }
    }
}

/// The word of a bearing: six draws from number `first` on have a word for each of 24.
fn bearing_word(stream: Stream, first: u32, bearing: usize) -> u32 {
    draw(stream, first + bearing as u32 % 6)[bearing / 6]
}

fn stream_of(robot: &Robot) -> Stream {
    Stream {
        key: [robot.run_seed, robot.robot_seed],
        skill: 0,
        trial: 0,
        step: robot.step,
        purpose: Purpose::Given as u32,
    }
}

/// The farthest that contact is looked for, inches.
const FAR: f32 = 1.0e6;

/// One robot carries out its action and senses.
pub fn step(robot: &mut Robot, world: &WorldUniform, tables: &[u32]) {
    let stream = stream_of(robot);
    let slip_words = draw(stream, DRAW_ACTUATOR as u32);
    let slip = robot.noise.actuator * noise(robot.noise.kind, slip_words[0], slip_words[1]) + 1.0;
    act(robot, world, slip);
    sense(robot, world, tables, stream);
    robot.step += 1;
}

fn act(robot: &mut Robot, world: &WorldUniform, slip: f32) {
    robot.heading = wrap_degrees(robot.heading + turn_of(robot.action) * slip);
    robot.events = 0;
    let (sine, cosine) = sin_cos(robot.heading);
    let segments = &world.segment[..world.segments as usize];
    if robot.action == FORWARD || robot.action == BACKWARD {
        let sign = if robot.action == FORWARD { 1.0 } else { -1.0 };
        let (ux, uy) = (sign * cosine, sign * sine);
        let reach = (12.0 * slip).max(0.0);
        let (mut nearest, mut plugged) = (FAR, false);
        for segment in segments {
            let (distance, aim) = contact(segment, robot.x, robot.y, ux, uy);
            let plug = segment.charger == 1 && aim >= world.dock_cosine;
            if distance < nearest {
                (nearest, plugged) = (distance, plug);
            } else if distance == nearest {
                plugged |= plug;
            }
        }
        let blocked = nearest < reach;
        let travel = if blocked { nearest } else { reach };
        robot.x += ux * travel;
        robot.y += uy * travel;
        robot.events = match (blocked, plugged && robot.action == FORWARD) {
            (true, true) => DOCKED,
            (true, false) => COLLISION,
            (false, _) => 0,
        };
    }
    robot.bumpers = 0;
    for segment in segments {
        let (wx, wy) = (robot.x - segment.ax, robot.y - segment.ay);
        let along = (segment.tx * wx + segment.ty * wy).max(0.0).min(segment.length);
        let (px, py) = (segment.tx * along - wx, segment.ty * along - wy);
        if px * px + py * py < (RADIUS + BUMPER_GAP) * (RADIUS + BUMPER_GAP) {
            let front = px * cosine + py * sine;
            let left = py * cosine - px * sine;
            robot.bumpers |= match (front.abs() >= left.abs(), front > 0.0, left > 0.0) {
                (true, true, _) => 1,
                (true, false, _) => 4,
                (false, _, true) => 2,
                (false, _, false) => 8,
            };
        }
    }
}

fn contact(segment: &Segment, x: f32, y: f32, ux: f32, uy: f32) -> (f32, f32) {
    let (wx, wy) = (x - segment.ax, y - segment.ay);
    let side = segment.tx * wy - segment.ty * wx;
    let drift = segment.tx * uy - segment.ty * ux;
    let closing = if side < 0.0 { drift } else { -drift };
    let (mut reach, mut aim) = (FAR, closing);
    if closing > 1.0e-7 {
        let gap = ((side.abs() - RADIUS) * reciprocal(closing)).max(0.0);
        let along = (segment.tx * wx + segment.ty * wy) + (segment.tx * ux + segment.ty * uy) * gap;
        if along >= 0.0 && along <= segment.length {
            reach = gap;
        }
    }
    for (ex, ey) in [(-wx, -wy), (segment.bx - x, segment.by - y)] {
        let ahead = ex * ux + ey * uy;
        let across = ex * uy - ey * ux;
        let chord = RADIUS * RADIUS - across * across;
        if chord > 0.0 && ahead > 0.0 {
            let back = square_root(chord);
            let gap = (ahead - back).max(0.0);
            if gap < reach {
                (reach, aim) = (gap, back * 0.083_333_336);
            }
        }
    }
    (reach, aim)
}

/// What rays need to know of a segment: its ends, and how close it is along x and y.
struct Heard {
    a: (f32, f32),
    b: (f32, f32),
    slope: (f32, f32),
}

impl Heard {
    fn new(segment: &Segment, x: f32, y: f32) -> Self {
        let (ax, ay) = (segment.ax - x, segment.ay - y);
        let (dx, dy) = (segment.bx - segment.ax, segment.by - segment.ay);
        let over = ax * dy - ay * dx;
        let inverse = reciprocal(over.abs().max(1.0e-4 * segment.length));
        let signed = if over < 0.0 { -inverse } else { inverse };
        Self { a: (ax, ay), b: (segment.bx - x, segment.by - y), slope: (dy * signed, dx * signed) }
    }
}

fn sense(robot: &mut Robot, world: &WorldUniform, tables: &[u32], stream: Stream) {
    let (x, y) = (robot.x, robot.y);
    let (sine, cosine) = sin_cos(robot.heading);
    let column = ((x * 0.083_333_336) as u32).min(world.cell_columns - 1);
    let row = ((y * 0.083_333_336) as u32).min(world.cell_rows - 1);
    let cell = (world.cell_starts + row * world.cell_columns + column) as usize;
    let near = &tables[tables[cell] as usize..tables[cell + 1] as usize];
    let near: Vec<Heard> = near.iter().map(|i| Heard::new(&world.segment[*i as usize], x, y)).collect();
    let (lx, ly) = (world.light_x - x, world.light_y - y);
    let distance2 = (lx * lx + ly * ly).max(1.0);
    let (nearness, falloff) = (reciprocal_sqrt(distance2), world.light_range2 * reciprocal(distance2));
    // No noise reaches 3.5.
    let reached = world.lit == 1 && falloff * (robot.noise.light * 3.5 + 1.0) > 1.0;
    let seen = reached && in_sight(world, x, y);
    let mut readings = [0_u32; 24];
    let mut lit = 0;
    for (ray, slot) in readings.iter_mut().enumerate() {
        // A ray and the opposite one are on one line.
        let (ray_sine, ray_cosine) = sin_cos((ray % LINES) as f32 * 15.0);
        let ux = cosine * ray_cosine - sine * ray_sine;
        let uy = sine * ray_cosine + cosine * ray_sine;
        let facing = if ray < LINES { 1.0 } else { -1.0 };
        let noise = coarse_noise(robot.noise.kind, bearing_word(stream, 0, ray));
        *slot = reading(cast(&near, ux, uy, facing), robot.noise.sonar * noise + 1.0);
        if seen {
            let aim = facing * ((ux * lx + uy * ly) * nearness);
            let bright = falloff * exponential(14.590_25 * (aim - 1.0));
            let noise = coarse_noise(robot.noise.kind, bearing_word(stream, DRAW_LIGHT, ray));
            lit |= u32::from(bright * (robot.noise.light * noise + 1.0) > 1.0) << ray;
        }
    }
    for (word, four) in readings.as_chunks::<4>().0.iter().enumerate() {
        robot.record[word] = four[0] | four[1] << 8 | four[2] << 16 | four[3] << 24;
    }
    robot.record[6] = lit | robot.bumpers << 24;
    let words = draw(stream, DRAW_COMPASS as u32);
    let error = noise(robot.noise.kind, words[0], words[1]);
    robot.record[7] = wrap_degrees(robot.heading + robot.noise.compass * error).to_bits();
}

/// Distance to the nearest segment along a line, ahead (`facing` 1) or behind (-1).
fn cast(near: &[Heard], ux: f32, uy: f32, facing: f32) -> f32 {
    let mut closest = 0.007_874_016;
    for Heard { a, b, slope } in near {
        if (a.0 * uy > a.1 * ux) != (b.0 * uy > b.1 * ux) {
            closest = (facing * (ux * slope.0 - uy * slope.1)).max(closest);
        }
    }
    reciprocal(closest)
}

fn in_sight(world: &WorldUniform, x: f32, y: f32) -> bool {
    let (lx, ly) = (world.light_x - x, world.light_y - y);
    !world.segment[..world.segments as usize].iter().any(|segment| {
        let (ax, ay) = (segment.ax - x, segment.ay - y);
        let (bx, by) = (segment.bx - x, segment.by - y);
        let crosses = (ax * ly - ay * lx > 0.0) != (bx * ly - by * lx > 0.0);
        let (dx, dy) = (segment.bx - segment.ax, segment.by - segment.ay);
        let over = ax * dy - ay * dx;
        let under = lx * dy - ly * dx;
        let over = if under < 0.0 { -over } else { over };
        segment.charger == 0 && crosses && over >= 0.0 && over < under.abs()
    })
}
