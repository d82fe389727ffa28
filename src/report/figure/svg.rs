//! Writes SVG: six shapes, coordinates rounded to hundredths of a point, no more. Figures need nothing else of SVG, so
//! that a crate for it would be longer to use than this is.

use super::color::Color;
use std::fmt::Write as _;

/// What browsers on the usual systems are likely to have; widths are measured for the first one.
const FONTS: &str = "Ubuntu, 'Segoe UI', 'Helvetica Neue', Arial, sans-serif";
/// Mean width of a character of [`FONTS`] over its size; a little too wide rather than too narrow.
const CHARACTER: f64 = 0.52;

/// Where text lies relative to its point. Vertically it is always centred on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextAnchor {
    Start,
    Middle,
    End,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub color: Color,
    /// Width in points.
    pub width: f64,
    /// Length in points of dashes and of the gaps between them; 0 for a line without gaps.
    pub dash: f64,
}

impl Stroke {
    pub fn solid(color: Color, width: f64) -> Self {
        Self { color, width, dash: 0.0 }
    }
}

/// An SVG document being written: points from the left top corner, y down.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SvgWriter {
    body: String,
}

impl SvgWriter {
    pub fn line(&mut self, points: &[(f64, f64)], stroke: Stroke) {
        let Stroke { color, width, dash } = stroke;
        let dashes = if dash > 0.0 { format!(" stroke-dasharray=\"{dash}\"") } else { String::new() };
        let (points, width) = (list(points), rounded(width));
        self.push(format_args!(
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"{dashes}/>"
        ));
    }

    /// Fills a polygon; `opacity` is 0 to 1.
    pub fn polygon(&mut self, points: &[(f64, f64)], color: Color, opacity: f64) {
        let opacity = if opacity < 1.0 { format!(" opacity=\"{opacity}\"") } else { String::new() };
        self.push(format_args!("<polygon points=\"{}\" fill=\"{color}\"{opacity}/>", list(points)));
    }

    pub fn disc(&mut self, (x, y): (f64, f64), radius: f64, color: Color) {
        let (x, y, radius) = (rounded(x), rounded(y), rounded(radius));
        self.push(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{color}\"/>"));
    }

    pub fn ring(&mut self, (x, y): (f64, f64), radius: f64, stroke: Stroke) {
        let (x, y, radius, Stroke { color, width, .. }) = (rounded(x), rounded(y), rounded(radius), stroke);
        self.push(format_args!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{width}\"/>"
        ));
    }

    /// Writes text of `size` points.
    pub fn text(&mut self, text: &str, (x, y): (f64, f64), size: f64, color: Color, anchor: TextAnchor) {
        let anchor = match anchor {
            TextAnchor::Start => "",
            TextAnchor::Middle => " text-anchor=\"middle\"",
            TextAnchor::End => " text-anchor=\"end\"",
        };
        let (x, y, size, text) = (rounded(x), rounded(y), rounded(size), escaped(text));
        self.push(format_args!(
            "<text x=\"{x}\" y=\"{y}\" dy=\"0.35em\" font-size=\"{size}\" fill=\"{color}\"{anchor}>{text}</text>"
        ));
    }

    /// Writes text that reads upwards, centred on the point.
    pub fn text_upwards(&mut self, text: &str, (x, y): (f64, f64), size: f64, color: Color) {
        let (x, y) = (rounded(x), rounded(y));
        self.push(format_args!("<g transform=\"translate({x} {y}) rotate(-90)\">"));
        self.text(text, (0.0, 0.0), size, color, TextAnchor::Middle);
        self.push(format_args!("</g>"));
    }

    pub fn append(&mut self, other: &Self) {
        self.body.push_str(&other.body);
    }

    fn push(&mut self, tag: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.body, "{tag}");
    }

    /// The document, on white. The title is what screen readers say.
    pub fn finish(self, (width, height): (f64, f64), title: &str) -> String {
        let (width, height, title, body) = (rounded(width), rounded(height), escaped(title), self.body);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{FONTS}\" role=\"img\">\n<title>{title}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{body}</svg>\n"
        )
    }
}

/// Roughly how wide a text of `size` points is.
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * CHARACTER
}

fn rounded(points: f64) -> f64 {
    // Adding 0 makes of a rounded -0 a 0.
    (points * 100.0).round() / 100.0 + 0.0
}

fn list(points: &[(f64, f64)]) -> String {
    points.iter().map(|&(x, y)| format!("{},{}", rounded(x), rounded(y))).collect::<Vec<_>>().join(" ")
}

/// Text between tags. XML has no way to write most control characters.
fn escaped(text: &str) -> String {
    let text: String = text.chars().filter(|c| !c.is_control()).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
