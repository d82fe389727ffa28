//! Curves with bands over seeds: a large figure labels them at their ends, a small one in a legend below.

use super::axes::{self, Axis};
use super::canvas::{Anchor, Canvas, GREY, INK, text_width};
use super::statistics::Interval;
use plotters::style::RGBColor;

/// Okabe and Ito's colours, which colour-blind readers can tell apart, without the yellow that white paper swallows.
pub(super) const COLORS: [RGBColor; 7] = [
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

/// More curves than this cannot be told apart in a small figure.
pub const MOST_SMALL: usize = 7;

/// Size of the curves' labels and the room that each takes.
const LABEL: f64 = 13.0;
const LABEL_ROOM: f64 = 17.0;
/// Length of the line that leads from a curve's end to its label.
const LEADER: f64 = 22.0;
/// Room that a note takes.
const NOTE_ROOM: f64 = 16.0;

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
    /// Drawn small, to stand beside another figure.
    pub small: bool,
    /// Ends of the axes, where figures are to be compared; as the curves need if not given.
    pub ends: Option<Ends>,
}

/// How far the axes reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ends {
    /// Greatest x; the least is 0.
    pub x: f64,
    /// Least and greatest y.
    pub y: (f64, f64),
}

impl Ends {
    /// What some curves need, of which `percent` are shares.
    pub fn of<'a>(curves: impl IntoIterator<Item = &'a Curve>, percent: bool) -> Self {
        let mut ends = Self { x: 0.0, y: (0.0, 0.0) };
        for point in curves.into_iter().flat_map(|curve| &curve.points) {
            ends.x = ends.x.max(point.x);
            ends.y = (ends.y.0.min(point.band.low.min(point.y)), ends.y.1.max(point.band.high.max(point.y)));
        }
        ends.y = if percent { (0.0, 1.0) } else { ends.y };
        ends
    }
}

/// Where the parts of a figure lie.
struct Layout {
    width: f64,
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    title: f64,
    subtitle: f64,
}

impl Layout {
    fn new(figure: &Figure, curves: &[Curve]) -> Self {
        if figure.small {
            let rows = (curves.len() + usize::from(figure.bound.is_some())).div_ceil(2);
            let bottom = 64.0 + LABEL_ROOM * rows as f64 + NOTE_ROOM * figure.notes.len() as f64;
            return Self {
                width: 470.0,
                height: 298.0 + bottom,
                left: 66.0,
                right: 16.0,
                top: 62.0,
                bottom,
                title: 15.0,
                subtitle: 11.5,
            };
        }
        let bound = figure.bound.iter().map(|(label, _)| label);
        let widths = curves.iter().map(|curve| &curve.label).chain(bound).map(|label| text_width(label, LABEL));
        let right = LEADER + 22.0 + widths.fold(60.0, f64::max).min(300.0);
        Self { width: 760.0, height: 450.0, left: 76.0, right, top: 66.0, bottom: 86.0, title: 18.0, subtitle: 12.5 }
    }
}

/// Draws the figure as SVG.
pub fn draw(figure: &Figure) -> String {
    let most = if figure.small { MOST_SMALL } else { MOST_CURVES };
    let curves = &figure.curves[..figure.curves.len().min(most)];
    let layout = Layout::new(figure, curves);
    let mut ends = figure.ends.unwrap_or_else(|| Ends::of(curves, figure.percent));
    if let Some((_, bound)) = figure.bound {
        ends.y = (ends.y.0.min(bound), ends.y.1.max(bound));
    }
    let x = Axis {
        title: figure.x_title.clone(),
        range: (0.0, if ends.x > 0.0 { ends.x } else { 1.0 }),
        points: (layout.left, layout.width - layout.right),
        percent: false,
    };
    let y = Axis {
        title: figure.y_title.clone(),
        range: (axes::lower_end(ends.y.0), axes::upper_end(ends.y.1)),
        points: (layout.height - layout.bottom, layout.top),
        percent: figure.percent,
    };
    let mut canvas = Canvas::new(layout.width, layout.height, &figure.title);
    canvas.text(&figure.title, (16.0, 4.0 + layout.title), layout.title, INK, Anchor::Start);
    canvas.text(&figure.subtitle, (16.0, layout.top - 23.0), layout.subtitle, GREY, Anchor::Start);
    axes::draw(&mut canvas, &x, &y);
    let notes = if figure.small { figure.notes.len() } else { 2 };
    let first_note = layout.height + 4.0 - NOTE_ROOM * notes as f64;
    for (i, note) in figure.notes.iter().enumerate() {
        canvas.text(note, (16.0, first_note + NOTE_ROOM * i as f64), 11.5, GREY, Anchor::Start);
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
        match flat(curve) {
            true => canvas.dashes(points[0], (x.points.1, points[0].1), color, 1.6, 3.0),
            false => canvas.line(&points, color, 2.0),
        }
        for &point in &points {
            marker(&mut canvas, i, point, color);
        }
    }
    if figure.small {
        draw_legend(&mut canvas, figure, curves, (&x, &y));
    } else {
        draw_labels(&mut canvas, figure, curves, (&x, &y));
    }
    canvas.finish()
}

/// Whether a curve is a single test before any trial: of an arm that does not learn, so it is drawn across the figure.
fn flat(curve: &Curve) -> bool {
    curve.points.len() == 1 && curve.points[0].x == 0.0
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
pub(super) fn marker(canvas: &mut Canvas, index: usize, (x, y): (f64, f64), color: RGBColor) {
    let outline: &[(f64, f64)] = match index % 4 {
        0 => return canvas.disc((x, y), 3.6, color),
        1 => &[(-3.2, -3.2), (3.2, -3.2), (3.2, 3.2), (-3.2, 3.2)],
        2 => &[(0.0, -4.4), (4.2, 3.2), (-4.2, 3.2)],
        _ => &[(0.0, -4.6), (4.6, 0.0), (0.0, 4.6), (-4.6, 0.0)],
    };
    let outline: Vec<_> = outline.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    canvas.polygon(&outline, color, 1.0);
}

/// Two columns below the x axis.
fn draw_legend(canvas: &mut Canvas, figure: &Figure, curves: &[Curve], (x, y): (&Axis, &Axis)) {
    let bound = figure.bound.as_ref().map(|(label, _)| (label, None));
    let entries = curves.iter().enumerate().map(|(i, curve)| (&curve.label, Some(i))).chain(bound);
    for (number, (label, curve)) in entries.enumerate() {
        let column = (x.points.1 - x.points.0) / 2.0;
        let left = x.points.0 + column * (number % 2) as f64;
        let at = y.points.0 + 60.0 + LABEL_ROOM * (number / 2) as f64;
        key(canvas, curve, (left, at));
        canvas.text(label, (left + 26.0, at), LABEL - 1.0, INK, Anchor::Start);
    }
}

/// A curve's line and marker, or the bound's dashes, as a legend shows them.
fn key(canvas: &mut Canvas, curve: Option<usize>, (left, at): (f64, f64)) {
    match curve {
        Some(i) => {
            let color = COLORS[i % COLORS.len()];
            canvas.line(&[(left, at), (left + 20.0, at)], color, 2.0);
            marker(canvas, i, (left + 10.0, at), color);
        }
        None => canvas.dashes((left, at), (left + 20.0, at), INK, 1.4, 3.0),
    }
}

/// Labels stand right of the axes in the order of the curves' ends, pushed apart where they would overlap.
fn draw_labels(canvas: &mut Canvas, figure: &Figure, curves: &[Curve], (x, y): (&Axis, &Axis)) {
    struct Label<'figure> {
        text: &'figure str,
        curve: Option<usize>,
        end: (f64, f64),
    }
    let mut labels = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        if let Some(last) = curve.points.last() {
            let end = if flat(curve) { x.points.1 } else { x.place(last.x) };
            labels.push(Label { text: &curve.label, curve: Some(i), end: (end, y.place(last.y)) });
        }
    }
    if let Some((text, value)) = &figure.bound {
        labels.push(Label { text, curve: None, end: (x.points.1, y.place(*value)) });
    }
    labels.sort_by(|a, b| a.end.1.total_cmp(&b.end.1));
    let ends: Vec<f64> = labels.iter().map(|label| label.end.1).collect();
    let left = x.points.1 + LEADER;
    for (label, at) in labels.iter().zip(spread(&ends, LABEL_ROOM, (y.points.1 - 8.0, y.points.0))) {
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
