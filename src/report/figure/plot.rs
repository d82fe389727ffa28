//! What a figure consists of.

use super::axis::PlotAxis;
use super::color::{Color, ColorScale, palette};
use super::svg::{Stroke, SvgWriter, TextAnchor};

/// Top of every plot.
pub(super) const TOP: f64 = 64.0;

/// A figure. Shapes are drawn in the units of its axes, with sizes in points; axes and area come first.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Figure {
    /// File name without its ending.
    pub name: String,
    /// Where on the page it stands: the templates ask for it by this word.
    pub section: &'static str,
    /// In sections of one skill or of one arm's sweep, the name of that.
    pub about: String,
    pub title: String,
    /// A line below the heading that says what was measured.
    pub subtitle: String,
    /// Size of the plot and of what surrounds it.
    pub area: PlotArea,
    pub x: PlotAxis,
    pub y: PlotAxis,
    /// What shapes and colors mean.
    pub legend: Vec<LegendEntry>,
    /// What the colors of values mean, drawn right of the plot.
    pub scale: Option<ColorScale>,
    /// Lines below: how many seeds, which interval. They are broken where they are too long.
    pub notes: Vec<String>,
    /// What has been drawn in the plot, from the back to the front.
    pub shapes: SvgWriter,
}

/// Size of a plot and of what surrounds it, in points.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PlotArea {
    pub left: f64,
    pub right: f64,
    pub width: f64,
    pub height: f64,
    /// Whether the plot stands alone, with curves labelled at their ends, or beside others, with the legend below it.
    pub large: bool,
}

impl PlotArea {
    /// A figure as wide as the page. Labels of curves take their room from the width.
    pub const LARGE: Self = Self { left: 76.0, right: 20.0, width: 664.0, height: 298.0, large: true };
    /// One of two figures side by side.
    pub const SMALL: Self = Self { left: 66.0, right: 16.0, width: 388.0, height: 248.0, large: false };
    /// The same with a square plot and a scale of colors.
    pub const SQUARE: Self = Self { left: 92.0, right: 80.0, width: 298.0, height: 288.0, large: false };

    /// More curves than this cannot be told apart.
    pub fn most_curves(&self) -> usize {
        if self.large { 12 } else { 7 }
    }

    pub fn title_size(&self) -> f64 {
        if self.large { 18.0 } else { 15.0 }
    }
}

/// What a shape or a color means.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendEntry {
    pub label: String,
    /// What stands before them.
    pub swatch: Swatch,
    /// Where a curve ends, in the units of the axes: the place of its label in a large figure.
    pub end: (f64, f64),
}

/// What stands before the words of a legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Swatch {
    /// Line and marker of a curve.
    Curve(usize),
    Line(Stroke),
    /// A line that begins with a dot.
    DottedLine(Color),
    Square(Color),
    Disc(Color),
    /// A length in points, as a scale of a map.
    Length(f64),
}

impl Figure {
    /// Where a place in the units of the axes lies on the page.
    pub(super) fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let PlotArea { left, width, height, .. } = self.area;
        (left + width * self.x.share(x), TOP + height * (1.0 - self.y.share(y)))
    }

    fn all_at(&self, places: &[(f64, f64)]) -> Vec<(f64, f64)> {
        places.iter().map(|&place| self.at(place)).collect()
    }

    /// Adds straight lines from place to place.
    pub fn line(&mut self, places: &[(f64, f64)], stroke: Stroke) {
        self.shapes.line(&self.all_at(places), stroke);
    }

    /// Adds a filled polygon; `opacity` is 0 to 1.
    pub fn polygon(&mut self, places: &[(f64, f64)], color: Color, opacity: f64) {
        self.shapes.polygon(&self.all_at(places), color, opacity);
    }

    /// Adds a filled rectangle, given by two opposite corners.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), color: Color, opacity: f64) {
        self.polygon(&[a, (b.0, a.1), b, (a.0, b.1)], color, opacity);
    }

    pub fn disc(&mut self, place: (f64, f64), radius: f64, color: Color) {
        self.shapes.disc(self.at(place), radius, color);
    }

    pub fn ring(&mut self, place: (f64, f64), radius: f64, stroke: Stroke) {
        self.shapes.ring(self.at(place), radius, stroke);
    }

    pub fn marker(&mut self, place: (f64, f64), curve: usize) {
        let at = self.at(place);
        marker(&mut self.shapes, at, curve);
    }

    pub fn text(&mut self, text: &str, place: (f64, f64), size: f64, color: Color, anchor: TextAnchor) {
        self.shapes.text(text, self.at(place), size, color, anchor);
    }

    pub fn explain(&mut self, label: impl Into<String>, swatch: Swatch) {
        self.legend.push(LegendEntry { label: label.into(), swatch, end: (0.0, 0.0) });
    }
}

/// The marker of a curve, in its color: a shape per curve, so that curves differ in print without color too.
pub(super) fn marker(svg: &mut SvgWriter, (x, y): (f64, f64), curve: usize) {
    let outline: &[(f64, f64)] = match curve % 4 {
        0 => return svg.disc((x, y), 3.6, palette(curve)),
        1 => &[(-3.2, -3.2), (3.2, -3.2), (3.2, 3.2), (-3.2, 3.2)],
        2 => &[(0.0, -4.4), (4.2, 3.2), (-4.2, 3.2)],
        _ => &[(0.0, -4.6), (4.6, 0.0), (0.0, 4.6), (-4.6, 0.0)],
    };
    let outline: Vec<_> = outline.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
    svg.polygon(&outline, palette(curve), 1.0);
}
