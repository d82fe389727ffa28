//! What an arm achieves over the space of the axes: one value per seed at every point; and one axis alone, over all
//! others.

use crate::report::statistics::{Estimate, Selection, TimeToEvent, mean, mean_of, paired_difference, select};
use crate::report::summary::{Score, Series, Summary};
use crate::run_folder::sweep::{AxisValue, Design};
use crate::run_folder::{Divergence, Sweep};
use std::sync::Arc;

/// Success of a seed's test that counts as having learned, in trials to criterion. The choice is ours: the paper names
/// no limit.
pub const CRITERION: f64 = 0.9;
/// Values that are shown one by one; more, drawn at random, are put into classes.
const MOST_VALUES: usize = 8;
/// Classes of values that were drawn at random, each with as many points.
const CLASSES: usize = 5;
/// Characters up to which a number on an axis is written out.
const LONGEST: usize = 7;

/// A sweep and what it measured.
#[derive(Debug, Clone)]
pub struct SweepResults {
    pub sweep: Arc<Sweep>,
    /// One for each arm with points that hold all seeds.
    pub surfaces: Vec<ResponseSurface>,
    /// Points left out because some seeds have no tests there: arm, point, seeds that have.
    pub lacking: Vec<(String, u32, usize)>,
    pub diverged: Vec<Divergence>,
}

impl SweepResults {
    /// What a run measured; `seeds` are those that it was to have.
    pub fn new(sweep: Sweep, summary: &Summary, seeds: &[u32]) -> Self {
        let sweep = Arc::new(sweep);
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
            let at = |point: &SurfacePoint, axis: usize| &sweep.points[point.number as usize][axis];
            let differ = |&axis: &usize| points.iter().any(|point| at(point, axis) != at(&points[0], axis));
            surfaces.push(ResponseSurface {
                sweep: Arc::clone(&sweep),
                arm: arm.name.clone(),
                skill: skill.name.clone(),
                success,
                seeds: seeds.to_vec(),
                axes: (0..sweep.axes.len()).filter(differ).collect(),
                points,
                selection,
            });
        }
        Self { sweep, surfaces, lacking, diverged: summary.diverged.clone() }
    }

    /// Surfaces with more than one point, which alone have something to show.
    pub fn shown(&self) -> impl Iterator<Item = &ResponseSurface> {
        self.surfaces.iter().filter(|surface| !surface.axes.is_empty())
    }
}

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

fn point(series: &Series, success: bool, diverged: &[Divergence]) -> SurfacePoint {
    let last = series.last();
    let failed = |seed: u32| {
        let of =
            |learner: &Divergence| (&learner.arm, learner.point, learner.seed) == (&series.arm, series.point, seed);
        diverged.iter().any(of)
    };
    let seen = last.scores.iter().zip(series.trials_to(CRITERION)).map(|(score, first)| {
        let first = first.filter(|_| !failed(score.seed));
        TimeToEvent { time: f64::from(first.unwrap_or(last.trials)), reached: first.is_some() }
    });
    SurfacePoint {
        number: series.point,
        values: last.values(if success { Score::success } else { Score::return_per_trial }),
        seen: seen.collect(),
    }
}

/// What an arm achieves over the space of the axes.
#[derive(Debug, Clone, PartialEq)]
pub struct ResponseSurface {
    pub sweep: Arc<Sweep>,
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
    pub fn best(&self) -> &SurfacePoint {
        &self.points[self.selection.best]
    }

    /// The values on all axes at one of [`ResponseSurface::points`].
    pub fn values(&self, point: usize) -> &[AxisValue] {
        &self.sweep.points[self.points[point].number as usize]
    }

    /// The same in words, for some axes: `dock threshold 0.05, world office-easy`.
    pub fn words(&self, axes: &[usize], point: usize) -> String {
        let of = |&axis: &usize| format!("{} {}", self.sweep.axes[axis].label, axis_value(&self.values(point)[axis]));
        axes.iter().map(of).collect::<Vec<_>>().join(", ")
    }

    /// What is measured, for axes and column heads.
    pub fn measure(&self) -> &'static str {
        if self.success { "test trials achieved" } else { "discounted return per trial" }
    }

    /// Mean of each seed over some points.
    pub fn mean_by_seed(&self, points: &[usize]) -> Vec<f64> {
        let sum = |seed: usize| points.iter().map(|&point| self.points[point].values[seed]).sum::<f64>();
        (0..self.seeds.len()).map(|seed| sum(seed) / points.len() as f64).collect()
    }

    /// The levels of an axis in its order; those without points are left out.
    pub fn levels(&self, axis: usize) -> Vec<AxisLevel> {
        let value = |point: usize| &self.values(point)[axis];
        let all = 0..self.points.len();
        let there = |known: &&AxisValue| all.clone().any(|point| value(point) == *known);
        let values: Vec<&AxisValue> = self.sweep.axes[axis].values.iter().filter(there).collect();
        let numbers = values.iter().all(|value| matches!(value, AxisValue::Number(_)));
        if self.sweep.design == Design::Random && numbers && values.len() > MOST_VALUES {
            let number = |point: usize| if let AxisValue::Number(number) = value(point) { *number } else { 0.0 };
            let mut ascending: Vec<usize> = all.collect();
            ascending.sort_by(|&a, &b| number(a).total_cmp(&number(b)));
            let class = |class: usize| {
                let end = |class: usize| ascending.len() * class / CLASSES;
                let points = ascending[end(class)..end(class + 1)].to_vec();
                let ends = [points.first(), points.last()];
                let words = ends.map(|point| point.map_or_else(String::new, |&point| axis_value(value(point))));
                self.level(words.join(" to "), points)
            };
            return (0..CLASSES).map(class).collect();
        }
        let points = |known: &AxisValue| all.clone().filter(|&point| value(point) == known).collect();
        values.into_iter().map(|known| self.level(axis_value(known), points(known))).collect()
    }

    fn level(&self, label: String, points: Vec<usize>) -> AxisLevel {
        let of = || points.iter().map(|&point| &self.points[point]);
        AxisLevel {
            label,
            by_seed: self.mean_by_seed(&points),
            learners: of().flat_map(|point| point.values.iter().copied()).collect(),
            seen: of().flat_map(|point| point.seen.iter().copied()).collect(),
            points,
        }
    }
}

/// All points of an arm with one value on an axis, or with one of a class of values.
#[derive(Debug, Clone, PartialEq)]
pub struct AxisLevel {
    /// The value, or the ends of the class.
    pub label: String,
    /// Points behind it: indices into [`ResponseSurface::points`].
    pub points: Vec<usize>,
    /// Mean of each seed over the points.
    pub by_seed: Vec<f64>,
    /// What each learner achieves, point by point.
    pub learners: Vec<f64>,
    /// Trials to criterion of each learner.
    pub seen: Vec<TimeToEvent>,
}

impl AxisLevel {
    /// Mean over seeds with its bootstrap interval. Seeds are resampled, each with all of its points, for points share
    /// their seeds.
    pub fn mean(&self) -> Estimate {
        mean_of(&self.by_seed)
    }
}

/// How much an axis matters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MainEffect {
    /// The level with the highest mean.
    pub highest: usize,
    /// The level with the lowest mean.
    pub lowest: usize,
    /// Mean of their difference over pairs of the same seed. Both levels are chosen for being extreme, so it promises too
    /// much where levels differ little.
    pub difference: Estimate,
}

/// The levels with the highest and the lowest mean, compared. None without levels.
pub fn main_effect(levels: &[AxisLevel]) -> Option<MainEffect> {
    let means: Vec<f64> = levels.iter().map(|level| mean(&level.by_seed)).collect();
    let highest = (0..means.len()).reduce(|a, b| if means[b] > means[a] { b } else { a })?;
    let lowest = (0..means.len()).reduce(|a, b| if means[b] < means[a] { b } else { a })?;
    let difference = paired_difference(&levels[highest].by_seed, &levels[lowest].by_seed);
    Some(MainEffect { highest, lowest, difference })
}

/// A value on an axis: numbers with three digits where their exact text is long, worlds without their folder and ending.
pub(super) fn axis_value(value: &AxisValue) -> String {
    let number = match value {
        AxisValue::Text(text) => {
            let name = text.strip_suffix(".toml").and_then(|path| path.rsplit('/').next());
            return name.unwrap_or(text).to_owned();
        }
        AxisValue::Number(number) => *number,
    };
    let exact = number.to_string();
    if exact.len() <= LONGEST {
        return exact;
    }
    let digits_before = number.abs().log10().floor() as i32;
    if digits_before < -4 {
        return format!("{number:.2e}");
    }
    format!("{number:.*}", (2 - digits_before).clamp(0, 7) as usize)
}
