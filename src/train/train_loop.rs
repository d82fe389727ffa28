//! A cohort on its way up the tree of skills: to each test point in turn, and the tests there.
//!
//! What is done at a stretch is short, and after each stretch the callbacks may have all saved, or end it: what is saved is
//! the learners' memory and the tests that they have taken, and whoever goes on from there skips what lies behind.

use super::batch_group::{BatchGroup, LearnerId};
use super::callbacks::{Callbacks, Interrupted, Signal};
use super::checkpoint::CohortState;
use super::result::{LearnerResult, TestResult, by_room, world_of};
use crate::backend::{Backend, BackendError, Cohort, Stop, Test};
use crate::config::plan::Plan;
use crate::layout::{EPISODE_TERMINATED, Episode, LearnerState, PHASE_FAILED};
use crate::run_folder::Sums;
use glam::Vec2;
use std::collections::BTreeSet;
use std::ops::Range;
use std::time::{Duration, Instant};

/// Time that the tests of some learners may take before anybody can look at the clock.
const STRETCH: Duration = Duration::from_millis(400);

/// The learners of a backend's cohort, and what they leave so far.
pub(super) struct TrainLoop<'a> {
    pub(super) plan: &'a Plan,
    pub(super) group: &'a BatchGroup,
    pub(super) backend: &'a mut dyn Backend,
    pub(super) callbacks: &'a mut dyn Callbacks,
    pub(super) results: Vec<LearnerResult>,
    /// Learners that are tested at a stretch.
    stretch: usize,
}

impl<'a> TrainLoop<'a> {
    pub(super) fn new(
        plan: &'a Plan,
        group: &'a BatchGroup,
        backend: &'a mut dyn Backend,
        callbacks: &'a mut dyn Callbacks,
        results: Vec<LearnerResult>,
    ) -> Self {
        Self { plan, group, backend, callbacks, results, stretch: 1 }
    }

    /// Brings all learners through the trials of some skills, with every test on the way.
    pub(super) fn train(&mut self, skills: Range<usize>) -> Result<(), Interrupted> {
        let ids: Vec<LearnerId> = self.results.iter().map(|result| result.id).collect();
        for skill in skills {
            let own = |id: &LearnerId| &self.plan.arms[id.arm].skills[skill];
            let points: BTreeSet<u32> = ids.iter().flat_map(|id| own(id).test_points()).collect();
            for point in points {
                let states = self.reach(Stop { skill: skill as u32, trial: point })?;
                let test = Evaluation { skill: skill as u32, trials: point, variant: 0 };
                let wanted = |(id, state): (&LearnerId, &LearnerState)| {
                    state.phase != PHASE_FAILED && own(id).test_points().any(|own| own == point)
                };
                let wanted: Vec<bool> = ids.iter().zip(&states).map(wanted).collect();
                self.evaluate(&test, &wanted, &states, None)?;
            }
        }
        Ok(())
    }

    /// Moves all learners on until they hold at `stop`, and hands back where they stand.
    pub(super) fn reach(&mut self, stop: Stop) -> Result<Vec<LearnerState>, Interrupted> {
        let mut last = Vec::new();
        loop {
            let states = self.backend.advance(stop)?.to_vec();
            self.report(&states, None)?;
            if states.iter().all(|state| stop.holds(state)) {
                return Ok(states);
            }
            // Every stretch moves some learner; a device on which none moves has stopped computing.
            if states == last {
                let message = "the learners no longer move".to_owned();
                return Err(BackendError::Device { kernel: "advance", message }.into());
            }
            last = states;
        }
    }

    /// Tests the learners that are wanted and have not taken this test yet, some at a time.
    pub(super) fn evaluate(
        &mut self,
        evaluation: &Evaluation,
        wanted: &[bool],
        states: &[LearnerState],
        trained: Option<&Cohort>,
    ) -> Result<(), Interrupted> {
        let count = self.plan.evaluate.episodes as usize;
        let test = Test { skill: evaluation.skill, number: evaluation.trials, episodes: count as u32 };
        let mut first = 0;
        while let Some(next) =
            (first..wanted.len()).find(|index| wanted[*index] && !evaluation.took(&self.results[*index]))
        {
            if count == 0 {
                return Ok(());
            }
            let learners = next..(next + self.stretch).min(wanted.len());
            let begun = Instant::now();
            let episodes = self.backend.evaluate_some(test, learners.clone())?;
            let elapsed = begun.elapsed();
            for (index, own) in learners.clone().zip(episodes.chunks(count)) {
                if wanted[index] && !evaluation.took(&self.results[index]) {
                    let result = &mut self.results[index];
                    result.tests.push(evaluation.result(self.plan, result.id.arm, states[index].actions, own));
                }
            }
            if elapsed > STRETCH {
                self.stretch = (self.stretch / 2).max(1);
            } else if elapsed < STRETCH / 4 && learners.len() == self.stretch {
                self.stretch *= 2;
            }
            first = learners.end;
            self.report(states, trained)?;
        }
        Ok(())
    }

    /// Tells how far the learners are, and does what the answer is.
    fn report(&mut self, states: &[LearnerState], trained: Option<&Cohort>) -> Result<(), Interrupted> {
        let trials = self.results.iter().zip(states).map(|(own, state)| trials_of(self.plan, own.id, state)).sum();
        let signal = self.callbacks.progress(trials);
        if signal == Signal::Continue {
            return Ok(());
        }
        let cohort = match trained {
            Some(cohort) => cohort,
            None => self.backend.memory()?,
        };
        self.callbacks.save(CohortState::new(&self.results, cohort, trained.is_some()))?;
        if signal == Signal::Stop { Err(Interrupted::Stopped) } else { Ok(()) }
    }
}

/// A test that learners take.
pub(super) struct Evaluation {
    /// Index of the skill.
    pub(super) skill: u32,
    /// Trials of the skill before the test.
    pub(super) trials: u32,
    /// As in [`TestResult::variant`].
    pub(super) variant: u32,
}

impl Evaluation {
    fn took(&self, result: &LearnerResult) -> bool {
        let own = (self.skill, self.trials, self.variant);
        result.tests.iter().any(|test| (test.skill, test.trials, test.variant) == own)
    }

    fn result(&self, plan: &Plan, arm: usize, actions: u32, episodes: &[Episode]) -> TestResult {
        let trials = episodes.iter().map(|Episode { state, start_x, start_y, agent }| {
            let sums = Sums {
                episodes: 1,
                successes: u32::from(*state == EPISODE_TERMINATED),
                steps: agent.step,
                collisions: agent.collisions,
                reward: f64::from(agent.reward),
                returned: f64::from(agent.returned),
            };
            (Vec2::new(*start_x, *start_y), sums)
        });
        let rooms = world_of(plan, arm, self.variant).map_or_else(Vec::new, |world| by_room(world, trials));
        TestResult { skill: self.skill, trials: self.trials, actions, variant: self.variant, rooms }
    }
}

/// Trials that a learner has finished, over all skills.
fn trials_of(plan: &Plan, id: LearnerId, state: &LearnerState) -> u64 {
    let skills = &plan.arms[id.arm].skills;
    let before: u32 = skills.iter().take(state.skill as usize).map(|skill| skill.params.trials).sum();
    u64::from(before + state.trial)
}
