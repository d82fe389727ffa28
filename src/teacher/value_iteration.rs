//! Value iteration on a grid of poses, for a skill's own reward under the actuator noise.
//!
//! The grid is 5 in x 5 in x 15 degrees. Actuator noise enters by a three-point quadrature; between grid
//! poses values are interpolated, over the poses that a robot can take.

use super::grid::{Between, HEADING_STEP, HEADINGS, PoseGrid};
use super::slip::{SLIPS, slips};
use super::task::{Outcome, Task};
use crate::config::plan::{Action, Event, Noise, SkillPlan};
use crate::env::workgroup::CohortData;
use crate::world::{Pose, World};
use glam::Vec2;
use rayon::prelude::*;

/// Sweeps stop when no value changes by more than this share of the largest reward.
const TOLERANCE: f32 = 1.0e-5;
/// A move that gets less far than this, inches, gets nowhere.
const STUCK: f32 = 0.5;
/// Sweeps after which values are taken as they are: a discount of 0.994 reaches [`TOLERANCE`] before.
const MOST_SWEEPS: usize = 2_000;

/// The solved task: how good every pose is, and what to do there.
#[derive(Debug, Clone)]
pub struct Planner {
    grid: PoseGrid,
    task: Task,
    /// Values by room of origin; one entry where the room does not matter.
    values: Vec<Vec<f32>>,
    children: Vec<Action>,
    discount: f32,
    backward_cost: f32,
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

impl Planner {
    /// Plans a skill. For one over skills it plans over all actions: the bound of every tree below it.
    pub fn new(world: &World, shared: &CohortData, skill: &SkillPlan, terms: &Terms) -> Self {
        let Terms { noise, beside, discount, backward_cost, collision_cost, pitch } = *terms;
        let task = Task::new(world, skill, beside, collision_cost);
        let origins = if task.names(Event::PassedDoor) { world.rooms.len() } else { 1 };
        let mut planner = Self {
            grid: PoseGrid::new(world, pitch),
            task,
            values: Vec::new(),
            children: skill.actions(),
            discount,
            backward_cost,
            slips: slips(&noise),
        };
        // Rooms that do not depend on one another are solved apart, each to its own precision.
        let apart = if planner.task.goes_on_after_doors() { origins } else { 1 };
        let first = (0..origins).step_by(apart);
        planner.values = first.flat_map(|first| planner.solve(shared, first as u32, apart)).collect();
        planner
    }

    /// Value of a pose, in reward units; the next door counts from room `origin`.
    pub fn value(&self, origin: u32, pose: Pose) -> f32 {
        self.grid.interpolate(&self.values[self.origin_index(origin)], pose)
    }

    /// Position in the skill's children of the best one at a pose; the next door counts from room `origin`.
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
        let outcome = self.task.outcome(shared, origin, pose, action, 1.0);
        let way = Vec2::new(outcome.pose.x - pose.x, outcome.pose.y - pose.y);
        action.travel() != 0.0 && !outcome.ended && way.length() < STUCK
    }

    /// Expected return of an action at a pose and of the best ones after it.
    pub fn worth(&self, shared: &CohortData, origin: u32, pose: Pose, action: Action) -> f32 {
        let cost = if action == Action::Backward { self.backward_cost } else { 0.0 };
        let expected: f32 = self
            .slips
            .iter()
            .map(|(slip, weight)| {
                let outcome = self.task.outcome(shared, origin, pose, action, *slip);
                let values = &self.values[self.origin_index(outcome.origin)];
                let after = if outcome.ended { 0.0 } else { self.grid.interpolate(values, outcome.pose) };
                weight * (outcome.reward + self.discount * after)
            })
            .sum();
        expected - cost
    }

    /// The words that stand in for a skill's nets (see [`crate::policy::planner_table`]): at every grid pose the best child
    /// and its value times `scale`. A pose that no robot can take has those of the nearest one that it can.
    pub fn table(&self, shared: &CohortData, scale: f32) -> Vec<u32> {
        let PoseGrid { pitch, columns, rows, .. } = self.grid;
        let mut words = vec![columns as u32, rows as u32, self.values.len() as u32, (1.0 / pitch).to_bits()];
        for origin in 0..self.values.len() as u32 {
            let entries: Vec<[u32; HEADINGS]> = (0..self.grid.free.len())
                .into_par_iter()
                .map(|point| {
                    let at = self.grid.nearest_free(point);
                    std::array::from_fn(|heading| {
                        let pose = self.grid.pose(at, heading);
                        let value = self.value(origin, pose) * scale;
                        (value.to_bits() & 0xffff_fff8) | self.choose(shared, origin, pose) as u32
                    })
                })
                .collect();
            words.extend(entries.as_flattened());
        }
        words
    }

    fn origin_index(&self, origin: u32) -> usize {
        if (origin as usize) < self.values.len() { origin as usize } else { 0 }
    }

    /// Values of all grid poses, for each of these rooms from which the next door counts.
    fn solve(&self, shared: &CohortData, first: u32, origins: usize) -> Vec<Vec<f32>> {
        let points: Vec<usize> = (0..self.grid.free.len()).filter(|point| self.grid.free[*point]).collect();
        let of_origin = |origin: usize| self.successors(shared, first, first + origin as u32, &points);
        let successors: Vec<Successors> = (0..origins).map(of_origin).collect();
        let scale = self.task.reward.iter().fold(0.0_f32, |most, amount| most.max(amount.abs())).max(1.0e-6);
        let mut values = vec![vec![0.0; self.grid.free.len() * HEADINGS]; origins];
        let mut fresh = vec![vec![[0.0; HEADINGS]; points.len()]; origins];
        for _sweep in 0..MOST_SWEEPS {
            for ((fresh, values_there), successors) in fresh.iter_mut().zip(&values).zip(&successors) {
                fresh.par_iter_mut().enumerate().for_each(|(number, fresh)| {
                    let own = &values_there[points[number] * HEADINGS..][..HEADINGS];
                    for (heading, fresh) in fresh.iter_mut().enumerate() {
                        let moved = self.best_move(successors, &values, number, heading);
                        *fresh = moved.max(self.best_turn(successors, own, number, heading));
                    }
                });
            }
            let mut change = 0.0_f32;
            for (values, fresh) in values.iter_mut().zip(&fresh) {
                for (point, fresh) in points.iter().zip(fresh) {
                    let old = &mut values[point * HEADINGS..(point + 1) * HEADINGS];
                    for (old, fresh) in old.iter_mut().zip(fresh) {
                        change = change.max((*fresh - *old).abs());
                        *old = *fresh;
                    }
                }
            }
            if change < TOLERANCE * scale {
                break;
            }
        }
        values
    }

    /// What the actions lead to from every heading on these points, for room `origin` among those from `first` on.
    fn successors(&self, shared: &CohortData, first: u32, origin: u32, points: &[usize]) -> Successors {
        let moves: Vec<Action> = self.children.iter().copied().filter(|a| a.travel() != 0.0).collect();
        let turns: Vec<Action> = self.children.iter().copied().filter(|a| a.turn() != 0.0).collect();
        let outcomes = |actions: &[Action]| -> Vec<Vec<Outcome>> {
            let slipped = |action: &Action| self.slips.map(|(slip, _)| (*action, slip));
            let trials: Vec<(Action, f32)> = actions.iter().flat_map(slipped).collect();
            let of_pose = |pose: Pose| {
                trials.iter().map(move |(action, slip)| self.task.outcome(shared, origin, pose, *action, *slip))
            };
            let of_point = |point: &usize| {
                (0..HEADINGS).map(|heading| self.grid.pose(*point, heading)).flat_map(of_pose).collect()
            };
            points.par_iter().map(of_point).collect()
        };
        let blends = outcomes(&moves)
            .iter()
            .map(|outcomes| outcomes.iter().map(|outcome| self.blend(outcome, first)).collect())
            .collect();
        let turned = (0..HEADINGS)
            .flat_map(|heading| turns.iter().map(move |action| (heading, action)))
            .flat_map(|(heading, action)| {
                self.slips.map(|(slip, _)| Between::headings(heading as f32 + action.turn() * slip / HEADING_STEP))
            })
            .collect();
        let turn_outcomes = self.task.pays_turns().then(|| outcomes(&turns));
        Successors { moves, blends, turned, turn_outcomes }
    }

    fn best_move(&self, successors: &Successors, values: &[Vec<f32>], number: usize, heading: usize) -> f32 {
        let Successors { moves, blends, .. } = successors;
        let of_heading = blends[number].as_chunks::<SLIPS>().0[heading * moves.len()..].iter();
        let worth = |(action, blends): (&Action, &[Blend; SLIPS])| {
            let mut worth = if *action == Action::Backward { -self.backward_cost } else { 0.0 };
            for (blend, (_, weight)) in blends.iter().zip(&self.slips) {
                let (mut after, values) = (0.0, &values[blend.origin as usize]);
                for (neighbour, share) in blend.points.iter().zip(&blend.shares) {
                    after += share * values[*neighbour as usize * HEADINGS + heading];
                }
                worth += weight * (blend.reward + self.discount * after);
            }
            worth
        };
        moves.iter().zip(of_heading).map(worth).fold(f32::NEG_INFINITY, f32::max)
    }

    /// `own` are the values of the point's headings.
    fn best_turn(&self, successors: &Successors, own: &[f32], number: usize, heading: usize) -> f32 {
        let per_heading = successors.turned.len() / HEADINGS;
        let mut best = f32::NEG_INFINITY;
        for first in (heading * per_heading..(heading + 1) * per_heading).step_by(SLIPS) {
            let mut worth = 0.0;
            for (slip, (_, weight)) in self.slips.iter().enumerate() {
                let after = successors.turned[first + slip].of(own);
                worth += match &successors.turn_outcomes {
                    None => weight * self.discount * after,
                    Some(outcomes) => {
                        let Outcome { reward, ended, .. } = outcomes[number][first + slip];
                        weight * (reward + if ended { 0.0 } else { self.discount * after })
                    }
                };
            }
            best = best.max(worth);
        }
        best
    }

    /// Where an outcome lies between the grid's points.
    fn blend(&self, outcome: &Outcome, first: u32) -> Blend {
        let mut blend = Blend { points: [0; 4], shares: [0.0; 4], origin: 0, reward: outcome.reward };
        if !outcome.ended {
            blend.origin = outcome.origin - first;
            for (slot, (point, share)) in self.grid.corners(outcome.pose).into_iter().enumerate() {
                blend.points[slot] = point as u32;
                blend.shares[slot] = share;
            }
        }
        blend
    }
}

/// What the actions lead to, worked out once for all sweeps. Outcomes of a point go by heading, action and slip.
#[derive(Debug)]
struct Successors {
    moves: Vec<Action>,
    /// By number of the point. A move keeps the heading, so its outcome blends at most four points of the same heading.
    blends: Vec<Vec<Blend>>,
    /// A turn keeps the point, and takes each heading to the same place between headings everywhere.
    turned: Vec<Between>,
    /// By number of the point, where turns earn something.
    turn_outcomes: Option<Vec<Vec<Outcome>>>,
}

/// Grid points that an outcome blends, their shares, and its reward.
#[derive(Debug, Clone, Copy)]
struct Blend {
    points: [u32; 4],
    shares: [f32; 4],
    /// Index of the values that apply there.
    origin: u32,
    reward: f32,
}
