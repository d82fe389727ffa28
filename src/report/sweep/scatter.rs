//! Points that were drawn at random, in the plane of two axes.

use super::plane::{BEST, BOTTOM, Colours, LEFT, Plane, RIGHT, TOP, frame};
use super::surface::Surface;
use super::{map, words};
use crate::report::axes::ticks;
use crate::report::canvas::{Anchor, Canvas, GREY, INK, PALE};
use crate::report::numbers::number;
use crate::run_folder::Sweep;
use crate::run_folder::sweep::{Axis, AxisValue, Scale};

/// Where the values of one axis lie.
struct Span<'a> {
    axis: &'a Axis,
    /// Ends of the values, as logarithms where the axis is logarithmic.
    range: (f64, f64),
    /// Ends on the canvas.
    ends: (f64, f64),
}

impl<'a> Span<'a> {
    fn new(axis: &'a Axis, ends: (f64, f64)) -> Self {
        let mut span = Self { axis, range: (0.0, 1.0), ends };
        let all = axis.values.iter().map(|value| span.position(value));
        let (low, high) = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let air = if high > low { 0.04 * (high - low) } else { 0.5 };
        span.range = (low - air, high + air);
        span
    }

    fn logarithmic(&self) -> bool {
        let positive = |value: &AxisValue| matches!(value, AxisValue::Number(number) if *number > 0.0);
        self.axis.scale == Scale::Log && self.axis.values.iter().all(positive)
    }

    /// A value as a number: words by their place in the list.
    fn position(&self, value: &AxisValue) -> f64 {
        match value {
            AxisValue::Number(number) if self.logarithmic() => number.log10(),
            AxisValue::Number(number) => *number,
            AxisValue::Text(_) => self.axis.values.iter().position(|known| known == value).unwrap_or(0) as f64,
        }
    }

    fn place(&self, position: f64) -> f64 {
        let share = (position - self.range.0) / (self.range.1 - self.range.0);
        self.ends.0 + share * (self.ends.1 - self.ends.0)
    }

    /// Where labels stand, and what they say.
    fn ticks(&self) -> Vec<(f64, String)> {
        if self.axis.values.iter().any(|value| matches!(value, AxisValue::Text(_))) {
            return self.axis.values.iter().map(|value| (self.position(value), words::value(value))).collect();
        }
        if !self.logarithmic() {
            return ticks(self.range).into_iter().map(|at| (at, number(at))).collect();
        }
        let powers = self.range.0.floor() as i32..=self.range.1.ceil() as i32;
        let steps = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|step| step * 10_f64.powi(power)));
        let inside = steps.filter(|value| (self.range.0..=self.range.1).contains(&value.log10()));
        let all: Vec<f64> = inside.collect();
        // Over several decades, powers of ten are enough.
        let whole = |value: &f64| all.len() <= 6 || (value.log10() - value.log10().round()).abs() < 1e-9;
        all.iter()
            .copied()
            .filter(whole)
            .map(|value| (value.log10(), words::value(&AxisValue::Number(value))))
            .collect()
    }
}

/// Draws the points of an arm as SVG.
pub(super) fn draw(sweep: &Sweep, surface: &Surface, (x, y): (usize, usize)) -> String {
    let (across, up) = (Span::new(&sweep.axes[x], (LEFT, RIGHT)), Span::new(&sweep.axes[y], (BOTTOM, TOP)));
    let mut notes = map::notes(surface.seeds.len());
    notes[0] = notes[0].replace("Frame", "Ring");
    let plane = Plane {
        title: format!("{}: {}", surface.arm, words::measure(surface)),
        subtitle: "A dot is a point of the sweep.".into(),
        x_title: across.axis.label.clone(),
        y_title: up.axis.label.clone(),
        columns: Vec::new(),
        rows: Vec::new(),
        marks: Vec::new(),
        percent: surface.success,
        notes,
    };
    let mut canvas = frame(&plane);
    grid(&mut canvas, &across, &up);
    let selection = &surface.selection;
    let colours = Colours::of(selection.means.iter().copied(), surface.success);
    let radius = if surface.points.len() > 200 { 3.0 } else { 5.0 };
    // The best is drawn last, so that nothing hides it.
    let mut order: Vec<usize> = (0..surface.points.len()).collect();
    order.sort_by(|&a, &b| selection.means[a].total_cmp(&selection.means[b]).then(b.cmp(&a)));
    for i in order {
        let values = &sweep.points[surface.points[i].number as usize];
        let at = (across.place(across.position(&values[x])), up.place(up.position(&values[y])));
        canvas.disc(at, radius + 0.8, GREY);
        canvas.disc(at, radius, colours.of_value(selection.means[i]));
        if selection.indistinguishable(i) {
            canvas.disc(at, radius / 3.0, INK);
        }
        if i == selection.best {
            canvas.ring(at, radius + 3.5, BEST, 3.0);
        }
    }
    colours.draw(&mut canvas);
    canvas.finish()
}

fn grid(canvas: &mut Canvas, across: &Span<'_>, up: &Span<'_>) {
    for (position, label) in across.ticks() {
        let at = across.place(position);
        canvas.line(&[(at, TOP), (at, BOTTOM)], PALE, 0.75);
        canvas.text(&label, (at, BOTTOM + 14.0), 11.5, INK, Anchor::Middle);
    }
    for (position, label) in up.ticks() {
        let at = up.place(position);
        canvas.line(&[(LEFT, at), (RIGHT, at)], PALE, 0.75);
        canvas.text(&label, (LEFT - 7.0, at), 11.5, INK, Anchor::End);
    }
    canvas.line(&[(LEFT, TOP), (LEFT, BOTTOM), (RIGHT, BOTTOM)], GREY, 1.0);
}
