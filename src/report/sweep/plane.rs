//! The frame of a map: colours for values, a scale beside it, cells with numbers.

use crate::report::canvas::{Anchor, Canvas, GREY, INK, PALE};
use plotters::style::RGBColor;

/// Cividis (Nuñez, Anderton and Renslow 2018): even steps of lightness, for colour-blind readers too.
const CIVIDIS: [[u8; 3]; 9] = [
    [0x00, 0x22, 0x4e],
    [0x12, 0x35, 0x70],
    [0x3b, 0x49, 0x6c],
    [0x57, 0x5d, 0x6d],
    [0x70, 0x71, 0x73],
    [0x8a, 0x86, 0x78],
    [0xa5, 0x9c, 0x74],
    [0xc3, 0xb3, 0x69],
    [0xfe, 0xe8, 0x38],
];
const WHITE: RGBColor = RGBColor(255, 255, 255);
/// Colour of the frame of the best: it stands out on dark and on light cells.
pub(super) const BEST: RGBColor = RGBColor(0xd5, 0x5e, 0x00);

pub(super) const WIDTH: f64 = 470.0;
pub(super) const HEIGHT: f64 = 470.0;
/// The map itself: left, right, top, bottom.
pub(super) const LEFT: f64 = 92.0;
pub(super) const RIGHT: f64 = 390.0;
pub(super) const TOP: f64 = 62.0;
pub(super) const BOTTOM: f64 = 350.0;
/// Lines below the map begin here.
const NOTES: f64 = 426.0;
/// Cells at least this wide and high have their number written in.
const ROOM: (f64, f64) = (25.0, 15.0);
/// Labels of an axis that stand this close are thinned out.
const LABEL_ROOM: (f64, f64) = (36.0, 14.0);

/// A cell.
pub(super) struct Mark {
    /// Column from the left, row from the bottom.
    pub(super) place: (usize, usize),
    pub(super) value: f64,
    pub(super) best: bool,
    /// Not told apart from the best; true for the best itself.
    pub(super) undecided: bool,
}

/// A map of cells.
pub(super) struct Plane {
    pub(super) title: String,
    pub(super) subtitle: String,
    pub(super) x_title: String,
    pub(super) y_title: String,
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<String>,
    /// Places without a mark were not run, or lack seeds: they are crossed out.
    pub(super) marks: Vec<Mark>,
    /// Whether values are shares.
    pub(super) percent: bool,
    pub(super) notes: Vec<String>,
}

/// Colours for a range of values.
pub(super) struct Colours {
    low: f64,
    high: f64,
    percent: bool,
}

impl Colours {
    /// For some values: shares are rounded out to tenths, so that figures of like runs look alike.
    pub(super) fn of(values: impl Iterator<Item = f64>, percent: bool) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = match percent {
            true => ((low * 10.0 - 1e-9).floor() / 10.0, (high * 10.0 + 1e-9).ceil() / 10.0),
            false => (low, high),
        };
        if high > low { Self { low, high, percent } } else { Self { low: low - 0.1, high: low + 0.1, percent } }
    }

    pub(super) fn of_value(&self, value: f64) -> RGBColor {
        let position = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0) * (CIVIDIS.len() - 1) as f64;
        let below = (position.floor() as usize).min(CIVIDIS.len() - 2);
        let share = position - below as f64;
        let mix = |i: usize| {
            let (a, b) = (f64::from(CIVIDIS[below][i]), f64::from(CIVIDIS[below + 1][i]));
            (a + (b - a) * share).round() as u8
        };
        RGBColor(mix(0), mix(1), mix(2))
    }

    /// Black or white, whichever reads better on a value's colour.
    fn ink(&self, value: f64) -> RGBColor {
        let RGBColor(red, green, blue) = self.of_value(value);
        let light = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
        if light > 130.0 { INK } else { WHITE }
    }

    fn label(&self, value: f64) -> String {
        if self.percent { format!("{:.0}%", 100.0 * value) } else { format!("{value:.2}") }
    }

    /// The scale right of the map.
    pub(super) fn draw(&self, canvas: &mut Canvas) {
        const STEPS: usize = 40;
        let (left, right) = (RIGHT + 16.0, RIGHT + 32.0);
        let place = |step: usize| BOTTOM - (BOTTOM - TOP) * step as f64 / STEPS as f64;
        for step in 0..STEPS {
            let value = self.low + (self.high - self.low) * (step as f64 + 0.5) / STEPS as f64;
            // Half a point more upwards hides the seams.
            canvas.rectangle((left, place(step)), (right, place(step + 1) - 0.5), self.of_value(value), 1.0);
        }
        for quarter in 0..=4 {
            let value = self.low + (self.high - self.low) * quarter as f64 / 4.0;
            let at = place(STEPS * quarter / 4);
            canvas.text(&self.label(value), (right + 5.0, at), 11.0, INK, Anchor::Start);
        }
    }
}

/// Title, subtitle, axis titles and notes of any map.
pub(super) fn frame(plane: &Plane) -> Canvas {
    let mut canvas = Canvas::new(WIDTH, HEIGHT, &plane.title);
    canvas.text(&plane.title, (16.0, 19.0), 15.0, INK, Anchor::Start);
    canvas.text(&plane.subtitle, (16.0, TOP - 23.0), 11.5, GREY, Anchor::Start);
    canvas.text(&plane.x_title, ((LEFT + RIGHT) / 2.0, BOTTOM + 38.0), 13.0, INK, Anchor::Middle);
    canvas.text_upwards(&plane.y_title, (16.0, (TOP + BOTTOM) / 2.0), 13.0, INK);
    for (i, note) in plane.notes.iter().enumerate() {
        canvas.text(note, (16.0, NOTES + 15.0 * i as f64), 11.5, GREY, Anchor::Start);
    }
    canvas
}

/// Every how manyth label has room.
pub(super) fn every(count: usize, length: f64, room: f64) -> usize {
    (count as f64 * room / length).ceil().max(1.0) as usize
}

/// Draws a map of cells as SVG.
pub(super) fn draw_cells(plane: &Plane) -> String {
    let mut canvas = frame(plane);
    let colours = Colours::of(plane.marks.iter().map(|mark| mark.value), plane.percent);
    let (width, height) = ((RIGHT - LEFT) / plane.columns.len() as f64, (BOTTOM - TOP) / plane.rows.len() as f64);
    let corner = |(column, row): (usize, usize)| (LEFT + width * column as f64, BOTTOM - height * row as f64);
    let widest = plane.columns.iter().map(|label| 7.0 * label.chars().count() as f64).fold(LABEL_ROOM.0, f64::max);
    let step = every(plane.columns.len(), RIGHT - LEFT, widest + 6.0);
    for (i, label) in plane.columns.iter().enumerate().step_by(step) {
        let (x, _) = corner((i, 0));
        canvas.text(label, (x + width / 2.0, BOTTOM + 14.0), 11.5, INK, Anchor::Middle);
    }
    let step = every(plane.rows.len(), BOTTOM - TOP, LABEL_ROOM.1);
    for (i, label) in plane.rows.iter().enumerate().step_by(step) {
        let (_, y) = corner((0, i));
        canvas.text(label, (LEFT - 7.0, y - height / 2.0), 11.5, INK, Anchor::End);
    }
    for place in (0..plane.rows.len()).flat_map(|row| (0..plane.columns.len()).map(move |column| (column, row))) {
        let (x, y) = corner(place);
        if !plane.marks.iter().any(|mark| mark.place == place) {
            canvas.line(&[(x, y), (x + width, y - height)], PALE, 1.0);
            canvas.line(&[(x, y - height), (x + width, y)], PALE, 1.0);
        }
    }
    for mark in &plane.marks {
        let (x, y) = corner(mark.place);
        canvas.rectangle((x, y), (x + width, y - height), colours.of_value(mark.value), 1.0);
        let ink = colours.ink(mark.value);
        let numbered = width >= ROOM.0 && height >= ROOM.1;
        if numbered {
            let number =
                if plane.percent { format!("{:.0}", 100.0 * mark.value) } else { format!("{:.2}", mark.value) };
            canvas.text(&number, (x + width / 2.0, y - height / 2.0), 11.0, ink, Anchor::Middle);
        }
        if mark.undecided {
            let at = if numbered { (x + width - 5.0, y - height + 5.0) } else { (x + width / 2.0, y - height / 2.0) };
            canvas.disc(at, 2.2_f64.min(width / 5.0), ink);
        }
    }
    for mark in plane.marks.iter().filter(|mark| mark.best) {
        let (x, y) = corner(mark.place);
        let outline = [(x, y), (x + width, y), (x + width, y - height), (x, y - height), (x, y)];
        canvas.line(&outline, WHITE, 5.0);
        canvas.line(&outline, BEST, 3.0);
    }
    colours.draw(&mut canvas);
    canvas.finish()
}
