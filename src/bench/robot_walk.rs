//! Robots all over a floor, under random actions.

use super::BenchError;
use super::embedded_configs::{DOCKING, embedded_plan};
use crate::backend::{Backend, BackendError};
use crate::config::plan::Action;
use crate::env::workgroup::CohortData;
use crate::layout::Robot;
use crate::math::rng::{below, philox};
use crate::train::observation::{floor_only, robot_at};
use crate::world::Pose;
use glam::Vec2;
use std::ops::Range;

/// Robots, each under its own random actions.
#[derive(Debug, Clone)]
pub struct RobotWalk {
    /// The floor and its segment lists.
    pub shared: CohortData,
    /// The robots, before their next action.
    pub robots: Vec<Robot>,
}

impl RobotWalk {
    /// `count` robots in free space of the shipped office, with the shipped noise.
    ///
    /// # Errors
    /// Where the built-in config cannot be read.
    pub fn new(count: u32) -> Result<Self, BenchError> {
        let plan = embedded_plan(DOCKING, &["arms=[\"taught-adam\"]"], 1)?;
        let (world, noise) = (plan.world(), &plan.arms[0].noise);
        let part = |word: u32| (word >> 8) as f32 / 16_777_216.0;
        let poses = (0..u32::MAX).map(|number| philox([number, 0, 0, 0], [1, 1])).map(|words| Pose {
            x: part(words[0]) * world.size.x,
            y: part(words[1]) * world.size.y,
            heading: part(words[2]) * 360.0,
        });
        let free = poses.filter(|pose| world.is_free(Vec2::new(pose.x, pose.y)));
        let robots = (0..count).zip(free).map(|(number, pose)| robot_at(pose, noise, plan.run_seed, number)).collect();
        Ok(Self { shared: floor_only(world), robots })
    }

    /// Codes of the robots' actions in some rounds, round by round.
    pub fn actions(&self, rounds: Range<u32>) -> Vec<Vec<u32>> {
        let choices = Action::ALL.len() as u32;
        let action = |number, round| below(philox([number, round, 0, 0], [2, 2])[0], choices);
        rounds.map(|round| (0..self.robots.len() as u32).map(|number| action(number, round)).collect()).collect()
    }

    /// Every robot carries out its `actions`, each of them `times` times.
    ///
    /// # Errors
    /// Where the backend fails.
    pub fn advance(&mut self, backend: &mut dyn Backend, actions: &[Vec<u32>], times: u32) -> Result<(), BackendError> {
        for round in actions {
            for (robot, action) in self.robots.iter_mut().zip(round) {
                (robot.action, robot.events) = (*action, 0);
            }
            backend.step(&self.shared, &mut self.robots, times)?;
        }
        Ok(())
    }

    /// All that the robots hold, word by word.
    pub fn words(&self) -> &[u32] {
        bytemuck::cast_slice(&self.robots)
    }
}
