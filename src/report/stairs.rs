//! Step curves with bands: performance profiles and survival curves.

use super::axes::{self, Axis};
use super::canvas::{Anchor, Canvas, GREY, INK};
use super::curves::{COLORS, MOST_SMALL, marker};
use super::statistics::Interval;

/// Markers along a curve, so that curves differ in print without colour too.
const MARKERS: usize = 3;
const WIDTH: f64 = 470.0;
const LEFT: f64 = 66.0;
const TOP: f64 = 62.0;
const BOTTOM: f64 = 322.0;
const RIGHT: f64 = 454.0;
const LABEL_ROOM: f64 = 17.0;
const NOTE_ROOM: f64 = 15.0;

/// From this x on the curve is at y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stair {
    /// On the x axis.
    pub x: f64,
    /// A share.
    pub y: f64,
    /// Its interval.
    pub band: Interval,
}

/// A curve that is 1 before its first stair.
#[derive(Debug, Clone, PartialEq)]
pub struct Staircase {
    /// What the legend calls it.
    pub label: String,
    /// By ascending x.
    pub stairs: Vec<Stair>,
    /// Where the curve ends.
    pub end: f64,
}

/// What a figure of step curves shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its heading.
    pub title: String,
    /// A line below the heading that says what was measured.
    pub subtitle: String,
    /// Lines below the legend: how many learners, which interval.
    pub notes: Vec<String>,
    /// Title of the x axis, with its unit.
    pub x_title: String,
    /// Title of the y axis, whose values are shares.
    pub y_title: String,
    /// Ends of the x axis.
    pub x_range: (f64, f64),
    /// Whether x is a share too.
    pub x_percent: bool,
    /// At most [`MOST_SMALL`] are drawn.
    pub curves: Vec<Staircase>,
}

/// Draws the figure as SVG.
pub fn draw(figure: &Figure) -> String {
    let curves = &figure.curves[..figure.curves.len().min(MOST_SMALL)];
    let legend = BOTTOM + 58.0;
    let notes = legend + LABEL_ROOM * curves.len().div_ceil(2) as f64 + 4.0;
    let mut canvas = Canvas::new(WIDTH, notes + NOTE_ROOM * figure.notes.len() as f64, &figure.title);
    canvas.text(&figure.title, (16.0, 19.0), 15.0, INK, Anchor::Start);
    canvas.text(&figure.subtitle, (16.0, TOP - 23.0), 11.5, GREY, Anchor::Start);
    let (title, points) = (figure.x_title.clone(), (LEFT, RIGHT));
    let x = Axis { title, range: figure.x_range, points, percent: figure.x_percent };
    let y = Axis { title: figure.y_title.clone(), range: (0.0, 1.0), points: (BOTTOM, TOP), percent: true };
    axes::draw(&mut canvas, &x, &y);
    for (i, curve) in curves.iter().enumerate() {
        let low = outline(curve, &x, &y, |stair| stair.band.low);
        let high = outline(curve, &x, &y, |stair| stair.band.high);
        let band: Vec<_> = low.into_iter().chain(high.into_iter().rev()).collect();
        canvas.polygon(&band, COLORS[i], 0.12);
    }
    for (i, curve) in curves.iter().enumerate() {
        canvas.line(&outline(curve, &x, &y, |stair| stair.y), COLORS[i], 2.0);
        for number in 0..MARKERS {
            let share = (number as f64 + (i as f64 + 1.0) / (curves.len() as f64 + 1.0)) / MARKERS as f64;
            let at = figure.x_range.0 + (curve.end - figure.x_range.0) * share;
            let before = curve.stairs.iter().rev().find(|stair| stair.x <= at);
            marker(&mut canvas, i, (x.place(at), y.place(before.map_or(1.0, |stair| stair.y))), COLORS[i]);
        }
        let (left, at) = (LEFT + (RIGHT - LEFT) / 2.0 * (i % 2) as f64, legend + LABEL_ROOM * (i / 2) as f64);
        canvas.line(&[(left, at), (left + 20.0, at)], COLORS[i], 2.0);
        marker(&mut canvas, i, (left + 10.0, at), COLORS[i]);
        canvas.text(&curve.label, (left + 26.0, at), 12.0, INK, Anchor::Start);
    }
    for (i, note) in figure.notes.iter().enumerate() {
        canvas.text(note, (16.0, notes + NOTE_ROOM * i as f64), 11.5, GREY, Anchor::Start);
    }
    canvas.finish()
}

/// Corners of a curve, or of an edge of its band.
fn outline(curve: &Staircase, x: &Axis, y: &Axis, of: fn(&Stair) -> f64) -> Vec<(f64, f64)> {
    let mut height = y.place(1.0);
    let mut corners = vec![(x.points.0, height)];
    for stair in &curve.stairs {
        let (at, next) = (x.place(stair.x), y.place(of(stair)));
        if next != height {
            corners.extend([(at, height), (at, next)]);
            height = next;
        }
    }
    corners.push((x.place(curve.end), height));
    corners
}
