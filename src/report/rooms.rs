//! Success by the room in which test trials start.

use super::comparison::Comparison;
use super::figure::axis::PlotAxis;
use super::figure::curves::{Curve, CurvePoint};
use super::figure::{Figure, PlotArea};
use super::format::{file_word, seeds};
use super::learning_curves::SUCCESS;
use super::statistics::{BAND_RESAMPLES, TABLE_RESAMPLES, bootstrap, mean, mean_of, quantile};
use super::summary::{PlannerBound, Score, SeedScores, Series};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Trials after which the paper judges the hierarchy, besides the last ones.
pub const MOMENTS: [u32; 2] = [20, 60];
/// Share of seeds that are worse than the quantile that the table shows.
const WORST: f64 = 0.05;

/// Rooms from which tests of the compared skill start: index and name.
pub fn of<'a>(comparison: &Comparison<'_>, rooms: &'a [String]) -> Vec<(usize, &'a str)> {
    let started = |room: usize| comparison.hierarchical.iter().any(|series| !series.last().rooms[room].is_empty());
    let mut rooms: Vec<_> =
        rooms.iter().enumerate().filter(|(room, _)| started(*room)).map(|(room, name)| (room, name.as_str())).collect();
    rooms.sort_by_key(|(_, name)| *name);
    rooms
}

/// A figure for the first hierarchical and the first monolithic arm: a curve per room.
pub fn draw(comparison: &Comparison<'_>, rooms: &[(usize, &str)]) -> Vec<Figure> {
    let longest = comparison.leaders().map(|series| series.last().trials).max().unwrap_or(0);
    let figure = |series: &Series| {
        let figure = Figure {
            name: format!("rooms-{}", file_word(&series.label)),
            section: "rooms",
            title: format!("{} by starting room", series.label),
            subtitle: SUCCESS.subtitle.into(),
            area: PlotArea::SMALL,
            x: PlotAxis::linear(SUCCESS.x_title(), (0.0, f64::from(longest.max(1))), false),
            y: PlotAxis::linear(SUCCESS.y_title, (0.0, 1.0), true).with_grid(),
            notes: vec![format!(
                "Mean over n = {}; bands: 95% percentile bootstrap interval.",
                seeds(series.last().scores.len())
            )],
            ..Figure::default()
        };
        figure.with_curves(&rooms.iter().map(|&room| curve(series, room)).collect::<Vec<_>>(), None)
    };
    let curved: Vec<_> = comparison.leaders().filter(|series| series.tests.len() > 1).collect();
    curved.into_par_iter().map(figure).collect()
}

fn curve(series: &Series, (room, name): (usize, &str)) -> Curve {
    let tested = series.tests.iter().filter(|test| !test.rooms[room].is_empty());
    let point = |test: &SeedScores| CurvePoint {
        x: f64::from(test.trials),
        y: bootstrap(&success(test, room), mean, BAND_RESAMPLES),
    };
    Curve::new(format!("from room {name}"), tested.map(point).collect())
}

/// Success of each seed that was tested from a room.
pub fn success(test: &SeedScores, room: usize) -> Vec<f64> {
    test.rooms[room].iter().map(Score::success).collect()
}

/// The value that only 5 % of the seeds fall short of.
pub fn low_quantile(sorted: &[f64]) -> f64 {
    quantile(sorted, WORST)
}

/// Rows of the table by arm, test and room: the paper's moments for the leaders, and every arm's last test.
pub fn table(comparison: &Comparison<'_>, rooms: &[(usize, &str)]) -> Vec<Value> {
    let leaders: Vec<&str> = comparison.leaders().map(|series| series.label.as_str()).collect();
    let moments = |series: &&'_ Series| {
        let early = MOMENTS.iter().filter(|_| leaders.contains(&series.label.as_str()));
        let mut tests: Vec<&SeedScores> =
            early.filter_map(|trials| series.near(*trials)).chain([series.last()]).collect();
        tests.dedup_by_key(|test| test.trials);
        tests.into_iter().map(|test| (series.label.clone(), test.clone())).collect::<Vec<_>>()
    };
    let all: Vec<_> = comparison.hierarchical.iter().chain(&comparison.monolithic).flat_map(moments).collect();
    let row = |(label, test): &(String, SeedScores)| {
        let overall = test.values(Score::success);
        context! {
            arm => label,
            trials => test.trials,
            seeds => test.scores.len(),
            overall => mean_of(&overall),
            worst => bootstrap(&overall, low_quantile, TABLE_RESAMPLES),
            rooms => rooms.iter().map(|&(room, _)| mean_of(&success(test, room))).collect::<Vec<_>>(),
        }
    };
    all.par_iter().map(row).collect()
}

/// The planner's success from each room, as the last row of the table; NaN where it has no tests.
pub fn bound(bound: &PlannerBound, rooms: &[(usize, &str)]) -> Vec<f64> {
    rooms.iter().map(|&(room, _)| bound.rooms[room].success()).collect()
}
