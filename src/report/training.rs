//! Training trials of the roots, summed over windows: what the paper's Figure 2 shows.

use super::statistics::{Estimate, ratio_of};
use super::summary::{Score, Series, Summary};
use crate::run_folder::{Names, TrialRow};
use std::collections::BTreeMap;

/// Trials that a point of a training curve sums.
pub const WINDOW: u32 = 10;

impl From<&TrialRow> for Score {
    fn from(row: &TrialRow) -> Self {
        Self {
            seed: row.seed,
            episodes: 1,
            steps: u64::from(row.steps),
            collisions: u64::from(row.collisions),
            reward: f64::from(row.reward),
            ratios: f64::from(row.reward) / f64::from(row.steps),
            ..Self::default()
        }
    }
}

/// [`WINDOW`] successive trials of all seeds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TrainingWindow {
    /// Trials of the skill up to the window's end.
    pub end: u32,
    /// Sums of each seed, by ascending seed.
    pub sums: Vec<Score>,
}

/// The training of one arm's root; taught lessons are no training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct TrainingCurve {
    pub arm: String,
    pub point: u32,
    /// By ascending trials.
    pub windows: Vec<TrainingWindow>,
}

impl TrainingCurve {
    /// Sums of each seed over the windows that end after `from` trials.
    pub fn sums_by_seed(&self, from: u32) -> Vec<Score> {
        let mut by_seed: BTreeMap<u32, Score> = BTreeMap::new();
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
    let mut curves: BTreeMap<(u32, u32), BTreeMap<u32, BTreeMap<u32, Score>>> = BTreeMap::new();
    for row in rows.iter().filter(|row| !row.taught && row.steps > 0) {
        if summary.arm(&row.arm).is_some_and(|arm| arm.root == row.skill) {
            let windows = curves.entry((Names::number(&names.arms, &row.arm), row.point)).or_default();
            windows.entry(row.trial / WINDOW).or_default().entry(row.seed).or_default().add(&row.into());
        }
    }
    let window = |(number, by_seed): (u32, BTreeMap<u32, Score>)| {
        let longest = by_seed.values().map(|sums| sums.episodes).max().unwrap_or(0);
        TrainingWindow { end: number * WINDOW + longest as u32, sums: by_seed.into_values().collect() }
    };
    let curve = |((arm, point), windows): ((u32, u32), BTreeMap<_, _>)| TrainingCurve {
        arm: names.arms[arm as usize].clone(),
        point,
        windows: windows.into_iter().map(window).collect(),
    };
    curves.into_iter().map(curve).collect()
}

/// Sum over sum of a pair of numbers of each seed.
pub fn pooled(sums: &[Score], of: fn(&Score) -> (f64, f64), resamples: usize) -> Estimate {
    ratio_of(&sums.iter().map(of).collect::<Vec<_>>(), resamples)
}
