//! What a run will take, told before it begins: memory, disk, and time.
//!
//! Time is work over speed. Work is counted in units of one row of 32 weights: an acting step takes those of all nets
//! that are asked, a replayed transition those of all nets of the skill and, four times, those of the one that is
//! changed. How long trials will be is not known, so shares of `max_steps` stand for it, taken from runs of the paper's
//! experiments. Speed is measured: some learners of the experiment train for a moment, and the work that they did,
//! counted in the same units, is divided by the time.

use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::schedule::Wave;
use crate::backend::{Backend, BackendError, Stop};
use crate::config::plan::{Plan, SkillPlan};
use crate::layout::choices::BACKUP_DECISIONS;
use crate::layout::{LearnerState, SkillShape, TRIAL_WORDS};
use std::time::{Duration, Instant};

/// Mean length of a trial that ends when its goal is achieved, as a share of `max_steps`: 0.4 to 0.7 in our runs.
const LENGTH: f64 = 0.55;
/// Share of replayed transitions that are learned: of a skill whose every step counts, and of one that learns at
/// decisions. 0.5 to 0.8, and 0.2, in our runs.
const LEARNED: [f64; 2] = [0.8, 0.2];
/// Work of a step beside the nets: motion, sonar, light.
const STEP: f64 = 100.0;
/// Rows that are read and written for the net that changes: weights, gradient, and the optimiser's two.
const BACKWARD: f64 = 4.0;
/// Bytes of a row of `trials.parquet` and of `evaluations.parquet`, compressed, as measured.
const ROW_BYTES: [u64; 2] = [8, 16];
/// Bytes of the header of a file with nets, and of each net in it.
const NET_BYTES: [u64; 2] = [500, 400];
/// Learners whose training is timed.
const TIMED: usize = 4096;

/// What a run will take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// Learners.
    pub learners: usize,
    /// Learners that train everything below the roots, once for all arms that share it.
    pub pretrained: usize,
    /// Cohorts, those that are pretrained among them.
    pub cohorts: usize,
    /// Learners of the largest cohort.
    pub largest: usize,
    /// Most bytes that a learner takes while it trains.
    pub bytes_per_learner: usize,
    /// Most bytes that a cohort takes.
    pub cohort_bytes: u64,
    /// Bytes of the tables and nets, without the report.
    pub disk: u64,
    /// Work of all of it.
    work: f64,
}

/// Counts what the waves of a run will take.
pub fn forecast(plan: &Plan, groups: &[BatchGroup], waves: &[Wave]) -> Forecast {
    let mut forecast = Forecast {
        learners: 0,
        pretrained: 0,
        cohorts: 0,
        largest: 0,
        bytes_per_learner: 0,
        cohort_bytes: 0,
        disk: 0,
        work: 0.0,
    };
    for wave in waves {
        let pretrained = wave.pretraining.iter().map(|(arm, seeds)| (*arm, seeds.len()));
        for (arm, learners) in pretrained {
            forecast.add(group_of(groups, arm), learners);
            forecast.pretrained += learners;
            let below = plan.arms[arm].skills.len() - 1;
            forecast.work += learners as f64 * work_of(plan, groups, arm, 0..below);
        }
        for ids in &wave.cohorts {
            forecast.add(group_of(groups, ids[0].arm), ids.len());
            forecast.learners += ids.len();
            for run in ids.chunk_by(|a, b| a.arm == b.arm) {
                let (arm, count) = (run[0].arm, run.len());
                let skills = plan.arms[arm].skills.len();
                let first = if wave.pretraining.is_some() { skills - 1 } else { 0 };
                forecast.work += count as f64 * work_of(plan, groups, arm, first..skills);
                forecast.disk += count as u64 * disk_of(plan, group_of(groups, arm), arm);
            }
        }
    }
    forecast
}

impl Forecast {
    fn add(&mut self, group: &BatchGroup, learners: usize) {
        let bytes = group.shape.bytes_per_learner();
        self.cohorts += 1;
        self.largest = self.largest.max(learners);
        self.bytes_per_learner = self.bytes_per_learner.max(bytes);
        self.cohort_bytes = self.cohort_bytes.max((learners * bytes) as u64);
    }

    /// The time that all of it will take at a measured speed.
    pub fn time(&self, speed: f64) -> Duration {
        Duration::from_secs_f64((self.work / speed.max(1.0)).min(1e9))
    }
}

/// Work per second of the largest cohort, found by letting it train for a moment: at most about `most`, and less where
/// the whole run is short. The backend's memory is overwritten.
///
/// # Errors
/// Where the backend fails.
pub fn measure(
    plan: &Plan,
    groups: &[BatchGroup],
    waves: &[Wave],
    forecast: &Forecast,
    backend: &mut dyn Backend,
    most: Duration,
) -> Result<f64, BackendError> {
    let Some(ids) = largest(waves) else { return Ok(f64::INFINITY) };
    let group = group_of(groups, ids[0].arm);
    backend.load(group.cohort(plan, &ids))?;
    let stop = Stop { skill: u32::MAX, trial: u32::MAX };
    // A GPU's kernels are compiled at their first use.
    let mut before = match backend.kind() {
        "gpu" => done(plan, groups, &ids, backend.advance(stop)?),
        _ => 0.0,
    };
    let (mut work, mut speed) = (0.0, f64::INFINITY);
    let begun = Instant::now();
    loop {
        let after = done(plan, groups, &ids, backend.advance(stop)?);
        let elapsed = begun.elapsed();
        work += after - before;
        if after > before {
            speed = work / elapsed.as_secs_f64().max(1e-9);
        }
        // A thirtieth of the run at most: short ones are not to be held up.
        if elapsed >= most || elapsed * 30 >= forecast.time(speed) || after == before {
            return Ok(speed);
        }
        before = after;
    }
}

/// Some learners of the largest cohort.
fn largest(waves: &[Wave]) -> Option<Vec<LearnerId>> {
    let pretraining = |wave: &Wave| -> Option<Vec<LearnerId>> {
        let (arm, seeds) = wave.pretraining.as_ref()?;
        Some(seeds.iter().map(|seed| LearnerId { arm: *arm, seed: *seed }).collect())
    };
    let all = waves.iter().flat_map(|wave| wave.cohorts.iter().cloned().chain(pretraining(wave)));
    let mut most = all.max_by_key(Vec::len)?;
    most.truncate(TIMED);
    Some(most)
}

/// Work that learners have done, as their states tell.
fn done(plan: &Plan, groups: &[BatchGroup], ids: &[LearnerId], states: &[LearnerState]) -> f64 {
    let each = ids.iter().zip(states).map(|(id, state)| {
        let shape = &group_of(groups, id.arm).shape.skills;
        // A moment reaches no further than the first skill that has trials.
        let skills = &plan.arms[id.arm].skills;
        let skill = skills.iter().position(|skill| skill.params.trials > 0).unwrap_or(0);
        f64::from(state.actions) * step(shape, skill) + f64::from(state.updates) * transition(&shape[skill])
    });
    each.sum()
}

/// Work of a step while a skill is learned or tested: it and those below it are asked.
fn step(shape: &[SkillShape], skill: usize) -> f64 {
    let asked = shape[..=skill]
        .iter()
        .enumerate()
        .filter(|(number, _)| *number == skill || shape[skill].watched >> number & 1 == 1);
    STEP + asked.map(|(_, plan)| f64::from(plan.rows * plan.nets)).sum::<f64>()
}

/// Work of a transition that is learned.
fn transition(shape: &SkillShape) -> f64 {
    f64::from(shape.rows) * (f64::from(shape.nets) + BACKWARD)
}

/// Mean steps of a trial.
fn length(skill: &SkillPlan) -> f64 {
    f64::from(skill.params.max_steps) * if skill.goal == 0 { 1.0 } else { LENGTH }
}

/// Work of one learner in some of its skills.
fn work_of(plan: &Plan, groups: &[BatchGroup], arm: usize, skills: std::ops::Range<usize>) -> f64 {
    let shape = &group_of(groups, arm).shape.skills;
    let each = skills.map(|number| {
        let skill = &plan.arms[arm].skills[number];
        let learning = &skill.params;
        let taught = if skill.params.lessons > 0 { learning.taught_replays } else { 0 };
        let at_decisions = skill.is_high() && learning.backup == BACKUP_DECISIONS;
        let replays =
            f64::from(skill.params.trials) * f64::from(learning.replays + taught) * LEARNED[usize::from(at_decisions)];
        // Teachers are quick.
        let lessons = f64::from(skill.params.lessons * learning.pretrain_epochs) * 0.5;
        let acted = f64::from(skill.params.trials) + f64::from(tests(skill)) * f64::from(plan.evaluate.episodes);
        let steps = length(skill);
        steps * (acted * step(shape, number) + (replays + lessons) * transition(&shape[number]))
    });
    each.sum()
}

/// Tests of a skill.
fn tests(skill: &SkillPlan) -> u32 {
    skill.eval_at.iter().filter(|at| **at < skill.params.trials).count() as u32 + 1
}

/// Bytes that a learner's results take on disk.
fn disk_of(plan: &Plan, group: &BatchGroup, arm: usize) -> u64 {
    let arm = &plan.arms[arm];
    let rooms = plan.world_of(arm).rooms.len() as u64;
    let mut bytes = NET_BYTES[0];
    for (skill, shape) in arm.skills.iter().zip(&group.shape.skills) {
        let tests = u64::from(tests(skill)) * rooms;
        bytes += u64::from(skill.params.trials + skill.params.lessons) * ROW_BYTES[0] + tests * ROW_BYTES[1];
        if skill.mirror.is_none() && !skill.oracle {
            let weights = u64::from(skill.params.hidden) * (u64::from(shape.inputs) + 2) + 1;
            bytes += skill.children.len() as u64 * (4 * weights + NET_BYTES[1]);
        }
    }
    bytes + plan.alterations.len() as u64 * rooms * ROW_BYTES[1]
}

/// Bytes that the committed parts of a run take until it is complete: trial tables and nets as they are in memory.
pub fn parts_bytes(groups: &[BatchGroup], waves: &[Wave]) -> u64 {
    let cohorts = waves.iter().flat_map(|wave| &wave.cohorts);
    let each = cohorts.map(|ids| {
        let shape = &group_of(groups, ids[0].arm).shape;
        let rows = shape.rows_stride.next_multiple_of(TRIAL_WORDS);
        // A third of the nets' memory are weights, the rest is the optimiser's.
        ids.len() * 4 * (rows + shape.nets_stride / 3)
    });
    each.sum::<usize>() as u64
}
