//! Colors that color-blind readers can tell apart: of curves, and of values.

use std::fmt;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8);

/// As SVG writes it: `#0072b2`.
impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Text and axes.
pub const INK: Color = Color(0x22, 0x22, 0x22);
/// Secondary text.
pub const GREY: Color = Color(0x5c, 0x5c, 0x5c);
/// Grid lines.
pub const PALE: Color = Color(0xdd, 0xdd, 0xdd);
pub const WHITE: Color = Color(0xff, 0xff, 0xff);

/// Hues of [`palette`].
pub const BLUE: Color = Color(0x00, 0x72, 0xb2);
pub const VERMILION: Color = Color(0xd5, 0x5e, 0x00);
pub const GREEN: Color = Color(0x00, 0x9e, 0x73);
pub const ORANGE: Color = Color(0xe6, 0x9f, 0x00);
pub const SKY: Color = Color(0x56, 0xb4, 0xe9);

/// Okabe and Ito's colors in turn, without the yellow that white paper swallows.
pub fn palette(index: usize) -> Color {
    const COLORS: [Color; 7] = [BLUE, VERMILION, GREEN, Color(0xcc, 0x79, 0xa7), ORANGE, SKY, Color(0x00, 0x00, 0x00)];
    COLORS[index % COLORS.len()]
}

/// Cividis (Nuñez, Anderton and Renslow 2018): even steps of lightness.
const CIVIDIS: [u32; 9] = [0x00224e, 0x123570, 0x3b496c, 0x575d6d, 0x707173, 0x8a8678, 0xa59c74, 0xc3b369, 0xfee838];

/// Colors for a range of values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColorScale {
    /// The value of the darkest color.
    pub low: f64,
    /// The value of the lightest one.
    pub high: f64,
    /// Whether values are shares.
    pub percent: bool,
}

impl ColorScale {
    /// For some values: shares are rounded out to tenths, so that figures of like runs look alike.
    pub fn new(values: impl Iterator<Item = f64>, percent: bool) -> Self {
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = match percent {
            true => ((low * 10.0 - 1e-9).floor() / 10.0, (high * 10.0 + 1e-9).ceil() / 10.0),
            false => (low, high),
        };
        if high > low { Self { low, high, percent } } else { Self { low: low - 0.1, high: low + 0.1, percent } }
    }

    /// The color of a value; of the nearer end if it lies outside.
    pub fn color(&self, value: f64) -> Color {
        let position = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0) * (CIVIDIS.len() - 1) as f64;
        let below = (position.floor() as usize).min(CIVIDIS.len() - 2);
        let share = position - below as f64;
        let mix = |shift: u32| {
            let [a, b] = [below, below + 1].map(|i| f64::from(CIVIDIS[i] >> shift & 0xff));
            (a + (b - a) * share).round() as u8
        };
        Color(mix(16), mix(8), mix(0))
    }

    /// Black or white, whichever reads better on a value's color.
    pub fn ink(&self, value: f64) -> Color {
        let Color(red, green, blue) = self.color(value);
        let light = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
        if light > 130.0 { INK } else { WHITE }
    }

    /// A value in few characters.
    pub fn label(&self, value: f64) -> String {
        if self.percent { format!("{:.0}%", 100.0 * value) } else { format!("{value:.2}") }
    }
}
