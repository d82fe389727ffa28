//! A drawing surface in points with fractions, over plotters' SVG backend, whose pixels are whole numbers.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontFamily, FontTransform, IntoFont, RGBColor, ShapeStyle, TextStyle};

/// Units of the SVG's own coordinates per point: rounding to them stays invisible.
const SCALE: f64 = 20.0;
/// Plotters writes a font size divided by this.
const FONT_FACTOR: f64 = 1.24;
/// The font in which figures are measured and turned into PNG, then what browsers are likely to have.
const FONTS: &str = "Ubuntu, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif";
/// Mean width of a character of [`FONTS`] over its size; a little too wide rather than too narrow.
const CHARACTER: f64 = 0.54;

/// Text and axes.
pub const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
/// Secondary text.
pub const GREY: RGBColor = RGBColor(0x5c, 0x5c, 0x5c);
/// Grid lines.
pub const PALE: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);

/// Where text lies relative to its point. Vertically it is always centred on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// It is centred there.
    Middle,
    /// It ends there.
    End,
}

/// A figure being drawn: points from the left top corner, y down. Drawing cannot fail, as it goes to memory.
#[derive(Debug)]
pub struct Canvas {
    width: f64,
    height: f64,
    title: String,
    buffer: String,
}

impl Canvas {
    /// A white surface. The title is what screen readers say.
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let mut canvas = Self { width, height, title: title.into(), buffer: String::new() };
        canvas.polygon(&[(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)], RGBColor(255, 255, 255), 1.0);
        canvas
    }

    /// Joins points by straight lines.
    pub fn line(&mut self, points: &[(f64, f64)], color: RGBColor, width: f64) {
        let style = ShapeStyle { color: color.to_rgba(), filled: false, stroke_width: units(width).unsigned_abs() };
        self.draw(|backend| backend.draw_path(points.iter().map(|&point| pixel(point)), &style));
    }

    /// A straight line of dashes as long as the gaps between them.
    pub fn dashes(&mut self, from: (f64, f64), to: (f64, f64), color: RGBColor, width: f64, dash: f64) {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let count = (length / (2.0 * dash)).ceil() as u32;
        let at = |along: f64| {
            let share = (along / length).min(1.0);
            (from.0 + (to.0 - from.0) * share, from.1 + (to.1 - from.1) * share)
        };
        for i in 0..count {
            let start = 2.0 * dash * f64::from(i);
            self.line(&[at(start), at(start + dash)], color, width);
        }
    }

    /// Fills a polygon; `opacity` is 0 to 1.
    pub fn polygon(&mut self, points: &[(f64, f64)], color: RGBColor, opacity: f64) {
        let style = ShapeStyle { color: color.mix(opacity), filled: true, stroke_width: 0 };
        self.draw(|backend| backend.fill_polygon(points.iter().map(|&point| pixel(point)), &style));
    }

    /// Fills an axis-parallel rectangle given by two opposite corners.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), color: RGBColor, opacity: f64) {
        self.polygon(&[a, (b.0, a.1), b, (a.0, b.1)], color, opacity);
    }

    /// Fills a disc.
    pub fn disc(&mut self, centre: (f64, f64), radius: f64, color: RGBColor) {
        let style = ShapeStyle { color: color.to_rgba(), filled: true, stroke_width: 0 };
        self.draw(|backend| backend.draw_circle(pixel(centre), units(radius).unsigned_abs(), &style, true));
    }

    /// Draws a circle's outline.
    pub fn ring(&mut self, centre: (f64, f64), radius: f64, color: RGBColor, width: f64) {
        let style = ShapeStyle { color: color.to_rgba(), filled: false, stroke_width: units(width).unsigned_abs() };
        self.draw(|backend| backend.draw_circle(pixel(centre), units(radius).unsigned_abs(), &style, false));
    }

    /// Writes text of `size` points.
    pub fn text(&mut self, text: &str, at: (f64, f64), size: f64, color: RGBColor, anchor: Anchor) {
        self.write(text, at, size, color, anchor, FontTransform::None);
    }

    /// Writes text that reads upwards, centred on the point.
    pub fn text_upwards(&mut self, text: &str, at: (f64, f64), size: f64, color: RGBColor) {
        self.write(text, at, size, color, Anchor::Middle, FontTransform::Rotate270);
    }

    fn write(&mut self, text: &str, at: (f64, f64), size: f64, color: RGBColor, anchor: Anchor, turn: FontTransform) {
        let font = (FontFamily::Name(FONTS), size * SCALE * FONT_FACTOR).into_font().transform(turn);
        let position = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let style = TextStyle::from(font).color(&color).pos(Pos::new(position, VPos::Center));
        self.draw(|backend| backend.draw_text(text, &style, pixel(at)));
    }

    fn draw<T, E>(&mut self, draw: impl FnOnce(&mut SVGBackend<'_>) -> Result<T, E>) {
        let mut fragment = String::new();
        // The backend only fails when it writes a file; in memory there is nothing to report.
        let _ = draw(&mut SVGBackend::with_string(&mut fragment, (1, 1)));
        // Each fragment comes as a document of its own: keep what follows its opening tag.
        let body = fragment.split_once(">\n").map_or("", |(_, body)| body);
        self.buffer.push_str(body.trim_end().trim_end_matches("</svg>"));
    }

    /// The finished SVG document.
    pub fn finish(self) -> String {
        let title = self.title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {} {}\" role=\"img\">\n\
             <title>{title}</title>\n{}</svg>\n",
            self.width * SCALE,
            self.height * SCALE,
            self.buffer,
            w = self.width,
            h = self.height,
        )
    }
}

/// Roughly how wide a text of `size` points is.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER
}

fn units(points: f64) -> i32 {
    (points * SCALE).round() as i32
}

fn pixel((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}
