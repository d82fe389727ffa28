//! One axis alone: what learners achieve at each of its values, over all other axes.

use super::format::axis_value;
use super::response_surface::ResponseSurface;
use crate::report::statistics::{Estimate, TimeToEvent, mean, mean_of, paired_difference};
use crate::run_folder::Sweep;
use crate::run_folder::sweep::{AxisValue, Design};

/// Values that are shown one by one; more, drawn at random, are put into classes.
const MOST_VALUES: usize = 8;
/// Classes of values that were drawn at random, each with as many points.
const CLASSES: usize = 5;

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
    fn new(label: String, points: Vec<usize>, surface: &ResponseSurface) -> Self {
        let of = || points.iter().map(|&point| &surface.points[point]);
        Self {
            label,
            by_seed: surface.mean_by_seed(&points),
            learners: of().flat_map(|point| point.values.iter().copied()).collect(),
            seen: of().flat_map(|point| point.seen.iter().copied()).collect(),
            points,
        }
    }

    /// Mean over seeds with its bootstrap interval. Seeds are resampled, each with all of its points, for points share
    /// their seeds.
    pub fn mean(&self) -> Estimate {
        mean_of(&self.by_seed)
    }
}

/// The levels of an axis in its order; those without points are left out.
pub fn levels(sweep: &Sweep, surface: &ResponseSurface, axis: usize) -> Vec<AxisLevel> {
    let value = |point: usize| &sweep.points[surface.points[point].number as usize][axis];
    let all = 0..surface.points.len();
    let values: Vec<&AxisValue> =
        sweep.axes[axis].values.iter().filter(|known| all.clone().any(|point| value(point) == *known)).collect();
    let numbers = values.iter().all(|value| matches!(value, AxisValue::Number(_)));
    if sweep.design == Design::Random && numbers && values.len() > MOST_VALUES {
        let number = |point: usize| if let AxisValue::Number(number) = value(point) { *number } else { 0.0 };
        let mut ascending: Vec<usize> = all.collect();
        ascending.sort_by(|&a, &b| number(a).total_cmp(&number(b)));
        let count = ascending.len();
        let class = |class: usize| {
            let points = ascending[count * class / CLASSES..count * (class + 1) / CLASSES].to_vec();
            let ends =
                [points.first(), points.last()].map(|point| point.map_or_else(String::new, |&p| axis_value(value(p))));
            AxisLevel::new(ends.join(" to "), points, surface)
        };
        return (0..CLASSES).map(class).collect();
    }
    let level = |known: &AxisValue| {
        let points = all.clone().filter(|&point| value(point) == known).collect();
        AxisLevel::new(axis_value(known), points, surface)
    };
    values.into_iter().map(level).collect()
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
