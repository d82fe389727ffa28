//! Axes: ranges of values with labelled ticks.

use crate::report::format::number;

/// A linear axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PlotAxis {
    /// What is measured, with its unit.
    pub title: String,
    /// Values at the ends.
    pub range: (f64, f64),
    /// Values with their labels, by ascending value. Labels that would overlap are left out when drawn.
    pub ticks: Vec<(f64, String)>,
    /// Whether a line runs through the plot at each tick, or else a short mark stands beside it.
    pub grid: bool,
}

impl PlotAxis {
    /// Round values as ticks; `percent` shows shares as percentages.
    pub fn linear(title: &str, range: (f64, f64), percent: bool) -> Self {
        let label = |value: f64| if percent { format!("{}%", (value * 100.0).round()) } else { number(value) };
        let ticks = ticks(range).into_iter().map(|value| (value, label(value))).collect();
        Self { title: title.into(), range, ticks, grid: false }
    }

    /// A place of width 1 for each label: the first from 0 to 1.
    pub fn categories(title: &str, labels: Vec<String>) -> Self {
        let range = (0.0, labels.len() as f64);
        let ticks = labels.into_iter().enumerate().map(|(i, label)| (i as f64 + 0.5, label)).collect();
        Self { title: title.into(), range, ticks, grid: false }
    }

    pub fn with_grid(self) -> Self {
        Self { grid: true, ..self }
    }

    /// Where a value lies between the ends: 0 at the low one, 1 at the high one.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.range.0) / (self.range.1 - self.range.0)
    }
}

/// About five round values within a range: steps of 1, 2 or 5 times a power of ten.
pub fn ticks((low, high): (f64, f64)) -> Vec<f64> {
    let width = high - low;
    if !(width.is_finite() && width > 0.0) {
        return vec![low];
    }
    let rough = width / 5.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|&step| step >= rough);
    let step = step.unwrap_or(10.0 * power);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// A range that holds 0 and some values, with a little air: up to the next tick if that is near.
pub fn range_with_zero(low: f64, high: f64) -> (f64, f64) {
    (if low < 0.0 { -upper_end(-low) } else { 0.0 }, upper_end(high))
}

fn upper_end(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let last = ticks((0.0, value)).last().copied().unwrap_or(value);
    if last >= value { last } else { value * 1.05 }
}
