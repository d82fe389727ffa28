//! Values of axes, points and what is measured, in words.

use super::response_surface::ResponseSurface;
use crate::report::format::{number, seeds};
use crate::report::statistics::TABLE_RESAMPLES;
use crate::run_folder::Sweep;
use crate::run_folder::sweep::AxisValue;

/// Characters up to which a number is written out.
const LONGEST: usize = 7;

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

/// A point by its values on some axes: `dock threshold 0.05, world office-easy`.
pub(super) fn point(sweep: &Sweep, axes: &[usize], number: u32) -> String {
    let values = &sweep.points[number as usize];
    let of = |&axis: &usize| format!("{} {}", sweep.axes[axis].label, axis_value(&values[axis]));
    axes.iter().map(of).collect::<Vec<_>>().join(", ")
}

/// What is measured, for axes and column heads.
pub(super) fn measure(surface: &ResponseSurface) -> &'static str {
    if surface.success { "test trials achieved" } else { "discounted return per trial" }
}

/// What the marks of a map mean; the best point has a frame or a ring.
pub(super) fn map_notes(surface: &ResponseSurface, best: &str) -> Vec<String> {
    vec![
        format!("Mean over n = {} at the last test. {best}: the highest mean.", seeds(surface.seeds.len())),
        format!(
            "Dot: not told apart from it, as the 95% percentile bootstrap interval of the difference on the same seeds \
             ({} resamples) holds 0.",
            number(TABLE_RESAMPLES as f64)
        ),
    ]
}
