//! Success by the room in which test trials start.

use super::comparison::Comparison;
use super::curves::{self, Curve, Figure, Point};
use super::figures::{Drawing, SUCCESS, Section, file_word};
use super::numbers::{percent, percent_with, seeds};
use super::statistics::{BAND_RESAMPLES, Statistic, TABLE_RESAMPLES, bootstrap, mean, quantile, sorted};
use super::summary::{Bound, Cell, Score, Series};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Trials after which the paper judges the hierarchy, besides the last ones.
pub const MOMENTS: [u32; 2] = [20, 60];
/// Share of seeds that are worse than the quantile that the table shows.
const WORST: f64 = 0.05;

/// Rooms from which tests of the compared skill start: index and name.
pub fn of<'a>(comparison: &Comparison<'_>, rooms: &'a [String]) -> Vec<(usize, &'a str)> {
    let cells = || comparison.hierarchical.iter().map(|series| series.last());
    let started = |room: usize| cells().any(|cell| !cell.rooms[room].is_empty());
    let mut rooms: Vec<_> =
        rooms.iter().enumerate().filter(|(room, _)| started(*room)).map(|(room, name)| (room, name.as_str())).collect();
    rooms.sort_by_key(|(_, name)| *name);
    rooms
}

/// A figure for the first hierarchical and the first monolithic arm: a curve per room.
pub fn draw(comparison: &Comparison<'_>, rooms: &[(usize, &str)]) -> Vec<Drawing> {
    let longest = comparison.leaders().map(|series| series.last().trials).max().unwrap_or(0);
    let ends = curves::Ends { x: f64::from(longest), y: (0.0, 1.0) };
    let figure = |series: &Series| Figure {
        title: format!("{} by starting room", series.label),
        subtitle: SUCCESS.subtitle.into(),
        notes: vec![format!(
            "Mean over n = {}; bands: 95% percentile bootstrap interval.",
            seeds(series.last().scores.len())
        )],
        x_title: "training trials".into(),
        y_title: SUCCESS.y_title.into(),
        percent: true,
        bound: None,
        curves: rooms.iter().map(|&room| curve(series, room)).collect(),
        small: true,
        ends: Some(ends),
    };
    let drawing = |series: &Series| Drawing {
        name: format!("rooms-{}", file_word(&series.label)),
        section: Section::Rooms,
        svg: curves::draw(&figure(series)),
    };
    let curved = comparison.leaders().filter(|series| series.cells.len() > 1);
    curved.collect::<Vec<_>>().into_par_iter().map(drawing).collect()
}

fn curve(series: &Series, (room, name): (usize, &str)) -> Curve {
    let tested = series.cells.iter().filter(|cell| !cell.rooms[room].is_empty());
    let point = |cell: &Cell| {
        let values = success(cell, room);
        Point { x: f64::from(cell.trials), y: mean(&values), band: bootstrap(&values, mean, BAND_RESAMPLES) }
    };
    Curve { label: format!("from room {name}"), points: tested.map(point).collect() }
}

/// Success of each seed that was tested from a room.
pub fn success(cell: &Cell, room: usize) -> Vec<f64> {
    cell.rooms[room].iter().map(Score::success).collect()
}

/// The value that only 5 % of the seeds fall short of.
pub fn low_quantile(sorted: &[f64]) -> f64 {
    quantile(sorted, WORST)
}

/// The tests of an arm that the table shows: the paper's moments for the leaders, and the last one.
fn moments(series: &Series, leader: bool) -> Vec<&Cell> {
    let early = MOMENTS.iter().filter(|_| leader).filter_map(|trials| series.near(*trials));
    let mut cells: Vec<&Cell> = early.chain([series.last()]).collect();
    cells.dedup_by_key(|cell| cell.trials);
    cells
}

/// Rows of the table by arm, test and room.
pub fn table(comparison: &Comparison<'_>, rooms: &[(usize, &str)]) -> Vec<Value> {
    let leaders: Vec<&str> = comparison.leaders().map(|series| series.label.as_str()).collect();
    let all = comparison.hierarchical.iter().chain(&comparison.monolithic);
    let rows: Vec<(&Series, &Cell)> = all
        .flat_map(|series| {
            let cells = moments(series, leaders.contains(&series.label.as_str()));
            cells.into_iter().map(move |cell| (*series, cell))
        })
        .collect();
    rows.into_par_iter().map(|(series, cell)| row(series, cell, rooms)).collect()
}

fn row(series: &Series, cell: &Cell, rooms: &[(usize, &str)]) -> Value {
    let shown = |values: &[f64], statistic: Statistic| {
        let sorted = sorted(values);
        if sorted.is_empty() {
            return "no tests".to_owned();
        }
        percent_with(statistic(&sorted), bootstrap(&sorted, statistic, TABLE_RESAMPLES))
    };
    let overall = cell.values(Score::success);
    context! {
        arm => series.label.as_str(),
        trials => cell.trials,
        seeds => cell.scores.len(),
        overall => shown(&overall, mean),
        worst => shown(&overall, low_quantile),
        rooms => rooms.iter().map(|&(room, _)| shown(&success(cell, room), mean)).collect::<Vec<_>>(),
    }
}

/// The planner's success from each room, as the last row of the table.
pub fn bound(bound: &Bound, rooms: &[(usize, &str)]) -> Vec<String> {
    let rates = rooms.iter().map(|&(room, _)| match bound.rooms[room] {
        score if score.episodes > 0 => percent(score.success()),
        _ => "no tests".to_owned(),
    });
    rates.collect()
}
