//! Heatmaps of two axes of a grid: a cell for each combination of values.

use super::format::{map_notes, measure, point};
use super::main_effects::{AxisLevel, levels};
use super::response_surface::ResponseSurface;
use crate::report::figure::axis::PlotAxis;
use crate::report::figure::color::{ColorScale, PALE, VERMILION, WHITE};
use crate::report::figure::svg::{Stroke, TextAnchor};
use crate::report::figure::{Figure, PlotArea};
use crate::report::statistics::select;
use crate::run_folder::Sweep;

/// Values of the other axes together up to which each has a map of its own.
const MOST_SLICES: usize = 6;
/// Cells at least this wide and high, in points, have their number written in.
const NUMBER_ROOM: (f64, f64) = (25.0, 15.0);

/// The map over all points.
pub(super) fn draw(sweep: &Sweep, surface: &ResponseSurface, pair: (usize, usize)) -> Figure {
    let all: Vec<usize> = (0..surface.points.len()).collect();
    cells(sweep, surface, pair, &all, None)
}

/// Where there are further axes and few values on them, a map for each combination of those.
pub(super) fn draw_slices(sweep: &Sweep, surface: &ResponseSurface, pair: (usize, usize)) -> Vec<Figure> {
    let others: Vec<usize> = surface.axes.iter().copied().filter(|&axis| axis != pair.0 && axis != pair.1).collect();
    let mut slices: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, of) in surface.points.iter().enumerate() {
        let label = point(sweep, &others, of.number);
        match slices.iter_mut().find(|(known, _)| *known == label) {
            Some((_, points)) => points.push(i),
            None => slices.push((label, vec![i])),
        }
    }
    if others.is_empty() || !(2..=MOST_SLICES).contains(&slices.len()) {
        return Vec::new();
    }
    slices.iter().map(|(label, points)| cells(sweep, surface, pair, points, Some(label))).collect()
}

/// A map of some points: a cell is the mean over the points in it, so over all values of the other axes.
fn cells(
    sweep: &Sweep,
    surface: &ResponseSurface,
    (x, y): (usize, usize),
    points: &[usize],
    slice: Option<&str>,
) -> Figure {
    let of = |axis: usize| {
        let mut levels = levels(sweep, surface, axis);
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
    let labels = |levels: &[AxisLevel]| levels.iter().map(|level| level.label.clone()).collect();
    let area = PlotArea::SQUARE;
    let mut figure = Figure {
        title: format!("{}: {}", surface.arm, measure(surface)),
        subtitle: match slice {
            Some(slice) => format!("At {slice}."),
            None if most > 1 => format!("A cell: mean over up to {most} points on the other axes."),
            None => "A cell is a point of the sweep.".to_owned(),
        },
        area,
        x: PlotAxis::categories(&sweep.axes[x].label, labels(&columns)),
        y: PlotAxis::categories(&sweep.axes[y].label, labels(&rows)),
        notes: map_notes(surface, "Frame"),
        ..Figure::default()
    };
    let Some(selection) = select(&candidates) else { return figure };
    let scale = ColorScale::new(selection.means.iter().copied(), surface.success);
    // Not run, or without all seeds: crossed out.
    for (x, y) in empty {
        figure.line(&[(x, y), (x + 1.0, y + 1.0)], Stroke::solid(PALE, 1.0));
        figure.line(&[(x, y + 1.0), (x + 1.0, y)], Stroke::solid(PALE, 1.0));
    }
    let (width, height) = (area.width / columns.len() as f64, area.height / rows.len() as f64);
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
