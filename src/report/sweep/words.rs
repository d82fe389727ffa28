//! Values of axes, points and measured values in words.

use super::surface::Surface;
use crate::report::numbers::{percent_with, points_with, with};
use crate::report::statistics::Interval;
use crate::run_folder::Sweep;
use crate::run_folder::sweep::AxisValue;

/// Characters up to which a number is written out.
const LONGEST: usize = 7;

/// A value on an axis: numbers with three digits where their exact text is long, worlds without their folder and ending.
pub(super) fn value(value: &AxisValue) -> String {
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

/// A point by its values: `dock threshold 0.05, world office-easy`.
pub(super) fn point(sweep: &Sweep, surface: &Surface, number: u32) -> String {
    let of = |&axis: &usize| format!("{} {}", sweep.axes[axis].label, value(&sweep.points[number as usize][axis]));
    surface.axes.iter().map(of).collect::<Vec<_>>().join(", ")
}

/// A measured value with its interval.
pub(super) fn measured(surface: &Surface, value: f64, interval: Interval) -> String {
    if surface.success { percent_with(value, interval) } else { with(value, interval, 2) }
}

/// A measured value alone.
pub(super) fn bare(surface: &Surface, value: f64) -> String {
    if surface.success { format!("{:.1}%", 100.0 * value) } else { format!("{value:.2}") }
}

/// A difference of measured values with its interval.
pub(super) fn difference(surface: &Surface, value: f64, interval: Interval) -> String {
    match surface.success {
        true => points_with(value, interval),
        false => format!("{value:+.2} [{:+.2}, {:+.2}]", interval.low, interval.high),
    }
}

/// What is measured, for axes and column heads.
pub(super) fn measure(surface: &Surface) -> &'static str {
    if surface.success { "test trials achieved" } else { "discounted return per trial" }
}
