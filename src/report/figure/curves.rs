//! Curves with bands over seeds.

use super::axis::{PlotAxis, range_with_zero};
use super::color::{INK, palette};
use super::plot::{Figure, LegendEntry, Swatch};
use super::svg::{Stroke, text_width};
use crate::report::statistics::Estimate;

/// What the bound is called.
const PLANNER: &str = "planner (bound)";
/// Markers along a step curve.
const STEP_MARKERS: usize = 3;
/// Size of labels at the ends of curves, the room before them, and the widest that is left to them.
pub(super) const END_LABEL: f64 = 13.0;
const BEFORE_LABEL: f64 = 44.0;
const LABEL_WIDTH: (f64, f64) = (60.0, 300.0);

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    pub x: f64,
    /// A value over seeds, and its interval.
    pub y: Estimate,
}

/// A curve: points by ascending x.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub label: String,
    /// At least one, but for a step curve.
    pub points: Vec<CurvePoint>,
    /// Of a step curve, where it ends: it is 1 before its first point, and holds each point's value up to the next.
    pub steps_until: Option<f64>,
}

impl Curve {
    /// Straight lines from point to point.
    pub fn new(label: impl Into<String>, points: Vec<CurvePoint>) -> Self {
        Self { label: label.into(), points, steps_until: None }
    }

    /// Whether it is a single test before any trial: of an arm that does not learn, so it is drawn across the figure.
    fn is_flat(&self) -> bool {
        self.steps_until.is_none() && self.points.len() == 1 && self.points[0].x == 0.0
    }

    /// The points to be joined: of a step curve, its corners.
    fn corners(&self) -> Vec<CurvePoint> {
        let Some(end) = self.steps_until else { return self.points.clone() };
        let mut last = CurvePoint { x: 0.0, y: Estimate::exact(1.0) };
        let mut corners = vec![last];
        for &point in self.points.iter().filter(|point| point.x <= end) {
            if point.y != last.y {
                corners.extend([CurvePoint { x: point.x, ..last }, point]);
            }
            last = point;
        }
        corners.push(CurvePoint { x: end, ..last });
        corners
    }

    /// Where markers of the curve stand, as number `index` of `count`: those of step curves are staggered.
    fn markers(&self, index: usize, count: usize) -> Vec<(f64, f64)> {
        let Some(end) = self.steps_until else {
            return self.points.iter().map(|point| (point.x, point.y.value)).collect();
        };
        let marker = |number: usize| {
            let at = end * (number as f64 + (index + 1) as f64 / (count + 1) as f64) / STEP_MARKERS as f64;
            let before = self.points.iter().rev().find(|point| point.x <= at);
            (at, before.map_or(1.0, |point| point.y.value))
        };
        (0..STEP_MARKERS).map(marker).collect()
    }
}

/// Axes that hold some curves and a value to compare with: x from 0, y with 0 or, if they are shares, from 0 to 100 percent.
pub fn axes<'a>(
    curves: impl IntoIterator<Item = &'a Curve>,
    bound: Option<f64>,
    (x_title, y_title): (&str, &str),
    percent: bool,
) -> (PlotAxis, PlotAxis) {
    let (mut end, mut low, mut high) = (0.0_f64, bound.unwrap_or(0.0), bound.unwrap_or(0.0));
    for point in curves.into_iter().flat_map(|curve| &curve.points) {
        end = end.max(point.x);
        (low, high) = (low.min(point.y.low.min(point.y.value)), high.max(point.y.high.max(point.y.value)));
    }
    let y = if percent { (0.0, 1.0) } else { range_with_zero(low, high) };
    let x = (0.0, if end > 0.0 { end } else { 1.0 });
    (PlotAxis::linear(x_title, x, false), PlotAxis::linear(y_title, y, percent).with_grid())
}

impl Figure {
    /// Adds as many curves as can be told apart, the bands behind all of them.
    pub fn with_curves(mut self, curves: &[Curve], bound: Option<f64>) -> Self {
        let curves = &curves[..curves.len().min(self.area.most_curves())];
        if self.area.large {
            // Labels at the curves' ends take their room from the plot, before anything is drawn in it.
            let labels = curves.iter().map(|curve| curve.label.as_str()).chain(bound.map(|_| PLANNER));
            let widest = labels.map(|label| text_width(label, END_LABEL)).fold(LABEL_WIDTH.0, f64::max);
            let room = BEFORE_LABEL + widest.min(LABEL_WIDTH.1);
            self.area.width -= room - self.area.right;
            self.area.right = room;
        }
        for (i, curve) in curves.iter().enumerate() {
            let corners = curve.corners();
            let low = corners.iter().map(|point| (point.x, point.y.low));
            let high = corners.iter().rev().map(|point| (point.x, point.y.high));
            let outline: Vec<_> = low.chain(high).collect();
            match corners.len() {
                1 => self.line(&outline, Stroke::solid(palette(i), 1.5)),
                _ => self.polygon(&outline, palette(i), 0.15),
            }
        }
        let (start, end) = self.x.range;
        if let Some(bound) = bound {
            let stroke = Stroke { color: INK, width: 1.4, dash: 5.0 };
            self.line(&[(start, bound), (end, bound)], stroke);
        }
        for (i, curve) in curves.iter().enumerate() {
            let mut points: Vec<_> = curve.corners().iter().map(|point| (point.x, point.y.value)).collect();
            let mut stroke = Stroke::solid(palette(i), 2.0);
            if curve.is_flat() {
                points.push((end, points[0].1));
                stroke = Stroke { width: 1.6, dash: 3.0, ..stroke };
            }
            let Some(&last) = points.last() else { continue };
            self.line(&points, stroke);
            curve.markers(i, curves.len()).into_iter().for_each(|at| self.marker(at, i));
            self.legend.push(LegendEntry { label: curve.label.clone(), swatch: Swatch::Curve(i), end: last });
        }
        if let Some(bound) = bound {
            let swatch = Swatch::Line(Stroke { color: INK, width: 1.4, dash: 3.0 });
            self.legend.push(LegendEntry { label: PLANNER.into(), swatch, end: (end, bound) });
        }
        self
    }
}
