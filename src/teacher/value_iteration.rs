//! Value iteration on a grid of poses, for a skill's own reward under the actuator noise.
//!
//! The grid is 5 in x 5 in x 15 degrees. Actuator noise enters by a three-point quadrature; between grid
//! poses values are interpolated, over the poses that a robot can take.

use super::slip::{SLIPS, slips};
use crate::backend::cpu::lanes::contact::body_after;
use crate::backend::cpu::lanes::draws::place_of;
use crate::backend::cpu::lanes::sonar::{ranges, rays};
use crate::config::plan::{Action, Event, Noise, SkillPlan};
use crate::env::events::NOWHERE;
use crate::env::motion::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, PASSED_DOOR};
use crate::env::sonar::sonar_reading;
use crate::env::workgroup::CohortData;
use crate::layout::{Observation, RAYS};
use crate::math::functions::sin_cos;
use crate::world::{Pose, World};
use bytemuck::Zeroable;
use glam::Vec2;
use rayon::prelude::*;

/// Distance of grid points, inches. Ours; tests plan with others, at which moves end on grid points.
pub const PITCH: f32 = 5.0;
/// Headings of the grid.
const HEADINGS: usize = 24;
/// Degrees between them.
const HEADING_STEP: f32 = 15.0;
/// Sweeps stop when no value changes by more than this share of the largest reward.
const TOLERANCE: f32 = 1.0e-5;
/// A move that gets less far than this, inches, gets nowhere.
const STUCK: f32 = 0.5;
/// More sweeps than any discount below 1 needs for [`TOLERANCE`] in worlds of this size.
const MOST_SWEEPS: usize = 2_000;

/// The solved task: how good every pose is, and what to do there.
#[derive(Debug, Clone)]
pub struct Planner {
    pitch: f32,
    columns: usize,
    rows: usize,
    free: Vec<bool>,
    /// Values by room of origin; one entry where the room does not matter.
    values: Vec<Vec<f32>>,
    children: Vec<Action>,
    reward: [f32; Event::ALL.len()],
    ends: u32,
    /// Least and greatest reading beside a wall, where the skill pays for it.
    beside: Option<(u32, u32)>,
    discount: f32,
    backward_cost: f32,
    collision_cost: f32,
    slips: [(f32, f32); SLIPS],
}

/// What a planner plans with, besides the skill.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Terms {
    /// Noise of the actuators.
    #[serde(serialize_with = "crate::config::plan::as_bytes")]
    pub noise: Noise,
    /// Least and greatest reading beside a wall, whole inches.
    pub beside: (u32, u32),
    /// The teacher's own discount factor.
    pub discount: f32,
    /// Cost of backing up, in reward units: keeps it from backing up where turning serves as well.
    pub backward_cost: f32,
    /// Cost of collisions besides the skill's own, in reward units.
    pub collision_cost: f32,
    /// Distance of grid points, inches.
    pub pitch: f32,
}

/// What one action does from one pose under one slip of the actuators.
#[derive(Debug, Clone, Copy)]
struct Outcome {
    pose: Pose,
    reward: f32,
    ended: bool,
}

impl Planner {
    /// Plans a skill. For one over skills it plans over all actions: the bound of every tree below it.
    pub fn new(world: &World, shared: &CohortData, skill: &SkillPlan, terms: &Terms) -> Self {
        let Terms { noise, beside, discount, backward_cost, collision_cost, pitch } = *terms;
        let columns = (world.size.x / pitch) as usize + 1;
        let rows = (world.size.y / pitch) as usize + 1;
        let free = (0..columns * rows)
            .map(|i| world.is_free(Vec2::new((i % columns) as f32 * pitch, (i / columns) as f32 * pitch)))
            .collect();
        let origins = if skill.goal & PASSED_DOOR == 0 && skill.params.reward[Event::PassedDoor as usize] == 0.0 {
            1
        } else {
            world.rooms.len()
        };
        let mut planner = Self {
            pitch,
            columns,
            rows,
            free,
            values: Vec::new(),
            children: skill.actions(),
            reward: skill.params.reward,
            ends: skill.goal,
            beside: pays_beside(skill).then_some(beside),
            discount,
            backward_cost,
            collision_cost,
            slips: slips(&noise),
        };
        planner.values = (0..origins).map(|origin| planner.solve(shared, origin as u32)).collect();
        planner
    }

    /// Value of a pose, in reward units, for a trial that began in room `origin`.
    pub fn value(&self, origin: u32, pose: Pose) -> f32 {
        self.interpolate(&self.values[self.origin_index(origin)], pose)
    }

    /// Position in the skill's children of the best one at a pose, for a trial that began in room `origin`.
    pub fn choose(&self, shared: &CohortData, origin: u32, pose: Pose) -> usize {
        let mut best = (0, f32::NEG_INFINITY);
        for (child, action) in self.children.iter().enumerate() {
            let worth = self.worth(shared, origin, pose, *action);
            if worth > best.1 && !self.stuck(shared, origin, pose, *action) {
                best = (child, worth);
            }
        }
        best.0
    }

    /// Whether a move is blocked at once and ends nothing. Between grid poses the value of staying may come out above
    /// that of turning away, and the robot would push for ever.
    fn stuck(&self, shared: &CohortData, origin: u32, pose: Pose, action: Action) -> bool {
        let outcome = self.outcome(shared, origin, pose, action, 1.0);
        let way = Vec2::new(outcome.pose.x - pose.x, outcome.pose.y - pose.y);
        action.travel() != 0.0 && !outcome.ended && way.length() < STUCK
    }

    /// Expected return of an action at a pose and of the best ones after it.
    pub fn worth(&self, shared: &CohortData, origin: u32, pose: Pose, action: Action) -> f32 {
        let values = &self.values[self.origin_index(origin)];
        let cost = if action == Action::Backward { self.backward_cost } else { 0.0 };
        let expected: f32 = self
            .slips
            .iter()
            .map(|(slip, weight)| {
                let outcome = self.outcome(shared, origin, pose, action, *slip);
                let after = if outcome.ended { 0.0 } else { self.interpolate(values, outcome.pose) };
                weight * (outcome.reward + self.discount * after)
            })
            .sum();
        expected - cost
    }

    /// The words that stand in for a skill's nets (see [`crate::policy::planner_table`]): at every grid pose the best child
    /// and its value times `scale`. A pose that no robot can take has those of the nearest one that it can.
    pub fn table(&self, shared: &CohortData, scale: f32) -> Vec<u32> {
        let mut words =
            vec![self.columns as u32, self.rows as u32, self.values.len() as u32, (1.0 / self.pitch).to_bits()];
        for origin in 0..self.values.len() as u32 {
            let entries: Vec<[u32; HEADINGS]> = (0..self.free.len())
                .into_par_iter()
                .map(|point| {
                    let at = self.nearest_free(point);
                    let (x, y) = ((at % self.columns) as f32 * self.pitch, (at / self.columns) as f32 * self.pitch);
                    std::array::from_fn(|heading| {
                        let pose = Pose { x, y, heading: heading as f32 * HEADING_STEP };
                        let value = self.value(origin, pose) * scale;
                        (value.to_bits() & 0xffff_fff8) | self.choose(shared, origin, pose) as u32
                    })
                })
                .collect();
            words.extend(entries.as_flattened());
        }
        words
    }

    fn nearest_free(&self, point: usize) -> usize {
        let place = |point: usize| ((point % self.columns) as i64, (point / self.columns) as i64);
        let (x, y) = place(point);
        let distance = |other: &usize| {
            let (ox, oy) = place(*other);
            (ox - x) * (ox - x) + (oy - y) * (oy - y)
        };
        (0..self.free.len()).filter(|other| self.free[*other]).min_by_key(distance).unwrap_or(point)
    }

    fn origin_index(&self, origin: u32) -> usize {
        if (origin as usize) < self.values.len() { origin as usize } else { 0 }
    }

    fn outcome(&self, shared: &CohortData, origin: u32, pose: Pose, action: Action, slip: f32) -> Outcome {
        let moved = body_after(&shared.floor, pose.x, pose.y, pose.heading, action as u32, slip);
        let mut events = moved.events | shared.floor.plan.passed_door(origin, moved.x, moved.y);
        if let Some((near, far)) = self.beside
            && action == Action::Forward
        {
            let seen = noiseless_sonar(shared, moved.x, moved.y, moved.heading);
            events |= seen.following_wall(near, far, action as u32, events);
        }
        let paid: f32 = (0..Event::ALL.len()).filter(|i| (events >> i) & 1 == 1).map(|i| self.reward[i]).sum();
        let reward = if events & COLLISION == 0 { paid } else { paid - self.collision_cost };
        let pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
        Outcome { pose, reward, ended: events & self.ends != 0 }
    }

    /// Values of all grid poses for trials that began in room `origin`.
    fn solve(&self, shared: &CohortData, origin: u32) -> Vec<f32> {
        let moves: Vec<Action> = self.children.iter().copied().filter(|a| a.travel() != 0.0).collect();
        let turns: Vec<Action> = self.children.iter().copied().filter(|a| a.turn() != 0.0).collect();
        let points: Vec<usize> = (0..self.free.len()).filter(|point| self.free[*point]).collect();
        // A move keeps the heading, so its outcome blends at most four points of the same heading.
        let blends: Vec<Vec<Blend>> = points
            .par_iter()
            .map(|point| {
                let x = (point % self.columns) as f32 * self.pitch;
                let y = (point / self.columns) as f32 * self.pitch;
                let mut blends = Vec::with_capacity(HEADINGS * moves.len() * self.slips.len());
                for heading in 0..HEADINGS {
                    let pose = Pose { x, y, heading: heading as f32 * HEADING_STEP };
                    for action in &moves {
                        for (slip, _) in self.slips {
                            let outcome = self.outcome(shared, origin, pose, *action, slip);
                            blends.push(self.blend(&outcome));
                        }
                    }
                }
                blends
            })
            .collect();
        // A turn keeps the point, and takes each heading to the same place between headings everywhere.
        let turned: Vec<Between> = (0..HEADINGS)
            .flat_map(|heading| turns.iter().map(move |action| (heading, action)))
            .flat_map(|(heading, action)| {
                self.slips.map(|(slip, _)| Between::headings(heading as f32 + action.turn() * slip / HEADING_STEP))
            })
            .collect();
        let scale = self.reward.iter().fold(0.0_f32, |most, amount| most.max(amount.abs())).max(1.0e-6);
        let mut values = vec![0.0; self.free.len() * HEADINGS];
        let mut fresh = vec![[0.0; HEADINGS]; points.len()];
        for _sweep in 0..MOST_SWEEPS {
            fresh.par_iter_mut().zip(&points).zip(&blends).for_each(|((fresh, point), blends)| {
                for (heading, fresh) in fresh.iter_mut().enumerate() {
                    *fresh = self.backup(&values, *point, heading, &moves, blends, &turned);
                }
            });
            let mut change = 0.0_f32;
            for (point, fresh) in points.iter().zip(&fresh) {
                let old = &mut values[point * HEADINGS..(point + 1) * HEADINGS];
                for (old, fresh) in old.iter_mut().zip(fresh) {
                    change = change.max((*fresh - *old).abs());
                    *old = *fresh;
                }
            }
            if change < TOLERANCE * scale {
                break;
            }
        }
        values
    }

    fn backup(
        &self,
        values: &[f32],
        point: usize,
        heading: usize,
        moves: &[Action],
        blends: &[Blend],
        turned: &[Between],
    ) -> f32 {
        let mut best = f32::NEG_INFINITY;
        let per_heading = moves.len() * self.slips.len();
        for (number, action) in moves.iter().enumerate() {
            let first = heading * per_heading + number * self.slips.len();
            let mut worth = if *action == Action::Backward { -self.backward_cost } else { 0.0 };
            for (blend, (_, weight)) in blends[first..first + self.slips.len()].iter().zip(&self.slips) {
                let mut after = 0.0;
                for (neighbour, share) in blend.points.iter().zip(&blend.shares) {
                    after += share * values[*neighbour as usize * HEADINGS + heading];
                }
                worth += weight * (blend.reward + self.discount * after);
            }
            best = best.max(worth);
        }
        let own = &values[point * HEADINGS..(point + 1) * HEADINGS];
        let per_heading = turned.len() / HEADINGS;
        for slipped in turned[heading * per_heading..(heading + 1) * per_heading].as_chunks::<SLIPS>().0 {
            let mut worth = 0.0;
            for (between, (_, weight)) in slipped.iter().zip(&self.slips) {
                worth += weight * self.discount * between.of(own);
            }
            best = best.max(worth);
        }
        best
    }

    /// Where an outcome lies between the grid's points.
    fn blend(&self, outcome: &Outcome) -> Blend {
        let mut blend = Blend { points: [0; 4], shares: [0.0; 4], reward: outcome.reward };
        if !outcome.ended {
            for (slot, (point, share)) in self.corners(outcome.pose).into_iter().enumerate() {
                blend.points[slot] = point as u32;
                blend.shares[slot] = share;
            }
        }
        blend
    }

    /// The four grid points round a pose with their shares; points that no robot can take have none.
    fn corners(&self, pose: Pose) -> [(usize, f32); 4] {
        let column = ((pose.x / self.pitch) as usize).min(self.columns - 2);
        let row = ((pose.y / self.pitch) as usize).min(self.rows - 2);
        let dx = pose.x / self.pitch - column as f32;
        let dy = pose.y / self.pitch - row as f32;
        let first = row * self.columns + column;
        let mut corners = [
            (first, (1.0 - dx) * (1.0 - dy)),
            (first + 1, dx * (1.0 - dy)),
            (first + self.columns, (1.0 - dx) * dy),
            (first + self.columns + 1, dx * dy),
        ];
        let mut total = 0.0;
        for (point, share) in &mut corners {
            // A robot that touches a wall stands between points of which some lie too close to it.
            *share = if self.free[*point] { share.max(1.0e-6) } else { 0.0 };
            total += *share;
        }
        if total > 0.0 {
            for (_, share) in &mut corners {
                *share /= total;
            }
        }
        corners
    }

    fn interpolate(&self, values: &[f32], pose: Pose) -> f32 {
        let between = Between::headings(pose.heading / HEADING_STEP);
        self.corners(pose)
            .into_iter()
            .filter(|(_, share)| *share > 0.0)
            .map(|(point, share)| share * between.of(&values[point * HEADINGS..][..HEADINGS]))
            .sum()
    }
}

/// Grid points that an outcome blends, their shares, and its reward.
#[derive(Debug, Clone, Copy)]
struct Blend {
    points: [u32; 4],
    shares: [f32; 4],
    reward: f32,
}

/// A place between two of a grid point's headings.
#[derive(Debug, Clone, Copy)]
struct Between {
    first: usize,
    second: usize,
    /// Share of the second.
    part: f32,
}

impl Between {
    /// `turn` counts headings and may lie beyond them.
    fn headings(turn: f32) -> Self {
        let low = turn.floor();
        let first = (low as i32).rem_euclid(HEADINGS as i32) as usize;
        Self { first, second: (first + 1) % HEADINGS, part: turn - low }
    }

    /// The blend of the values of a point's headings.
    fn of(self, values: &[f32]) -> f32 {
        values[self.first] * (1.0 - self.part) + values[self.second] * self.part
    }
}

fn pays_beside(skill: &SkillPlan) -> bool {
    let paid = |event: Event| skill.params.reward[event as usize] != 0.0;
    paid(Event::BesideRight) || paid(Event::BesideLeft) || skill.goal & (BESIDE_RIGHT | BESIDE_LEFT) != 0
}

/// What the sonar shows at a pose, without noise; the other sensors show nothing.
fn noiseless_sonar(shared: &CohortData, x: f32, y: f32, heading: f32) -> Observation {
    let (sine, cosine) = sin_cos(heading);
    let (ux, uy) = rays(cosine, sine);
    let range = ranges(&shared.floor, x, y, &ux, &uy);
    let mut seen = Observation::zeroed();
    for ray in 0..RAYS {
        seen.sonar[ray / 4] |= sonar_reading(range[place_of(ray)], 1.0) << (8 * (ray % 4));
    }
    seen
}

/// Room in which a trial that begins here begins.
pub fn origin_of(shared: &CohortData, pose: Pose) -> u32 {
    let room = shared.floor.plan.room_of(pose.x, pose.y);
    if room == NOWHERE { 0 } else { room }
}
