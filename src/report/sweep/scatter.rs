//! Points that were drawn at random, in the plane of two axes.

use super::format::{axis_value, map_notes, measure};
use super::response_surface::ResponseSurface;
use crate::report::figure::axis::{PlotAxis, ticks};
use crate::report::figure::color::{ColorScale, GREY, INK, VERMILION};
use crate::report::figure::svg::Stroke;
use crate::report::figure::{Figure, PlotArea};
use crate::report::format::number;
use crate::run_folder::Sweep;
use crate::run_folder::sweep::{Axis, AxisValue, Scale};

/// Points up to which they are drawn large.
const FEW: usize = 200;

fn is_logarithmic(axis: &Axis) -> bool {
    let positive = |value: &AxisValue| matches!(value, AxisValue::Number(number) if *number > 0.0);
    axis.scale == Scale::Log && axis.values.iter().all(positive)
}

/// A value as a number: logarithms where the axis is logarithmic, words by their place in the list.
fn position(axis: &Axis, value: &AxisValue) -> f64 {
    match value {
        AxisValue::Number(number) if is_logarithmic(axis) => number.log10(),
        AxisValue::Number(number) => *number,
        AxisValue::Text(_) => axis.values.iter().position(|known| known == value).unwrap_or(0) as f64,
    }
}

fn plot_axis(axis: &Axis) -> PlotAxis {
    let all = axis.values.iter().map(|value| position(axis, value));
    let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
    let air = if high > low { 0.04 * (high - low) } else { 0.5 };
    let range = (low - air, high + air);
    let labelled = |value: &AxisValue| (position(axis, value), axis_value(value));
    let ticks: Vec<(f64, String)> = if axis.values.iter().any(|value| matches!(value, AxisValue::Text(_))) {
        axis.values.iter().map(labelled).collect()
    } else if is_logarithmic(axis) {
        let powers = range.0.floor() as i32..=range.1.ceil() as i32;
        let steps = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10_f64.powi(power)));
        let inside: Vec<f64> = steps.filter(|value| (range.0..=range.1).contains(&value.log10())).collect();
        // Over several decades, powers of ten are enough.
        let whole = |value: &f64| inside.len() <= 6 || (value.log10() - value.log10().round()).abs() < 1e-9;
        inside.iter().filter(|value| whole(value)).map(|value| labelled(&AxisValue::Number(*value))).collect()
    } else {
        ticks(range).into_iter().map(|at| (at, number(at))).collect()
    };
    PlotAxis { title: axis.label.clone(), range, ticks, grid: true }
}

/// Draws the points of an arm: their color is their mean.
pub(super) fn draw(sweep: &Sweep, surface: &ResponseSurface, (x, y): (usize, usize)) -> Figure {
    let mut figure = Figure {
        title: format!("{}: {}", surface.arm, measure(surface)),
        subtitle: "A dot is a point of the sweep.".into(),
        area: PlotArea::SQUARE,
        x: plot_axis(&sweep.axes[x]),
        y: plot_axis(&sweep.axes[y]),
        notes: map_notes(surface, "Ring"),
        ..Figure::default()
    };
    let selection = &surface.selection;
    let scale = ColorScale::new(selection.means.iter().copied(), surface.success);
    let radius = if surface.points.len() > FEW { 3.0 } else { 5.0 };
    // The best is drawn last, so that nothing hides it.
    let mut order: Vec<usize> = (0..surface.points.len()).collect();
    order.sort_by(|&a, &b| selection.means[a].total_cmp(&selection.means[b]).then(b.cmp(&a)));
    for i in order {
        let values = &sweep.points[surface.points[i].number as usize];
        let at = (position(&sweep.axes[x], &values[x]), position(&sweep.axes[y], &values[y]));
        figure.disc(at, radius + 0.8, GREY);
        figure.disc(at, radius, scale.color(selection.means[i]));
        if selection.indistinguishable(i) {
            figure.disc(at, radius / 3.0, INK);
        }
        if i == selection.best {
            figure.ring(at, radius + 3.5, Stroke::solid(VERMILION, 3.0));
        }
    }
    figure.scale = Some(scale);
    figure
}
