//! Training trials of the roots, summed over windows: what the paper's Figure 2 shows.

use super::statistics::{Interval, bootstrap_ratio, ratio};
use super::summary::{Series, Summary};
use crate::run_folder::{Names, TrialRow};
use std::collections::BTreeMap;

/// Trials that a point of a training curve sums.
pub const WINDOW: u32 = 10;

/// Training trials of one learner, summed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
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

impl Tally {
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
pub struct Window {
    /// Trials of the skill up to the window's end.
    pub end: u32,
    /// One tally per seed, by ascending seed.
    pub tallies: Vec<Tally>,
}

/// The training of one arm's root; taught lessons are no training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Training {
    /// The arm.
    pub arm: String,
    /// The sweep point.
    pub point: u32,
    /// By ascending trials.
    pub windows: Vec<Window>,
}

impl Training {
    /// One tally per seed over the windows that end after `from` trials.
    pub fn tallies(&self, from: u32) -> Vec<Tally> {
        let mut sums: BTreeMap<u32, Tally> = BTreeMap::new();
        for tally in self.windows.iter().filter(|window| window.end > from).flat_map(|window| &window.tallies) {
            let sum = sums.entry(tally.seed).or_default();
            *sum = Tally {
                seed: tally.seed,
                trials: sum.trials + tally.trials,
                steps: sum.steps + tally.steps,
                collisions: sum.collisions + tally.collisions,
                reward: sum.reward + tally.reward,
                ratios: sum.ratios + tally.ratios,
            };
        }
        sums.into_values().collect()
    }

    /// Trials of the whole training.
    pub fn trials(&self) -> u32 {
        self.windows.last().map_or(0, |window| window.end)
    }
}

/// The training of a series, if it had any.
pub fn of<'a>(trainings: &'a [Training], series: &Series) -> Option<&'a Training> {
    trainings.iter().find(|training| training.arm == series.arm && training.point == series.point)
}

/// Sums the trials of each arm's root over windows.
pub fn summarise(summary: &Summary, names: &Names, rows: &[TrialRow]) -> Vec<Training> {
    let mut sums: BTreeMap<(u32, u32), BTreeMap<u32, BTreeMap<u32, Tally>>> = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.taught && row.steps > 0) {
        if summary.arm(&row.arm).is_none_or(|arm| arm.root != row.skill) {
            continue;
        }
        let windows = sums.entry((Names::number(&names.arms, &row.arm), row.point)).or_default();
        let tally = windows.entry(row.trial / WINDOW).or_default().entry(row.seed).or_default();
        tally.seed = row.seed;
        tally.trials += 1;
        tally.steps += u64::from(row.steps);
        tally.collisions += u64::from(row.collisions);
        tally.reward += f64::from(row.reward);
        tally.ratios += f64::from(row.reward) / f64::from(row.steps);
    }
    let window = |(number, tallies): (u32, BTreeMap<u32, Tally>)| {
        let tallies: Vec<Tally> = tallies.into_values().collect();
        let longest = tallies.iter().map(|tally| tally.trials).max().unwrap_or(0);
        Window { end: number * WINDOW + longest, tallies }
    };
    let training = |((arm, point), windows): ((u32, u32), BTreeMap<u32, BTreeMap<u32, Tally>>)| Training {
        arm: names.arms[arm as usize].clone(),
        point,
        windows: windows.into_iter().map(window).collect(),
    };
    sums.into_iter().map(training).collect()
}

/// Sum over sum of pairs over seeds, with its bootstrap interval.
pub fn pooled(tallies: &[Tally], of: fn(&Tally) -> (f64, f64), resamples: usize) -> (f64, Interval) {
    let pairs: Vec<(f64, f64)> = tallies.iter().map(of).collect();
    (ratio(&pairs), bootstrap_ratio(&pairs, resamples))
}
