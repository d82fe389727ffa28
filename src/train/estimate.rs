//! What a run will take, told before it begins: memory, disk, and time.
//!
//! Time is iterations over speed: steps that robots take, and transitions that are learned. How long trials will be is not
//! known, so a share of `max_steps` stands for it, taken from runs of the paper's experiments. Speed is measured: some
//! learners of the experiment train for a moment.

use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::schedule::Wave;
use crate::backend::{Backend, BackendError, Stop};
use crate::config::plan::{Plan, SkillPlan};
use crate::layout::choices::BACKUP_DECISIONS;
use crate::layout::{LearnerState, TRIAL_WORDS};
use std::ops::Range;
use std::time::{Duration, Instant};

/// Mean length of a trial that ends when its goal is achieved, as a share of `max_steps`: 0.4 to 0.7 in our runs.
const LENGTH: f64 = 0.55;
/// Share of replayed transitions that are learned: of a skill whose every step counts, and of one that learns at
/// decisions. 0.5 to 0.8, and 0.2, in our runs.
const LEARNED: [f64; 2] = [0.8, 0.2];
/// Bytes of a row of `trials.parquet` and of `evaluations.parquet`, compressed, as measured.
const ROW_BYTES: [u64; 2] = [8, 16];
/// Bytes of the header of a file with nets, and of each net in it.
const NET_BYTES: [u64; 2] = [500, 400];
/// Learners whose training is timed.
const TIMED: usize = 4096;

/// What a run will take.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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
    /// Iterations of all of it.
    iterations: f64,
}

/// Counts what the waves of a run will take.
pub fn forecast(plan: &Plan, groups: &[BatchGroup], waves: &[Wave]) -> Forecast {
    let mut all = Forecast::default();
    for wave in waves {
        let mut first = 0;
        if let Some((arm, seeds)) = &wave.pretraining {
            first = plan.arms[*arm].skills.len() - 1;
            all.add(group_of(groups, *arm), seeds.len());
            all.pretrained += seeds.len();
            all.iterations += seeds.len() as f64 * iterations(plan, *arm, 0..first);
        }
        for ids in &wave.cohorts {
            let group = group_of(groups, ids[0].arm);
            all.add(group, ids.len());
            all.learners += ids.len();
            for run in ids.chunk_by(|a, b| a.arm == b.arm) {
                let (arm, count) = (run[0].arm, run.len());
                all.iterations += count as f64 * iterations(plan, arm, first..plan.arms[arm].skills.len());
                all.disk += count as u64 * disk_of(plan, group, arm);
            }
        }
    }
    all
}

impl Forecast {
    fn add(&mut self, group: &BatchGroup, learners: usize) {
        let bytes = group.shape.bytes_per_learner();
        self.cohorts += 1;
        self.largest = self.largest.max(learners);
        self.bytes_per_learner = self.bytes_per_learner.max(bytes);
        self.cohort_bytes = self.cohort_bytes.max((learners * bytes) as u64);
    }

    /// The time that all of it will take at a measured speed, iterations per second.
    pub fn time(&self, speed: f64) -> Duration {
        Duration::from_secs_f64((self.iterations / speed.max(1.0)).min(1e9))
    }
}

/// Iterations per second of the largest cohort, found by letting it train for a moment: at most about `most`, and less
/// where the whole run is short. The backend's memory is overwritten.
pub fn measure(
    plan: &Plan,
    groups: &[BatchGroup],
    waves: &[Wave],
    all: &Forecast,
    backend: &mut dyn Backend,
    most: Duration,
) -> Result<f64, BackendError> {
    let Some(ids) = largest(waves) else { return Ok(f64::INFINITY) };
    backend.load(group_of(groups, ids[0].arm).cohort(plan, &ids))?;
    let stop = Stop { skill: u32::MAX, trial: u32::MAX };
    let done = |states: &[LearnerState]| {
        states.iter().map(|state| f64::from(state.actions) + f64::from(state.updates)).sum::<f64>()
    };
    // A GPU's kernels are compiled at their first use.
    let mut before = if backend.kind() == "gpu" { done(backend.advance(stop)?) } else { 0.0 };
    let (first, mut speed, begun) = (before, f64::INFINITY, Instant::now());
    loop {
        let after = done(backend.advance(stop)?);
        let elapsed = begun.elapsed();
        if after > before {
            speed = (after - first) / elapsed.as_secs_f64().max(1e-9);
        }
        // A thirtieth of the run at most: short ones are not to be held up.
        if elapsed >= most || elapsed * 30 >= all.time(speed) || after == before {
            return Ok(speed);
        }
        before = after;
    }
}

/// Some learners of the largest cohort.
fn largest(waves: &[Wave]) -> Option<Vec<LearnerId>> {
    let pretrained = |wave: &Wave| -> Option<Vec<LearnerId>> {
        let (arm, seeds) = wave.pretraining.as_ref()?;
        Some(seeds.iter().map(|seed| LearnerId { arm: *arm, seed: *seed }).collect())
    };
    let all = waves.iter().flat_map(|wave| wave.cohorts.iter().cloned().chain(pretrained(wave)));
    let mut most = all.max_by_key(Vec::len)?;
    most.truncate(TIMED);
    Some(most)
}

/// Iterations of one learner in some of its skills: steps of its trials and tests, and transitions learned.
fn iterations(plan: &Plan, arm: usize, skills: Range<usize>) -> f64 {
    let of_skill = |skill: &SkillPlan| {
        let learning = &skill.params;
        let taught = if skill.params.lessons > 0 { learning.taught_replays } else { 0 };
        let at_decisions = skill.is_high() && learning.backup == BACKUP_DECISIONS;
        let replays =
            f64::from(skill.params.trials) * f64::from(learning.replays + taught) * LEARNED[usize::from(at_decisions)];
        // Teachers are quick.
        let lessons = f64::from(skill.params.lessons * learning.pretrain_epochs) * 0.5;
        let acted =
            f64::from(skill.params.trials) + skill.test_points().count() as f64 * f64::from(plan.evaluate.episodes);
        let length = f64::from(skill.params.max_steps) * if skill.goal == 0 { 1.0 } else { LENGTH };
        length * (acted + replays + lessons)
    };
    plan.arms[arm].skills[skills].iter().map(of_skill).sum()
}

/// Bytes that a learner's results take on disk.
fn disk_of(plan: &Plan, group: &BatchGroup, arm: usize) -> u64 {
    let arm = &plan.arms[arm];
    let rooms = plan.world_of(arm).rooms.len() as u64;
    let mut bytes = NET_BYTES[0];
    for (skill, shape) in arm.skills.iter().zip(&group.shape.skills) {
        let tests = skill.test_points().count() as u64 * rooms;
        bytes += u64::from(skill.params.trials + skill.params.lessons) * ROW_BYTES[0] + tests * ROW_BYTES[1];
        if skill.mirror.is_none() && !skill.oracle {
            let weights = u64::from(skill.params.hidden) * (u64::from(shape.inputs) + 2) + 1;
            bytes += skill.children.len() as u64 * (4 * weights + NET_BYTES[1]);
        }
    }
    bytes + plan.alterations.len() as u64 * rooms * ROW_BYTES[1]
}

/// Bytes that the committed parts of a run take until it is complete, before they are compressed: trial tables and nets.
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
