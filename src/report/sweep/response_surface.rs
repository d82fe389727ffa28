//! One value per seed at every point of an arm.

use crate::report::statistics::{Selection, TimeToEvent, select};
use crate::report::summary::{DivergedLearner, Score, Series, Summary};
use crate::run_folder::Sweep;

/// Success of a seed's test that counts as having learned, in trials to criterion. The choice is ours: the paper names
/// no limit.
pub const CRITERION: f64 = 0.9;

/// An arm at one point of the sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfacePoint {
    /// Its number in `sweep.json` and in the tables.
    pub number: u32,
    /// What each seed achieves at its last test, by ascending seed. A learner that diverged achieves nothing.
    pub values: Vec<f64>,
    /// Training trials of each seed up to the first test at [`CRITERION`]; censored at the last test. A learner that
    /// diverged never gets there, and counts as watched to the end.
    pub seen: Vec<TimeToEvent>,
}

/// What an arm achieves over the space of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseSurface {
    /// The arm.
    pub arm: String,
    /// The skill at the top of its tree.
    pub skill: String,
    /// Whether values are success, or else discounted returns of a skill that never ends.
    pub success: bool,
    /// Seeds, ascending: every point has all of them.
    pub seeds: Vec<u32>,
    /// By ascending number. At least one.
    pub points: Vec<SurfacePoint>,
    /// Axes on which these points differ.
    pub axes: Vec<usize>,
    /// Which point is best: the candidates are the points, in their order.
    pub selection: Selection,
}

impl ResponseSurface {
    /// The best point.
    pub fn best(&self) -> &SurfacePoint {
        &self.points[self.selection.best]
    }

    /// Mean of each seed over some points.
    pub fn mean_by_seed(&self, points: &[usize]) -> Vec<f64> {
        let sum = |seed: usize| points.iter().map(|&point| self.points[point].values[seed]).sum::<f64>();
        (0..self.seeds.len()).map(|seed| sum(seed) / points.len() as f64).collect()
    }
}

/// The surfaces of all arms, and the points that lack seeds: arm, number, seeds that have tests there.
pub fn surfaces(sweep: &Sweep, summary: &Summary, seeds: &[u32]) -> (Vec<ResponseSurface>, Vec<(String, u32, usize)>) {
    let (mut surfaces, mut lacking) = (Vec::new(), Vec::new());
    for arm in &summary.arms {
        let Some(skill) = summary.skill(&arm.root) else { continue };
        let success = !skill.never_ends();
        let mut points = Vec::new();
        for series in skill.series.iter().filter(|series| series.arm == arm.name) {
            let here = series.last().scores.len();
            if here == seeds.len() && (series.point as usize) < sweep.points.len() {
                points.push(point(series, success, &summary.diverged));
            } else {
                lacking.push((arm.name.clone(), series.point, here));
            }
        }
        let candidates: Vec<&[f64]> = points.iter().map(|point| point.values.as_slice()).collect();
        let Some(selection) = select(&candidates) else { continue };
        let differ = |axis: &usize| {
            let first = &sweep.points[points[0].number as usize][*axis];
            points.iter().any(|point| sweep.points[point.number as usize][*axis] != *first)
        };
        surfaces.push(ResponseSurface {
            arm: arm.name.clone(),
            skill: skill.name.clone(),
            success,
            seeds: seeds.to_vec(),
            axes: (0..sweep.axes.len()).filter(differ).collect(),
            points,
            selection,
        });
    }
    (surfaces, lacking)
}

fn point(series: &Series, success: bool, diverged: &[DivergedLearner]) -> SurfacePoint {
    let last = series.last();
    let failed = |seed: u32| {
        let same = |learner: &DivergedLearner| {
            (&learner.arm, learner.point, learner.seed) == (&series.arm, series.point, seed)
        };
        diverged.iter().any(same)
    };
    let first = series.trials_to(CRITERION);
    let seen = last.scores.iter().zip(first).map(|(score, first)| match first {
        Some(trials) if !failed(score.seed) => TimeToEvent { time: f64::from(trials), reached: true },
        _ => TimeToEvent { time: f64::from(last.trials), reached: false },
    });
    SurfacePoint {
        number: series.point,
        values: last.values(if success { Score::success } else { Score::return_per_trial }),
        seen: seen.collect(),
    }
}
