//! Training trials of the roots, summed over windows: what the paper's Figure 2 shows.

use super::statistics::{Estimate, ratio_of};
use super::summary::{Series, Summary};
use crate::run_folder::{Names, TrialRow};
use std::collections::BTreeMap;

/// Trials that a point of a training curve sums.
pub const WINDOW: u32 = 10;

/// Training trials of one learner, summed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TrialSums {
    /// Seed of the learner.
    pub seed: u32,
    /// Trials.
    pub trials: u32,
    /// Primitive steps.
    pub steps: u64,
    /// Steps with contact.
    pub collisions: u64,
    /// Sum of rewards.
    pub reward: f64,
    /// Sum over trials of reward per step of the trial.
    pub ratios: f64,
}

impl From<&TrialRow> for TrialSums {
    fn from(row: &TrialRow) -> Self {
        Self {
            seed: row.seed,
            trials: 1,
            steps: u64::from(row.steps),
            collisions: u64::from(row.collisions),
            reward: f64::from(row.reward),
            ratios: f64::from(row.reward) / f64::from(row.steps),
        }
    }
}

impl TrialSums {
    fn add(&mut self, other: &Self) {
        self.seed = other.seed;
        self.trials += other.trials;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.ratios += other.ratios;
    }

    /// Reward and steps.
    pub fn reward_and_steps(&self) -> (f64, f64) {
        (self.reward, self.steps as f64)
    }

    /// Reward per step of each trial, summed, and trials.
    pub fn ratios_and_trials(&self) -> (f64, f64) {
        (self.ratios, f64::from(self.trials))
    }

    /// Collisions and steps.
    pub fn collisions_and_steps(&self) -> (f64, f64) {
        (self.collisions as f64, self.steps as f64)
    }
}

/// [`WINDOW`] successive trials of all seeds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TrainingWindow {
    /// Trials of the skill up to the window's end.
    pub end: u32,
    /// Sums of each seed, by ascending seed.
    pub sums: Vec<TrialSums>,
}

/// The training of one arm's root; taught lessons are no training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingCurve {
    /// The arm.
    pub arm: String,
    /// The sweep point.
    pub point: u32,
    /// By ascending trials.
    pub windows: Vec<TrainingWindow>,
}

impl TrainingCurve {
    /// Sums of each seed over the windows that end after `from` trials.
    pub fn sums_by_seed(&self, from: u32) -> Vec<TrialSums> {
        let mut by_seed: BTreeMap<u32, TrialSums> = BTreeMap::new();
        for sums in self.windows.iter().filter(|window| window.end > from).flat_map(|window| &window.sums) {
            by_seed.entry(sums.seed).or_default().add(sums);
        }
        by_seed.into_values().collect()
    }

    /// Trials of the whole training.
    pub fn trials(&self) -> u32 {
        self.windows.last().map_or(0, |window| window.end)
    }
}

/// The training of a series, if it had any.
pub fn of_series<'a>(trainings: &'a [TrainingCurve], series: &Series) -> Option<&'a TrainingCurve> {
    trainings.iter().find(|training| training.arm == series.arm && training.point == series.point)
}

/// Sums the trials of each arm's root over windows.
pub fn summarise(summary: &Summary, names: &Names, rows: &[TrialRow]) -> Vec<TrainingCurve> {
    let mut curves: BTreeMap<(u32, u32), BTreeMap<u32, BTreeMap<u32, TrialSums>>> = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.taught && row.steps > 0) {
        if summary.arm(&row.arm).is_none_or(|arm| arm.root != row.skill) {
            continue;
        }
        let windows = curves.entry((Names::number(&names.arms, &row.arm), row.point)).or_default();
        windows.entry(row.trial / WINDOW).or_default().entry(row.seed).or_default().add(&row.into());
    }
    let window = |(number, by_seed): (u32, BTreeMap<u32, TrialSums>)| {
        let longest = by_seed.values().map(|sums| sums.trials).max().unwrap_or(0);
        TrainingWindow { end: number * WINDOW + longest, sums: by_seed.into_values().collect() }
    };
    let curve = |((arm, point), windows): ((u32, u32), BTreeMap<_, _>)| TrainingCurve {
        arm: names.arms[arm as usize].clone(),
        point,
        windows: windows.into_iter().map(window).collect(),
    };
    curves.into_iter().map(curve).collect()
}

/// Sum over sum of a pair of numbers of each seed.
pub fn pooled(sums: &[TrialSums], of: fn(&TrialSums) -> (f64, f64), resamples: usize) -> Estimate {
    ratio_of(&sums.iter().map(of).collect::<Vec<_>>(), resamples)
}
