//! Maps of two axes: a cell for each combination of values, or for a random design a dot for each point.

use super::levels::Level;
use super::plane::{self, Mark, Plane};
use super::surface::Surface;
use super::{levels, scatter, words};
use crate::report::figures::{Drawing, Section, file_word};
use crate::report::numbers::seeds;
use crate::report::statistics::select;
use crate::run_folder::Sweep;
use crate::run_folder::sweep::Design;

/// Pairs of axes that are drawn for an arm.
const MOST_PAIRS: usize = 6;
/// Values of the other axes together up to which each has a map of its own.
const MOST_SLICES: usize = 6;

/// The maps of an arm: for each pair of axes one over all points. Where there are further axes and few values on them,
/// the first pair also has one for each of their combinations.
pub(super) fn draw(sweep: &Sweep, surface: &Surface) -> Vec<Drawing> {
    let axes = &surface.axes;
    let pairs = axes.iter().enumerate().flat_map(|(i, &x)| axes[i + 1..].iter().map(move |&y| (x, y)));
    let pairs: Vec<(usize, usize)> = pairs.take(MOST_PAIRS).collect();
    let all: Vec<usize> = (0..surface.points.len()).collect();
    let name = |(x, y): (usize, usize)| {
        let key = |axis: usize| file_word(&sweep.axes[axis].key);
        format!("sweep-{}-{}-{}", file_word(&surface.arm), key(x), key(y))
    };
    let drawing = |name: String, svg: String| Drawing { name, section: Section::Sweep(surface.arm.clone()), svg };
    let mut drawings = Vec::new();
    for &pair in &pairs {
        let svg = match sweep.design {
            Design::Random => scatter::draw(sweep, surface, pair),
            Design::Grid => cells(sweep, surface, pair, &all, None),
        };
        drawings.push(drawing(name(pair), svg));
    }
    let (Some(&first), Design::Grid, true) = (pairs.first(), sweep.design, axes.len() > 2) else { return drawings };
    let others: Vec<usize> = axes.iter().copied().filter(|&axis| axis != first.0 && axis != first.1).collect();
    let slices = slices(sweep, surface, &others);
    if (2..=MOST_SLICES).contains(&slices.len()) {
        for (i, (label, points)) in slices.iter().enumerate() {
            let svg = cells(sweep, surface, first, points, Some(label));
            drawings.push(drawing(format!("{}-slice-{}", name(first), i + 1), svg));
        }
    }
    drawings
}

/// The points with each combination of values on some axes, and those values in words.
fn slices(sweep: &Sweep, surface: &Surface, others: &[usize]) -> Vec<(String, Vec<usize>)> {
    let mut slices: Vec<(String, Vec<usize>)> = Vec::new();
    for (i, point) in surface.points.iter().enumerate() {
        let values = &sweep.points[point.number as usize];
        let label = others.iter().map(|&axis| format!("{} {}", sweep.axes[axis].label, words::value(&values[axis])));
        let label = label.collect::<Vec<_>>().join(", ");
        match slices.iter_mut().find(|(known, _)| *known == label) {
            Some((_, points)) => points.push(i),
            None => slices.push((label, vec![i])),
        }
    }
    slices
}

/// A map of some points of a grid: a cell is the mean over the points in it, so over all values of the other axes.
fn cells(sweep: &Sweep, surface: &Surface, (x, y): (usize, usize), points: &[usize], slice: Option<&str>) -> String {
    let of = |axis: usize| {
        let mut levels = levels(sweep, surface, axis);
        levels.iter_mut().for_each(|level| level.points.retain(|point| points.contains(point)));
        levels.retain(|level| !level.points.is_empty());
        levels
    };
    let (columns, rows) = (of(x), of(y));
    let mut places = Vec::new();
    let mut cells: Vec<Vec<f64>> = Vec::new();
    let mut most = 0;
    for (row, (column, across)) in
        rows.iter().enumerate().flat_map(|(row, _)| columns.iter().enumerate().map(move |column| (row, column)))
    {
        let shared: Vec<usize> =
            across.points.iter().copied().filter(|point| rows[row].points.contains(point)).collect();
        if !shared.is_empty() {
            most = most.max(shared.len());
            places.push((column, row));
            let mean = |seed: usize| {
                shared.iter().map(|&point| surface.points[point].values[seed]).sum::<f64>() / shared.len() as f64
            };
            cells.push((0..surface.seeds.len()).map(mean).collect());
        }
    }
    let candidates: Vec<&[f64]> = cells.iter().map(Vec::as_slice).collect();
    let Some(selection) = select(&candidates) else { return String::new() };
    let marks = places.iter().enumerate().map(|(i, &place)| Mark {
        place,
        value: selection.means[i],
        best: i == selection.best,
        undecided: selection.indistinguishable(i),
    });
    let label = |levels: &[Level]| levels.iter().map(|level| level.label.clone()).collect::<Vec<_>>();
    let what = match slice {
        Some(slice) => format!("At {slice}."),
        None if most > 1 => format!("A cell: mean over up to {most} points on the other axes."),
        None => "A cell is a point of the sweep.".to_owned(),
    };
    plane::draw_cells(&Plane {
        title: format!("{}: {}", surface.arm, words::measure(surface)),
        subtitle: what,
        x_title: sweep.axes[x].label.clone(),
        y_title: sweep.axes[y].label.clone(),
        columns: label(&columns),
        rows: label(&rows),
        marks: marks.collect(),
        percent: surface.success,
        notes: notes(surface.seeds.len()),
    })
}

/// What the marks of a map mean.
pub(super) fn notes(count: usize) -> Vec<String> {
    vec![
        format!("Mean over n = {} at the last test. Frame: the highest mean.", seeds(count)),
        "Dot: not told apart from it, as the 95% percentile bootstrap interval of".into(),
        "the difference on the same seeds (10,000 resamples) holds 0.".into(),
    ]
}
