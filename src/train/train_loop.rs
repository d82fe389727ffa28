//! A cohort on its way up the tree of skills: to each test point in turn, and the tests there.
//!
//! What is done at a stretch is short, and after each stretch the [`Keeper`] may have all saved, or end it: what is saved
//! is the learners' memory and the tests that they have taken, and whoever goes on from there skips what lies behind.

use super::batch_group::{Group, LearnerId};
use super::result::{LearnerResult, RoomSums, TestResult};
use crate::backend::{Backend, BackendError, Cohort, Stop, Test};
use crate::config::plan::Plan;
use crate::kernels::evaluate::STATE_ACHIEVED;
use crate::layout::phase::PHASE_FAILED;
use crate::layout::{Episode, LearnerState};
use crate::run_folder::RecordError;
use crate::world::World;
use glam::Vec2;
use std::ops::Range;
use std::time::{Duration, Instant};

/// Time that the tests of some learners may take before anybody can look at the clock.
const STRETCH: Duration = Duration::from_millis(400);

/// What a cohort should do next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wish {
    /// Go on.
    GoOn,
    /// Have everything saved, and go on.
    Save,
    /// Have everything saved, and end.
    Stop,
}

/// A cohort as it is saved.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: &'a [LearnerResult],
    /// The learners' memory.
    pub cohort: &'a Cohort,
    /// Whether training is over, so that only tests under alterations are to come. Lessons and rows no longer count.
    pub trained: bool,
}

/// Looks after a cohort while it trains.
pub trait Keeper {
    /// Told how many trials all learners together have finished; says what to do next.
    fn look(&mut self, trials: u64) -> Wish;

    /// Saves what is needed to go on from here.
    ///
    /// # Errors
    /// Where it cannot be saved.
    fn save(&mut self, moment: &Moment<'_>) -> Result<(), RecordError>;
}

/// Lets the cohort train to its end.
impl Keeper for () {
    fn look(&mut self, _trials: u64) -> Wish {
        Wish::GoOn
    }

    fn save(&mut self, _moment: &Moment<'_>) -> Result<(), RecordError> {
        Ok(())
    }
}

/// Why a cohort has not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum Halt {
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// What was to be saved could not be.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// It was told to, and is saved.
    #[error("stopped and saved")]
    Stopped,
}

/// The learners of a backend's cohort, and what they leave so far.
pub(super) struct Climb<'a> {
    pub(super) plan: &'a Plan,
    pub(super) group: &'a Group,
    pub(super) backend: &'a mut dyn Backend,
    pub(super) keeper: &'a mut dyn Keeper,
    pub(super) results: Vec<LearnerResult>,
    /// Learners that are tested at a stretch.
    stretch: usize,
}

impl<'a> Climb<'a> {
    pub(super) fn new(
        plan: &'a Plan,
        group: &'a Group,
        backend: &'a mut dyn Backend,
        keeper: &'a mut dyn Keeper,
        results: Vec<LearnerResult>,
    ) -> Self {
        Self { plan, group, backend, keeper, results, stretch: 1 }
    }

    /// Brings all learners through the trials of some skills, with every test on the way.
    pub(super) fn climb(&mut self, skills: Range<usize>) -> Result<(), Halt> {
        let ids: Vec<LearnerId> = self.results.iter().map(|result| result.id).collect();
        let world = self.plan.world_of(&self.plan.arms[self.group.arms[0]]);
        for skill in skills {
            for point in test_points(self.plan, &ids, skill) {
                let states = self.reach(Stop { skill: skill as u32, trial: point })?;
                let taker = Taker { skill: skill as u32, trials: point, variant: 0, world };
                let wanted = |index: usize| {
                    states[index].phase != PHASE_FAILED && tested_at(self.plan, ids[index], skill, point)
                };
                let wanted: Vec<bool> = (0..ids.len()).map(wanted).collect();
                self.test(&taker, &wanted, &states, None)?;
            }
        }
        Ok(())
    }

    /// Moves all learners on until they hold at `stop`, and hands back where they stand.
    pub(super) fn reach(&mut self, stop: Stop) -> Result<Vec<LearnerState>, Halt> {
        let mut last = Vec::new();
        loop {
            let states = self.backend.advance(stop)?.to_vec();
            self.look(&states, None)?;
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
    pub(super) fn test(
        &mut self,
        taker: &Taker<'_>,
        wanted: &[bool],
        states: &[LearnerState],
        trained: Option<&Cohort>,
    ) -> Result<(), Halt> {
        let count = self.plan.evaluate.episodes as usize;
        let test = Test { skill: taker.skill, number: taker.trials, episodes: count as u32 };
        let mut first = 0;
        while let Some(next) = (first..wanted.len()).find(|index| wanted[*index] && !taker.took(&self.results[*index]))
        {
            if count == 0 {
                return Ok(());
            }
            let learners = next..(next + self.stretch).min(wanted.len());
            let begun = Instant::now();
            let episodes = self.backend.evaluate_some(test, learners.clone())?;
            let elapsed = begun.elapsed();
            for (index, own) in learners.clone().zip(episodes.chunks(count)) {
                if wanted[index] && !taker.took(&self.results[index]) {
                    self.results[index].tests.push(taker.result(states[index].actions, own));
                }
            }
            if elapsed > STRETCH {
                self.stretch = (self.stretch / 2).max(1);
            } else if elapsed < STRETCH / 4 && learners.len() == self.stretch {
                self.stretch *= 2;
            }
            first = learners.end;
            self.look(states, trained)?;
        }
        Ok(())
    }

    /// Asks the keeper, and does what it says.
    fn look(&mut self, states: &[LearnerState], trained: Option<&Cohort>) -> Result<(), Halt> {
        let trials = self.results.iter().zip(states).map(|(own, state)| trials_of(self.plan, own.id, state)).sum();
        let wish = self.keeper.look(trials);
        if wish == Wish::GoOn {
            return Ok(());
        }
        let cohort = match trained {
            Some(cohort) => cohort,
            None => self.backend.memory()?,
        };
        self.keeper.save(&Moment { results: &self.results, cohort, trained: trained.is_some() })?;
        if wish == Wish::Stop { Err(Halt::Stopped) } else { Ok(()) }
    }
}

/// A test that learners take.
pub(super) struct Taker<'a> {
    /// Index of the skill.
    pub(super) skill: u32,
    /// Trials of the skill before the test.
    pub(super) trials: u32,
    /// As in [`TestResult::variant`].
    pub(super) variant: u32,
    /// The floor plan whose rooms are counted.
    pub(super) world: &'a World,
}

impl Taker<'_> {
    fn took(&self, result: &LearnerResult) -> bool {
        let own = (self.skill, self.trials, self.variant);
        result.tests.iter().any(|test| (test.skill, test.trials, test.variant) == own)
    }

    fn result(&self, actions: u32, episodes: &[Episode]) -> TestResult {
        let rooms = sums(self.world, episodes);
        TestResult { skill: self.skill, trials: self.trials, actions, variant: self.variant, rooms }
    }
}

/// Numbers of trials after which some of the learners are tested in a skill, ascending.
fn test_points(plan: &Plan, learners: &[LearnerId], skill: usize) -> Vec<u32> {
    let mut points = Vec::new();
    for id in learners {
        let own = &plan.arms[id.arm].skills[skill];
        points.extend(own.eval_at.iter().copied().filter(|point| *point <= own.params.trials));
        points.push(own.params.trials);
    }
    points.sort_unstable();
    points.dedup();
    points
}

fn tested_at(plan: &Plan, id: LearnerId, skill: usize, point: u32) -> bool {
    let own = &plan.arms[id.arm].skills[skill];
    point == own.params.trials || (point < own.params.trials && own.eval_at.contains(&point))
}

/// Trials that a learner has finished, over all skills.
fn trials_of(plan: &Plan, id: LearnerId, state: &LearnerState) -> u64 {
    let skills = &plan.arms[id.arm].skills;
    let before: u32 = skills.iter().take(state.skill as usize).map(|skill| skill.params.trials).sum();
    u64::from(before + state.trial)
}

/// Sums of a learner's test trials by the room in which they began; one entry per room of the world.
fn sums(world: &World, episodes: &[Episode]) -> Vec<RoomSums> {
    let mut rooms = vec![RoomSums::default(); world.rooms.len() + 1];
    for episode in episodes {
        let start = Vec2::new(episode.start_x, episode.start_y);
        let agent = &episode.agent;
        rooms[world.room_of(start).unwrap_or(world.rooms.len())].add(&RoomSums {
            episodes: 1,
            successes: u32::from(episode.state == STATE_ACHIEVED),
            steps: agent.step,
            collisions: agent.collisions,
            reward: f64::from(agent.reward),
            returned: f64::from(agent.returned),
        });
    }
    rooms
}
