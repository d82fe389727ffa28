//! Does a learner among thousands cost what it costs among few? One small experiment with more and more learners.

use super::BenchError;
use super::embedded_configs::{DOCKING, embedded_plan};
use super::result::BenchOrigin;
use super::timing::{Elapsed, Spread, cores, timed};
use crate::backend::cpu::cpu_backend;
use crate::train::batch::train;
use crate::train::batch_group::{LearnerId, groups};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// Numbers of learners.
pub const COUNTS: [u32; 5] = [64, 256, 1024, 4096, 16_384];

/// Seeds that the learners take in turn, so that every number of learners has the same mix of work.
const SEEDS: u32 = 64;

/// Learners of some milliseconds each: whole ones take seconds, of which making their memory is nothing.
const SET: [&str; 9] = [
    "arms=[\"taught-adam\"]",
    "teacher.lessons=16",
    "teacher.eval_episodes=1",
    "evaluate.at=[0]",
    "evaluate.episodes=2",
    "skill.dock.trials=16",
    "learning.pretrain_epochs=1",
    "learning.replays=4",
    "learning.replay_capacity=4",
];

/// Cost per learner at several numbers of learners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScalingReport {
    /// Who measured what, where and when.
    pub origin: BenchOrigin,
    /// Threads of the CPU backend.
    pub threads: usize,
    /// One row per number of learners.
    pub rows: Vec<ScalingRow>,
    /// Greatest median cost over the least.
    pub greatest_over_least: f64,
}

/// One number of learners.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ScalingRow {
    /// Learners that are in memory at a time.
    pub learners: u32,
    /// CPU-seconds per learner, its memory's making included.
    pub cpu_seconds: Spread,
    /// Seconds per learner.
    pub seconds: Spread,
}

/// Trains each number of learners `samples` times, all learners of a number in one cohort. Small numbers are repeated
/// until a sample is as long as that of 1,024 learners.
///
/// # Errors
/// Where the CPU backend cannot be had.
pub fn scaling(
    counts: &[u32],
    samples: u32,
    command: &str,
    note: &mut dyn FnMut(&str),
) -> Result<ScalingReport, BenchError> {
    let origin = BenchOrigin::new(command);
    let plan = embedded_plan(DOCKING, &SET, SEEDS)?;
    let group = groups(&plan)?.swap_remove(0);
    let seeds = group.learners(&plan);
    let mut backend = cpu_backend(cores(), None)?;
    let mut taken: Vec<Vec<Elapsed>> = counts.iter().map(|_| Vec::new()).collect();
    // The first round touches all memory for the first time.
    for sample in 0..=samples {
        for (count, taken) in counts.iter().zip(&mut taken) {
            note(&format!("sample {sample} of {samples}: {count} learners"));
            let repeats = (1024 / count).max(1);
            let ids: Vec<LearnerId> = seeds.iter().copied().cycle().take(*count as usize).collect();
            let mut train = || train(&plan, &group, &ids, &|_| None, None, &mut backend, &mut ());
            let (done, elapsed) = timed(|| (0..repeats).try_for_each(|_| train().map(drop)));
            done?;
            let learners = f64::from(count * repeats);
            if sample > 0 {
                taken.push(Elapsed { wall: elapsed.wall / learners, cpu: elapsed.cpu / learners });
            }
        }
    }
    let row = |(learners, taken): (&u32, &Vec<Elapsed>)| {
        let cpu_seconds = Spread::of(taken.iter().map(|each| each.cpu))?;
        Some(ScalingRow { learners: *learners, cpu_seconds, seconds: Spread::of(taken.iter().map(|each| each.wall))? })
    };
    let rows: Vec<ScalingRow> = counts.iter().zip(&taken).filter_map(row).collect();
    let costs = || rows.iter().map(|row| row.cpu_seconds.median);
    let greatest_over_least = costs().fold(0.0, f64::max) / costs().fold(f64::INFINITY, f64::min);
    Ok(ScalingReport { origin, threads: cores(), rows, greatest_over_least })
}

impl ScalingReport {
    /// What people read.
    pub fn text(&self) -> String {
        let mut out = format!("{}, {} threads; medians, quartiles in brackets\n", self.origin.cpu, self.threads);
        for ScalingRow { learners, cpu_seconds, seconds } in &self.rows {
            let (cpu, wall) = (cpu_seconds.text(1.0e3, 3), seconds.text(1.0e3, 3));
            let _ = writeln!(out, "  {learners:>6} learners: {cpu:>24} CPU-ms each, {wall:>24} ms each");
        }
        let _ = writeln!(out, "greatest cost over least: {:.3}", self.greatest_over_least);
        out
    }
}
