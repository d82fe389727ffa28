//! A small piece of work that touches every kernel: done on two backends, it must leave the same bytes.

use super::batch_group::{BatchGroup, LearnerId, SetupError, groups};
use super::observation::{floor_only, robot_at};
use crate::backend::UNWRITTEN;
use crate::backend::parity::{self, Difference};
use crate::backend::{Backend, BackendError, Cohort, Stop, Test};
use crate::config::plan::Plan;
use crate::env::workgroup::CohortData;
use crate::layout::choices::{NOISE_GAUSSIAN, NOISE_UNIFORM};
use crate::layout::{Action, Episode, Noise, Observation, Robot};
use crate::math::rng::philox;
use crate::world::Pose;
use glam::Vec2;

/// Training trials of each skill at most.
const TRIALS: u32 = 3;
/// Trials of each test.
const EPISODES: u32 = 7;
/// Robots under random actions.
const ROBOTS: u32 = 512;
/// Actions of each.
const ACTIONS: u32 = 50;

/// The work: learners to train, robots to move.
#[derive(Debug)]
pub struct Work {
    cohorts: Vec<Cohort>,
    floor: CohortData,
    robots: Vec<Robot>,
}

/// What a backend leaves of the work.
#[derive(Debug, Clone, Default)]
pub struct Sample {
    cohorts: Vec<Cohort>,
    tests: Vec<Vec<Episode>>,
    robots: Vec<Vec<Robot>>,
}

/// Cuts an experiment down to a few trials of a few seeds, so that `learners` of its learners take seconds.
fn cut(plan: &Plan, learners: usize) -> Plan {
    let mut plan = plan.clone();
    plan.seeds = (0..learners.div_ceil(plan.arms.len()) as u32).collect();
    let lessons = plan.arms.iter().flat_map(|arm| &arm.skills).map(|skill| skill.params.lessons).max();
    for arm in &mut plan.arms {
        arm.teacher.eval_episodes = 1;
        arm.teacher.lessons = arm.teacher.lessons.min(lessons.unwrap_or(0).max(16));
    }
    for skill in plan.arms.iter_mut().flat_map(|arm| &mut arm.skills) {
        skill.params.trials = skill.params.trials.min(TRIALS);
        let learning = &mut skill.params;
        learning.replays = learning.replays.min(4);
        learning.pretrain_epochs = learning.pretrain_epochs.min(1);
        // The last trial takes the place of the first.
        learning.replay_capacity = learning.replay_capacity.min(TRIALS - 1);
    }
    plan
}

/// Robots all over the world, every other one with flat noise.
fn robots(plan: &Plan) -> Vec<Robot> {
    let noise = plan.arms[0].noise;
    let words = (0..u32::MAX).map(|number| philox([number, 0, 0, 0], [11, 22]));
    let poses = words.map(|words| Pose {
        x: (words[0] >> 8) as f32 / 16_777_216.0 * plan.world().size.x,
        y: (words[1] >> 8) as f32 / 16_777_216.0 * plan.world().size.y,
        heading: (words[2] % 360) as f32,
    });
    let free = poses.filter(|pose| plan.world().is_free(Vec2::new(pose.x, pose.y)));
    (0..ROBOTS)
        .zip(free)
        .map(|(number, pose)| {
            let robot = robot_at(pose, &noise, plan.run_seed, number);
            let kind = [NOISE_GAUSSIAN, NOISE_UNIFORM][number as usize % 2];
            Robot { noise: Noise { kind, ..robot.noise }, ..robot }
        })
        .collect()
}

impl Work {
    /// Work cut from an experiment: `learners` of its learners, arms in turn, for a few trials.
    pub fn new(plan: &Plan, learners: usize) -> Result<Self, SetupError> {
        let plan = cut(plan, learners);
        let groups = groups(&plan)?;
        let mut ids: Vec<LearnerId> = groups.iter().flat_map(|group| group.learners(&plan)).collect();
        ids.sort_by_key(|id| (id.seed, id.arm));
        ids.truncate(learners);
        let cohort = |group: &BatchGroup| {
            let own: Vec<LearnerId> = ids.iter().copied().filter(|id| group.arms.contains(&id.arm)).collect();
            let mut cohort = group.cohort(&plan, &own);
            cohort.lessons.fill(UNWRITTEN);
            cohort.rows.fill(UNWRITTEN);
            cohort
        };
        let mut cohorts: Vec<Cohort> = groups.iter().map(cohort).collect();
        cohorts.retain(|cohort| !cohort.states.is_empty());
        Ok(Self { cohorts, floor: floor_only(plan.world()), robots: robots(&plan) })
    }

    /// Memory of the learners before their first iteration, one cohort per group of arms.
    pub fn cohorts(&self) -> &[Cohort] {
        &self.cohorts
    }

    /// All of the work.
    pub fn run(&self, backend: &mut dyn Backend) -> Result<Sample, BackendError> {
        let mut sample = self.walk(backend)?;
        for cohort in &self.cohorts {
            let Sample { cohorts, tests, .. } = train(cohort.clone(), backend)?;
            sample.cohorts.extend(cohorts);
            sample.tests.extend(tests);
        }
        Ok(sample)
    }

    /// The robots' part: kernel `step` alone.
    pub fn walk(&self, backend: &mut dyn Backend) -> Result<Sample, BackendError> {
        let mut sample = Sample::default();
        let mut robots = self.robots.clone();
        for step in 0..ACTIONS {
            for (number, robot) in robots.iter_mut().enumerate() {
                robot.action = philox([number as u32, step, 1, 0], [33, 44])[0] % Action::ALL.len() as u32;
                robot.events = UNWRITTEN;
                robot.sensed = bytemuck::cast([UNWRITTEN; size_of::<Observation>() / 4]);
            }
            backend.step(&self.floor, &mut robots, 1 + step % 2)?;
            sample.robots.push(robots.clone());
        }
        Ok(sample)
    }
}

/// Trains a cohort to its end, with a test before, within and after the training of each skill.
pub fn train(cohort: Cohort, backend: &mut dyn Backend) -> Result<Sample, BackendError> {
    let mut sample = Sample::default();
    let trials: Vec<u32> = (0..cohort.skills)
        .map(|skill| cohort.params.iter().skip(skill).step_by(cohort.skills).map(|own| own.trials).max())
        .map(|most| most.unwrap_or(0))
        .collect();
    backend.load(cohort)?;
    let reach = |backend: &mut dyn Backend, stop: Stop| -> Result<(), BackendError> {
        while !backend.advance(stop)?.iter().all(|state| stop.holds(state)) {}
        Ok(())
    };
    for (skill, most) in (0..).zip(trials) {
        for trial in [0, most / 2, most] {
            reach(backend, Stop { skill, trial })?;
            sample.tests.push(backend.evaluate(Test { skill, number: trial, episodes: EPISODES })?);
        }
    }
    reach(backend, Stop { skill: u32::MAX, trial: u32::MAX })?;
    sample.cohorts.push(backend.memory()?.clone());
    Ok(sample)
}

impl Sample {
    /// The learners' memory after training, one cohort per group of arms.
    pub fn cohorts(&self) -> &[Cohort] {
        &self.cohorts
    }

    /// The robots after each action.
    pub fn robots(&self) -> &[Vec<Robot>] {
        &self.robots
    }

    /// The first difference from another backend's sample of the same work: robots first, since learners
    /// build upon them; then training; tests last, since they follow from the nets.
    pub fn difference(&self, other: &Self) -> Option<Difference> {
        let episodes = EPISODES as usize;
        let robots = || pairs("step", "action", &self.robots, &other.robots, |a, b| parity::step(a, b));
        let cohorts = || pairs("train", "cohort", &self.cohorts, &other.cohorts, parity::advance);
        let test = |a: &Vec<_>, b: &Vec<_>| parity::evaluate(a, b, episodes);
        let tests = || pairs("evaluate", "test", &self.tests, &other.tests, test);
        robots().or_else(cohorts).or_else(tests)
    }

    /// Bytes that [`Sample::difference`] compares.
    pub fn bytes(&self) -> usize {
        let cohort = |cohort: &Cohort| {
            size_of_val(&cohort.states[..]) + 4 * (cohort.nets.len() + cohort.lessons.len() + cohort.rows.len())
        };
        self.cohorts.iter().map(cohort).sum::<usize>()
            + self.tests.iter().map(|test| size_of_val(&test[..])).sum::<usize>()
            + self.robots.iter().map(|robots| size_of_val(&robots[..])).sum::<usize>()
    }
}

/// The first difference in two lists of results of one kernel.
fn pairs<T>(
    kernel: &'static str,
    what: &str,
    left: &[T],
    right: &[T],
    difference: impl Fn(&T, &T) -> Option<Difference>,
) -> Option<Difference> {
    let found = left.iter().zip(right).enumerate().find_map(|(number, (one, other))| {
        let found = difference(one, other)?;
        let field = match left.len() {
            1 => found.field,
            count => format!("{}, in {what} {} of {count}", found.field, number + 1),
        };
        Some(Difference { field, ..found })
    });
    found.or_else(|| parity::sizes(kernel, 0, &format!("{what}s"), left.len(), right.len()))
}
