//! Does a learner among thousands cost what it costs among few? One small experiment with more and more learners.

use super::BenchError;
use super::clock::{Spread, timed};
use super::result::Origin;
use super::run::origin;
use super::workload::{self, DOCKING};
use crate::backend::cpu::CpuBackend;
use crate::train::batch::train;
use crate::train::batch_group::groups;
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::time::SystemTime;

/// Numbers of learners.
pub const COUNTS: [u32; 5] = [64, 256, 1024, 4096, 16_384];

/// Seeds that the learners take in turn, so that every number of learners has the same mix of work.
const SEEDS: u32 = 64;

/// Cost per learner at several numbers of learners.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scaling {
    /// Who measured what, where and when.
    pub origin: Origin,
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
pub fn scaling(counts: &[u32], samples: u32, command: &str, note: &mut dyn FnMut(&str)) -> Result<Scaling, BenchError> {
    let started = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let set = [
        "arms=[\"taught-adam\"]",
        "teacher.lessons=16",
        "teacher.eval_episodes=1",
        "evaluate.at=[0]",
        "evaluate.episodes=2",
        // Some milliseconds each: whole learners take seconds, of which making their memory is nothing.
        "skill.dock.trials=16",
        "learning.pretrain_epochs=1",
        "learning.replays=4",
        "learning.replay_capacity=4",
    ];
    let plan = workload::plan(DOCKING, &set, SEEDS)?;
    let group = groups(&plan)?.swap_remove(0);
    let seeds = group.learners(&plan);
    let ids = |count: u32| seeds.iter().copied().cycle().take(count as usize).collect::<Vec<_>>();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut backend = CpuBackend::new(threads, None)?;
    let mut spans: Vec<Vec<(f64, f64)>> = counts.iter().map(|_| Vec::new()).collect();
    // The first round touches all memory for the first time.
    for sample in 0..=samples {
        for (count, spans) in counts.iter().zip(&mut spans) {
            note(&format!("sample {sample} of {samples}: {count} learners"));
            let repeats = (1024 / count).max(1);
            let ids = ids(*count);
            let (_, span) = timed(|| {
                for _repeat in 0..repeats {
                    train(&plan, &group, &ids, &|_| None, None, &mut backend, &mut ())?;
                }
                Ok(())
            })?;
            let learners = f64::from(count * repeats);
            if sample > 0 {
                spans.push((span.cpu / learners, span.wall / learners));
            }
        }
    }
    let rows = counts.iter().zip(&spans).filter_map(|(learners, spans)| {
        Some(ScalingRow {
            learners: *learners,
            cpu_seconds: Spread::of(spans.iter().map(|(cpu, _)| *cpu))?,
            seconds: Spread::of(spans.iter().map(|(_, wall)| *wall))?,
        })
    });
    let rows: Vec<ScalingRow> = rows.collect();
    let costs = || rows.iter().map(|row| row.cpu_seconds.median);
    let greatest_over_least = costs().fold(0.0, f64::max) / costs().fold(f64::INFINITY, f64::min);
    Ok(Scaling { origin: origin(command, started), threads, rows, greatest_over_least })
}

/// What people read.
pub fn text(scaling: &Scaling) -> String {
    let mut out = format!("{}, {} threads; medians, quartiles in brackets\n", scaling.origin.cpu, scaling.threads);
    for row in &scaling.rows {
        let of = |spread: &Spread| {
            let figure = |seconds: f64| format!("{:.3}", 1.0e3 * seconds);
            format!("{} [{}, {}]", figure(spread.median), figure(spread.low), figure(spread.high))
        };
        let (cpu, wall) = (of(&row.cpu_seconds), of(&row.seconds));
        let _ = writeln!(out, "  {:>6} learners: {cpu:>24} CPU-ms each, {wall:>24} ms each", row.learners);
    }
    let _ = writeln!(out, "greatest cost over least: {:.3}", scaling.greatest_over_least);
    out
}
