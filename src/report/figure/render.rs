//! A figure as an SVG document.

use super::color::{ColorScale, GREY, INK, PALE, palette};
use super::curves::END_LABEL;
use super::plot::{Figure, LegendEntry, Swatch, TOP, marker};
use super::svg::{Stroke, SvgWriter, TextAnchor, text_width};

/// Left end of headings and notes.
const MARGIN: f64 = 16.0;
/// Heights of lines of the legend and of notes, and the size of their text.
const LEGEND_LINE: f64 = 17.0;
const NOTE_LINE: f64 = 15.0;
const NOTE: f64 = 11.5;
const LABEL: f64 = 12.0;
/// Width of a legend's swatches.
const SWATCH: f64 = 20.0;
/// Length of the line that leads from a curve's end to its label.
const LEADER: f64 = 22.0;

/// Draws a figure.
pub fn render_svg(figure: &Figure) -> String {
    let area = figure.area;
    let plot = PlotOnPage { figure, left: area.left, right: area.left + area.width, bottom: TOP + area.height };
    let width = plot.right + area.right;
    let mut svg = SvgWriter::default();
    let title = area.title_size();
    svg.text(&figure.title, (MARGIN, 4.0 + title), title, INK, TextAnchor::Start);
    svg.text(&figure.subtitle, (MARGIN, TOP - 23.0), NOTE, GREY, TextAnchor::Start);
    plot.axes(&mut svg);
    svg.append(&figure.shapes);
    if let Some(scale) = &figure.scale {
        plot.color_scale(&mut svg, scale);
    }
    let ticked = !figure.x.ticks.is_empty();
    let mut next = plot.bottom + if ticked { 60.0 } else { 22.0 };
    if area.large && ticked {
        plot.labels_at_ends(&mut svg);
    } else if !figure.legend.is_empty() {
        next = plot.legend_below(&mut svg, next, width);
    }
    for line in figure.notes.iter().flat_map(|note| wrapped(note, width - MARGIN)) {
        svg.text(&line, (MARGIN, next), NOTE, GREY, TextAnchor::Start);
        next += NOTE_LINE;
    }
    svg.finish((width, next - 3.0), &figure.title)
}

/// Breaks a note into lines of at most a width.
fn wrapped(note: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in note.split(' ') {
        match lines.last_mut() {
            Some(line) if text_width(line, NOTE) + text_width(word, NOTE) < width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Where the plot lies on the page.
struct PlotOnPage<'a> {
    figure: &'a Figure,
    left: f64,
    right: f64,
    bottom: f64,
}

impl PlotOnPage<'_> {
    fn axes(&self, svg: &mut SvgWriter) {
        let Figure { x, y, .. } = self.figure;
        let (pale, grey) = (Stroke::solid(PALE, 0.75), Stroke::solid(GREY, 1.0));
        let mut free = self.bottom + LABEL;
        for (value, label) in &y.ticks {
            let (_, at) = self.figure.at((x.range.0, *value));
            match y.grid {
                true => svg.line(&[(self.left, at), (self.right, at)], pale),
                false => svg.line(&[(self.left - 4.0, at), (self.left, at)], grey),
            }
            if at <= free {
                svg.text(label, (self.left - 8.0, at), LABEL, INK, TextAnchor::End);
                free = at - LABEL - 1.0;
            }
        }
        let mut free = f64::NEG_INFINITY;
        for (value, label) in &x.ticks {
            let (at, _) = self.figure.at((*value, y.range.0));
            match x.grid {
                true => svg.line(&[(at, TOP), (at, self.bottom)], pale),
                false => svg.line(&[(at, self.bottom), (at, self.bottom + 4.0)], grey),
            }
            let half = text_width(label, LABEL) / 2.0;
            if at - half >= free {
                svg.text(label, (at, self.bottom + 15.0), LABEL, INK, TextAnchor::Middle);
                free = at + half + 6.0;
            }
        }
        if !x.ticks.is_empty() {
            svg.line(&[(self.left, self.bottom), (self.right, self.bottom)], grey);
        }
        if y.range.0 < 0.0 && y.range.1 > 0.0 && y.grid {
            let (_, zero) = self.figure.at((x.range.0, 0.0));
            svg.line(&[(self.left, zero), (self.right, zero)], grey);
        }
        svg.text(&x.title, ((self.left + self.right) / 2.0, self.bottom + 37.0), 13.0, INK, TextAnchor::Middle);
        svg.text_upwards(&y.title, (MARGIN, (TOP + self.bottom) / 2.0), 13.0, INK);
    }

    /// A column of colors right of the plot.
    fn color_scale(&self, svg: &mut SvgWriter, scale: &ColorScale) {
        const STEPS: usize = 40;
        let (left, right) = (self.right + 16.0, self.right + 32.0);
        let place = |step: usize| self.bottom - (self.bottom - TOP) * step as f64 / STEPS as f64;
        let value = |share: f64| scale.low + (scale.high - scale.low) * share;
        for step in 0..STEPS {
            // Half a point more upwards hides the seams.
            let (low, high) = (place(step), place(step + 1) - 0.5);
            let color = scale.color(value((step as f64 + 0.5) / STEPS as f64));
            svg.polygon(&[(left, low), (right, low), (right, high), (left, high)], color, 1.0);
        }
        for quarter in 0..=4 {
            let label = scale.label(value(quarter as f64 / 4.0));
            svg.text(&label, (right + 5.0, place(STEPS * quarter / 4)), NOTE, INK, TextAnchor::Start);
        }
    }

    /// Entry after entry, in as many lines as it takes; returns where the next line goes.
    fn legend_below(&self, svg: &mut SvgWriter, top: f64, width: f64) -> f64 {
        let (mut x, mut y) = (self.left, top);
        for entry in &self.figure.legend {
            let before = match entry.swatch {
                Swatch::Length(length) => length + 6.0,
                Swatch::Square(_) | Swatch::Disc(_) => 18.0,
                _ => SWATCH + 6.0,
            };
            let room = before + text_width(&entry.label, LABEL);
            if x > self.left && x + room > width {
                (x, y) = (self.left, y + LEGEND_LINE);
            }
            swatch(svg, entry.swatch, (x, y));
            svg.text(&entry.label, (x + before, y), LABEL, INK, TextAnchor::Start);
            x += room + 12.0;
        }
        y + LEGEND_LINE + 3.0
    }

    /// Labels stand right of the plot in the order of the curves' ends, pushed apart where they would overlap.
    fn labels_at_ends(&self, svg: &mut SvgWriter) {
        let mut labels: Vec<(&LegendEntry, (f64, f64))> =
            self.figure.legend.iter().map(|entry| (entry, self.figure.at(entry.end))).collect();
        labels.sort_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
        let ends: Vec<f64> = labels.iter().map(|(_, end)| end.1).collect();
        let left = self.right + LEADER;
        for ((entry, end), at) in labels.iter().zip(spread(&ends, LEGEND_LINE, (TOP - 8.0, self.bottom))) {
            let color = match entry.swatch {
                Swatch::Curve(i) => palette(i),
                _ => INK,
            };
            // A leader that crosses the plot would look like a curve; there the marker alone tells whose label it is.
            if end.0 > self.right - 6.0 {
                svg.line(&[*end, (self.right + 5.0, end.1), (left - 3.0, at)], Stroke::solid(color, 0.75));
            }
            match entry.swatch {
                Swatch::Curve(i) => marker(svg, (left + 4.0, at), i),
                _ => svg.line(&[(left, at), (left + 9.0, at)], Stroke { color, width: 1.4, dash: 3.0 }),
            }
            svg.text(&entry.label, (left + 13.0, at), END_LABEL, INK, TextAnchor::Start);
        }
    }
}

fn swatch(svg: &mut SvgWriter, swatch: Swatch, (left, at): (f64, f64)) {
    let ends = [(left, at), (left + SWATCH, at)];
    match swatch {
        Swatch::Curve(i) => {
            svg.line(&ends, Stroke::solid(palette(i), 2.0));
            marker(svg, (left + SWATCH / 2.0, at), i);
        }
        Swatch::Line(stroke) => svg.line(&ends, stroke),
        Swatch::DottedLine(color) => {
            svg.line(&ends, Stroke::solid(color, 2.4));
            svg.disc((left, at), 2.6, color);
        }
        Swatch::Square(color) => {
            let (top, bottom) = (at - 6.0, at + 6.0);
            svg.polygon(&[(left, top), (left + 12.0, top), (left + 12.0, bottom), (left, bottom)], color, 1.0);
        }
        Swatch::Disc(color) => svg.disc((left + 6.0, at), 5.0, color),
        Swatch::Length(length) => svg.line(&[(left, at), (left + length, at)], Stroke::solid(INK, 2.0)),
    }
}

/// Moves ascending positions apart to a least distance, as near to where they were as one pass each way brings them,
/// and inside the limits as long as there is room.
pub fn spread(positions: &[f64], distance: f64, (low, high): (f64, f64)) -> Vec<f64> {
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
    let of_group = |(sum, size): (f64, usize)| {
        (0..size).map(move |i| sum / size as f64 + distance * (i as f64 - (size - 1) as f64 / 2.0))
    };
    let mut placed: Vec<f64> = groups.into_iter().flat_map(of_group).collect();
    let count = placed.len();
    for (i, place) in placed.iter_mut().enumerate() {
        *place = place.min(high - distance * (count - 1 - i) as f64);
        *place = place.max(low + distance * i as f64);
    }
    placed
}
