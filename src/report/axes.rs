//! A plot's frame: scales, ticks, grid lines and titles.

use super::canvas::{Anchor, Canvas, GREY, INK, PALE};
use super::numbers::number;

/// A linear axis from a value range to points on the canvas.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What is measured, with its unit.
    pub title: String,
    /// Values at the ends.
    pub range: (f64, f64),
    /// Points on the canvas at the ends.
    pub points: (f64, f64),
    /// Show values as percentages.
    pub percent: bool,
}

impl Axis {
    /// Where a value lies on the canvas.
    pub fn place(&self, value: f64) -> f64 {
        let share = (value - self.range.0) / (self.range.1 - self.range.0);
        self.points.0 + share * (self.points.1 - self.points.0)
    }

    fn label(&self, value: f64) -> String {
        if self.percent { format!("{}%", (value * 100.0).round()) } else { number(value) }
    }
}

/// Draws grid, ticks and titles. `x` runs to the right, `y` upwards.
pub fn draw(canvas: &mut Canvas, x: &Axis, y: &Axis) {
    for value in ticks(y.range) {
        let at = y.place(value);
        canvas.line(&[(x.points.0, at), (x.points.1, at)], PALE, 0.75);
        canvas.text(&y.label(value), (x.points.0 - 8.0, at), 12.0, INK, Anchor::End);
    }
    for value in ticks(x.range) {
        let at = x.place(value);
        canvas.line(&[(at, y.points.0), (at, y.points.0 + 5.0)], GREY, 1.0);
        canvas.text(&x.label(value), (at, y.points.0 + 15.0), 12.0, INK, Anchor::Middle);
    }
    let floor = y.place(0.0_f64.max(y.range.0));
    canvas.line(&[(x.points.0, floor), (x.points.1, floor)], GREY, 1.0);
    let middle = |axis: &Axis| (axis.points.0 + axis.points.1) / 2.0;
    canvas.text(&x.title, (middle(x), y.points.0 + 36.0), 13.0, INK, Anchor::Middle);
    canvas.text_upwards(&y.title, (16.0, middle(y)), 13.0, INK);
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

/// The end of an axis that starts at 0 and holds a value: the value and a little air, up to the next tick if that is near.
pub fn upper_end(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let last = ticks((0.0, value)).last().copied().unwrap_or(value);
    if last >= value { last } else { value * 1.05 }
}

/// The other end: 0, or below the lowest value if that is negative.
pub fn lower_end(value: f64) -> f64 {
    if value < 0.0 { -upper_end(-value) } else { 0.0 }
}
