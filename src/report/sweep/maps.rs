//! Maps of two axes: a cell for each combination of values of a grid, a dot for each point that was drawn at random.

use super::surface::{AxisLevel, ResponseSurface, axis_value};
use crate::report::figure::axis::{PlotAxis, ticks};
use crate::report::figure::color::{ColorScale, GREY, INK, PALE, VERMILION, WHITE};
use crate::report::figure::svg::{Stroke, TextAnchor};
use crate::report::figure::{Figure, PlotArea};
use crate::report::format::{number, seeds};
use crate::report::statistics::{TABLE_RESAMPLES, select};
use crate::run_folder::sweep::{Axis, AxisValue, Scale};

/// Values of the other axes together up to which each has a map of its own.
const MOST_SLICES: usize = 6;
/// Cells at least this wide and high, in points, have their number written in.
const NUMBER_ROOM: (f64, f64) = (25.0, 15.0);
/// Points up to which they are drawn large.
const FEW: usize = 200;

/// A map without points; the best one will have a frame or a ring.
fn empty_map(surface: &ResponseSurface, subtitle: String, x: PlotAxis, y: PlotAxis, best: &str) -> Figure {
    Figure {
        title: format!("{}: {}", surface.arm, surface.measure()),
        subtitle,
        area: PlotArea::SQUARE,
        x,
        y,
        notes: vec![
            format!("Mean over n = {} at the last test. {best}: the highest mean.", seeds(surface.seeds.len())),
            format!(
                "Dot: not told apart from it, as the 95% percentile bootstrap interval of the difference on the same \
                 seeds ({} resamples) holds 0.",
                number(TABLE_RESAMPLES as f64)
            ),
        ],
        ..Figure::default()
    }
}

/// The heatmap over all points.
pub(super) fn heatmap(surface: &ResponseSurface, pair: (usize, usize)) -> Figure {
    let all: Vec<usize> = (0..surface.points.len()).collect();
    cells(surface, pair, &all, None)
}

/// Where there are further axes and few values on them, a map for each combination of those.
pub(super) fn slices(surface: &ResponseSurface, pair: (usize, usize)) -> Vec<Figure> {
    let others: Vec<usize> = surface.axes.iter().copied().filter(|&axis| axis != pair.0 && axis != pair.1).collect();
    let mut slices: Vec<(String, Vec<usize>)> = Vec::new();
    for i in 0..surface.points.len() {
        let label = surface.words(&others, i);
        match slices.iter_mut().find(|(known, _)| *known == label) {
            Some((_, points)) => points.push(i),
            None => slices.push((label, vec![i])),
        }
    }
    if others.is_empty() || !(2..=MOST_SLICES).contains(&slices.len()) {
        return Vec::new();
    }
    slices.iter().map(|(label, points)| cells(surface, pair, points, Some(label))).collect()
}

/// A map of some points: a cell is the mean over the points in it, so over all values of the other axes.
fn cells(surface: &ResponseSurface, (x, y): (usize, usize), points: &[usize], slice: Option<&str>) -> Figure {
    let of = |axis: usize| {
        let mut levels = surface.levels(axis);
        levels.iter_mut().for_each(|level| level.points.retain(|point| points.contains(point)));
        levels.retain(|level| !level.points.is_empty());
        levels
    };
    let (columns, rows) = (of(x), of(y));
    let places = (0..rows.len()).flat_map(|row| (0..columns.len()).map(move |column| (column, row)));
    let (mut filled, mut values, mut most, mut empty) = (Vec::new(), Vec::new(), 0, Vec::new());
    for (column, row) in places {
        let shared: Vec<usize> =
            columns[column].points.iter().copied().filter(|point| rows[row].points.contains(point)).collect();
        let place = (column as f64, row as f64);
        if shared.is_empty() {
            empty.push(place);
        } else {
            most = most.max(shared.len());
            filled.push(place);
            values.push(surface.mean_by_seed(&shared));
        }
    }
    let candidates: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
    let labels = |axis: usize, levels: &[AxisLevel]| {
        let labels = levels.iter().map(|level| level.label.clone()).collect();
        PlotAxis::categories(&surface.sweep.axes[axis].label, labels)
    };
    let subtitle = match slice {
        Some(slice) => format!("At {slice}."),
        None if most > 1 => format!("A cell: mean over up to {most} points on the other axes."),
        None => "A cell is a point of the sweep.".to_owned(),
    };
    let mut figure = empty_map(surface, subtitle, labels(x, &columns), labels(y, &rows), "Frame");
    let Some(selection) = select(&candidates) else { return figure };
    let scale = ColorScale::new(selection.means.iter().copied(), surface.success);
    // Not run, or without all seeds: crossed out.
    for (x, y) in empty {
        figure.line(&[(x, y), (x + 1.0, y + 1.0)], Stroke::solid(PALE, 1.0));
        figure.line(&[(x, y + 1.0), (x + 1.0, y)], Stroke::solid(PALE, 1.0));
    }
    let (width, height) = (figure.area.width / columns.len() as f64, figure.area.height / rows.len() as f64);
    let numbered = width >= NUMBER_ROOM.0 && height >= NUMBER_ROOM.1;
    for (i, (&(x, y), &mean)) in filled.iter().zip(&selection.means).enumerate() {
        figure.rectangle((x, y), (x + 1.0, y + 1.0), scale.color(mean), 1.0);
        if numbered {
            let number = if surface.success { format!("{:.0}", 100.0 * mean) } else { format!("{mean:.2}") };
            figure.text(&number, (x + 0.5, y + 0.5), 11.0, scale.ink(mean), TextAnchor::Middle);
        }
        if selection.indistinguishable(i) {
            let at = if numbered { (x + 1.0 - 5.0 / width, y + 1.0 - 5.0 / height) } else { (x + 0.5, y + 0.5) };
            figure.disc(at, 2.2_f64.min(width / 5.0), scale.ink(mean));
        }
    }
    let (x, y) = filled[selection.best];
    let frame = [(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0), (x, y)];
    figure.line(&frame, Stroke::solid(WHITE, 5.0));
    figure.line(&frame, Stroke::solid(VERMILION, 3.0));
    figure.scale = Some(scale);
    figure
}

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
pub(super) fn scatter(surface: &ResponseSurface, (x, y): (usize, usize)) -> Figure {
    let (x_axis, y_axis) = (&surface.sweep.axes[x], &surface.sweep.axes[y]);
    let subtitle = "A dot is a point of the sweep.".into();
    let mut figure = empty_map(surface, subtitle, plot_axis(x_axis), plot_axis(y_axis), "Ring");
    let selection = &surface.selection;
    let scale = ColorScale::new(selection.means.iter().copied(), surface.success);
    let radius = if surface.points.len() > FEW { 3.0 } else { 5.0 };
    // The best is drawn last, so that nothing hides it.
    let mut order: Vec<usize> = (0..surface.points.len()).collect();
    order.sort_by(|&a, &b| selection.means[a].total_cmp(&selection.means[b]).then(b.cmp(&a)));
    for i in order {
        let values = surface.values(i);
        let at = (position(x_axis, &values[x]), position(y_axis, &values[y]));
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
