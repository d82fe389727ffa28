//! Curves with bands over seeds, labelled at their ends.

use super::axes::{self, Axis};
use super::canvas::{Anchor, Canvas, GREY, INK, text_width};
use super::statistics::Interval;
use plotters::style::RGBColor;

/// Okabe and Ito's colours, which colour-blind readers can tell apart, without the yellow that white paper swallows.
const COLORS: [RGBColor; 7] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x00, 0x00, 0x00),
];
/// More curves than this cannot be told apart.
pub const MOST_CURVES: usize = 12;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 450.0;
const LEFT: f64 = 76.0;
const TOP: f64 = 66.0;
const BOTTOM: f64 = 86.0;
/// Size of the curves' labels and the room that each takes.
const LABEL: f64 = 13.0;
const LABEL_ROOM: f64 = 17.0;
/// Length of the line that leads from a curve's end to its label.
const LEADER: f64 = 22.0;

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// On the x axis.
    pub x: f64,
    /// Mean over seeds.
    pub y: f64,
    /// Its interval.
    pub band: Interval,
}

/// A curve: points by ascending x.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What stands at its end.
    pub label: String,
    /// At least one.
    pub points: Vec<Point>,
}

/// What a figure of curves shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its heading.
    pub title: String,
    /// A line below the heading that says what was measured.
    pub subtitle: String,
    /// Lines below the axes: how many seeds, which interval.
    pub notes: Vec<String>,
    /// Title of the x axis, with its unit.
    pub x_title: String,
    /// Title of the y axis, with its unit.
    pub y_title: String,
    /// Whether values are shares, shown from 0 to 100 percent.
    pub percent: bool,
    /// A value to compare with, drawn dashed, and its label.
    pub bound: Option<(String, f64)>,
    /// At most [`MOST_CURVES`] are drawn.
    pub curves: Vec<Curve>,
}

/// Draws the figure as SVG.
pub fn draw(figure: &Figure) -> String {
    let curves = &figure.curves[..figure.curves.len().min(MOST_CURVES)];
    let bound_label = figure.bound.iter().map(|(label, _)| label);
    let widest = curves.iter().map(|curve| &curve.label).chain(bound_label).map(|label| text_width(label, LABEL));
    let right = LEADER + 22.0 + widest.fold(60.0, f64::max).min(300.0);
    let all = || curves.iter().flat_map(|curve| &curve.points);
    let high_x = all().map(|point| point.x).fold(0.0, f64::max);
    let high_y = all().map(|point| point.band.high.max(point.y)).chain(figure.bound.iter().map(|bound| bound.1));
    let high_y = if figure.percent { 1.0 } else { axes::upper_end(high_y.fold(0.0, f64::max)) };
    let x = Axis {
        title: figure.x_title.clone(),
        range: (0.0, if high_x > 0.0 { high_x } else { 1.0 }),
        points: (LEFT, WIDTH - right),
        percent: false,
    };
    let y = Axis {
        title: figure.y_title.clone(),
        range: (0.0, high_y),
        points: (HEIGHT - BOTTOM, TOP),
        percent: figure.percent,
    };
    let mut canvas = Canvas::new(WIDTH, HEIGHT, &figure.title);
    canvas.text(&figure.title, (16.0, 22.0), 18.0, INK, Anchor::Start);
    canvas.text(&figure.subtitle, (16.0, 43.0), 12.5, GREY, Anchor::Start);
    axes::draw(&mut canvas, &x, &y);
    for (i, note) in figure.notes.iter().enumerate() {
        canvas.text(note, (16.0, HEIGHT - 27.0 + 16.0 * i as f64), 11.5, GREY, Anchor::Start);
    }
    for (i, curve) in curves.iter().enumerate() {
        draw_band(&mut canvas, &x, &y, &curve.points, COLORS[i % COLORS.len()]);
    }
    if let Some((_, value)) = figure.bound {
        let at = y.place(value);
        canvas.dashes((x.points.0, at), (x.points.1, at), INK, 1.4, 5.0);
    }
    for (i, curve) in curves.iter().enumerate() {
        let color = COLORS[i % COLORS.len()];
        let points: Vec<_> = curve.points.iter().map(|point| (x.place(point.x), y.place(point.y))).collect();
        canvas.line(&points, color, 2.0);
        for &point in &points {
            marker(&mut canvas, i, point, color);
        }
    }
    draw_labels(&mut canvas, figure, curves, &x, &y);
    canvas.finish()
}

fn draw_band(canvas: &mut Canvas, x: &Axis, y: &Axis, points: &[Point], color: RGBColor) {
    let low = points.iter().map(|point| (x.place(point.x), y.place(point.band.low)));
    let high = points.iter().rev().map(|point| (x.place(point.x), y.place(point.band.high)));
    let outline: Vec<_> = low.chain(high).collect();
    if points.len() > 1 {
        canvas.polygon(&outline, color, 0.16);
    } else {
        canvas.line(&outline, color, 1.5);
    }
}

/// A shape per curve, so that curves differ in print without colour too.
fn marker(canvas: &mut Canvas, index: usize, (x, y): (f64, f64), color: RGBColor) {
    let outline: &[(f64, f64)] = match index % 4 {
        0 => return canvas.disc((x, y), 3.6, color),
        1 => &[(-3.2, -3.2), (3.2, -3.2), (3.2, 3.2), (-3.2, 3.2)],
        2 => &[(0.0, -4.4), (4.2, 3.2), (-4.2, 3.2)],
        _ => &[(0.0, -4.6), (4.6, 0.0), (0.0, 4.6), (-4.6, 0.0)],
    };
    let outline: Vec<_> = outline.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    canvas.polygon(&outline, color, 1.0);
}

/// Labels stand right of the axes in the order of the curves' ends, pushed apart where they would overlap.
fn draw_labels(canvas: &mut Canvas, figure: &Figure, curves: &[Curve], x: &Axis, y: &Axis) {
    struct Label<'figure> {
        text: &'figure str,
        curve: Option<usize>,
        end: (f64, f64),
    }
    let mut labels = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        if let Some(last) = curve.points.last() {
            labels.push(Label { text: &curve.label, curve: Some(i), end: (x.place(last.x), y.place(last.y)) });
        }
    }
    if let Some((text, value)) = &figure.bound {
        labels.push(Label { text, curve: None, end: (x.points.1, y.place(*value)) });
    }
    labels.sort_by(|a, b| a.end.1.total_cmp(&b.end.1));
    let ends: Vec<f64> = labels.iter().map(|label| label.end.1).collect();
    let left = x.points.1 + LEADER;
    for (label, at) in labels.iter().zip(spread(&ends, LABEL_ROOM, (TOP - 8.0, y.points.0))) {
        let color = label.curve.map_or(INK, |i| COLORS[i % COLORS.len()]);
        // A leader that crosses the plot would look like a curve; there the marker alone tells whose label it is.
        if label.end.0 > x.points.1 - 6.0 {
            let elbow = (x.points.1 + 5.0, label.end.1);
            canvas.line(&[label.end, elbow, (left - 3.0, at)], color, 0.75);
        }
        match label.curve {
            Some(i) => marker(canvas, i, (left + 4.0, at), color),
            None => canvas.dashes((left, at), (left + 9.0, at), INK, 1.4, 3.0),
        }
        canvas.text(label.text, (left + 13.0, at), LABEL, INK, Anchor::Start);
    }
}

/// Moves ascending positions apart to a least distance, as near to where they were as one pass each way brings them,
/// and inside the limits as long as there is room.
pub fn spread(positions: &[f64], distance: f64, (low, high): (f64, f64)) -> Vec<f64> {
    let mut placed: Vec<f64> = positions.to_vec();
    let count = placed.len();
    // Runs of crowded labels are centred on the mean of their ends.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    for &position in positions {
        let mut group = (position, 1);
        while let Some(&(sum, size)) = groups.last() {
            let (a, b) = (sum / size as f64, group.0 / group.1 as f64);
            if b - a >= distance * (size + group.1) as f64 / 2.0 {
                break;
            }
            group = (sum + group.0, size + group.1);
            groups.pop();
        }
        groups.push(group);
    }
    let mut next = 0;
    for (sum, size) in groups {
        for i in 0..size {
            placed[next] = sum / size as f64 + distance * (i as f64 - (size - 1) as f64 / 2.0);
            next += 1;
        }
    }
    for i in (0..count).rev() {
        let limit = high - distance * (count - 1 - i) as f64;
        placed[i] = placed[i].min(limit);
    }
    for (i, place) in placed.iter_mut().enumerate() {
        *place = place.max(low + distance * i as f64);
    }
    placed
}
