//! Elementary functions from `+ - *`, comparisons and bit patterns.
//!
//! Coefficients: interpolation at Chebyshev nodes in 40 digits, rounded to f32 (our own). Errors are
//! tested against f64 below, and the same bits are tested on the GPU.

/// Values closer to zero than this are stored as zero, so that no device's handling of subnormals is seen.
pub const TINY: f32 = 1.0e-30;

/// `x`, or zero where it is closer to zero than [`TINY`].
#[inline(always)]
pub fn flush(x: f32) -> f32 {
    if x.abs() < TINY { 0.0 } else { x }
}

/// Integer part of `x` between 1/2 and 2^23. By bits, because Rust's cast saturates, which keeps the CPU from using its
/// lanes; on a GPU the cast does.
#[inline(always)]
pub fn whole(x: f32) -> i32 {
    let bits = x.to_bits();
    (((bits & 0x007f_ffff) | 0x0080_0000) >> (150 - (bits >> 23))) as i32
}

/// e to the power of `x`, with `x` held to [-60, 60]. Relative error below 1e-6.
#[inline(always)]
pub fn exponential(x: f32) -> f32 {
    let held = if x > -60.0 { x } else { -60.0 };
    let bounded = if held < 60.0 { held } else { 60.0 };
    // Adding 128.5 makes the conversion, which cuts towards zero, round to nearest.
    let n = whole(bounded * 1.442_695_f32 + 128.5) - 128;
    let k = n as f32;
    let r = (bounded - k * 0.693_359_4_f32) - k * -0.000_212_194_44_f32;
    let z = r * r;
    let p = (((0.001_392_617_6_f32 * r + 0.008_363_173_f32) * r + 0.041_666_556_f32) * r + 0.166_665_78_f32) * r + 0.5;
    let y = (p * z + r) + 1.0;
    y * f32::from_bits(((n + 127) as u32) << 23)
}

/// Natural logarithm of a positive normal number. Absolute error below 1e-6 on (0, 1].
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    let bits = x.to_bits();
    let mantissa = f32::from_bits((bits & 0x007f_ffff) | 0x3f80_0000);
    let exponent = ((bits >> 23) as i32 - 127) as f32;
    // Keeping the mantissa between sqrt(1/2) and sqrt(2) keeps the polynomial short.
    let high = mantissa > 1.414_213_5_f32;
    let m = if high { mantissa * 0.5 } else { mantissa };
    let e = if high { exponent + 1.0 } else { exponent };
    let f = m - 1.0;
    let z = f * f;
    let p = ((((((0.087_872_654_f32 * f + -0.141_596_47_f32) * f + 0.148_347_87_f32) * f + -0.165_884_88_f32) * f
        + 0.199_720_5_f32)
        * f
        + -0.250_011_47_f32)
        * f
        + 0.333_336_7_f32)
        * f
        + -0.5;
    let tail = p * z + e * -0.000_212_194_44_f32;
    (tail + f) + e * 0.693_359_4_f32
}

/// 1 / `x` for positive `x` between 1e-30 and 1e30. Relative error below 2e-7.
#[inline(always)]
pub fn reciprocal(x: f32) -> f32 {
    let g0 = f32::from_bits(0x7ef3_11c3 - x.to_bits());
    let g1 = g0 * (2.0 - x * g0);
    let g2 = g1 * (2.0 - x * g1);
    g2 * (2.0 - x * g2)
}

/// 1 / sqrt(`x`) for positive `x` between 1e-30 and 1e30. Relative error below 3e-7.
#[inline(always)]
pub fn reciprocal_sqrt(x: f32) -> f32 {
    let half = 0.5 * x;
    let g0 = f32::from_bits(0x5f37_5a86 - (x.to_bits() >> 1));
    let g1 = g0 * (1.5 - half * (g0 * g0));
    let g2 = g1 * (1.5 - half * (g1 * g1));
    g2 * (1.5 - half * (g2 * g2))
}

/// sqrt(`x`) for `x` up to 1e30; zero below [`TINY`].
#[inline(always)]
pub fn square_root(x: f32) -> f32 {
    let bounded = if x > TINY { x } else { TINY };
    let root = bounded * reciprocal_sqrt(bounded);
    if x > TINY { root } else { 0.0 }
}

/// Whether `x` is neither infinite nor NaN: these have all exponent bits set.
#[inline(always)]
pub fn is_number(x: f32) -> bool {
    (x.to_bits() & 0x7f80_0000) != 0x7f80_0000
}

/// The nets' symmetric sigmoid, tanh(`x`), as a quotient of polynomials. Absolute error below 5e-7. What is no number
/// is handed on, so that it is found out and not taken for 1.
#[inline(always)]
pub fn tanh(x: f32) -> f32 {
    // Beyond, tanh is 1 to f32's last place but one.
    let held = if x > -7.9 { x } else { -7.9 };
    let b = if held < 7.9 { held } else { 7.9 };
    let z = b * b;
    let over =
        (((1.525_967_4e-8_f32 * z + 2.190_341_4e-5_f32) * z + 0.003_571_695_9_f32) * z + 0.134_444_52_f32) * z + 1.0;
    let under =
        (((8.530_545_3e-7_f32 * z + 0.000_341_174_28_f32) * z + 0.026_164_412_5_f32) * z + 0.467_777_73_f32) * z + 1.0;
    let y = b * over * reciprocal(under);
    if is_number(x) { y } else { x }
}

/// Sine and cosine of an angle in degrees, 0 to 720. Exact at multiples of 90.
#[inline(always)]
pub const fn sin_cos(degrees: f32) -> (f32, f32) {
    let quarter = (degrees * 0.011_111_111_f32 + 0.5) as i32;
    // Exact: both terms are multiples of the angle's last place.
    let r = degrees - quarter as f32 * 90.0;
    let z = r * r;
    let s = r * (((-9.621_950_8e-17_f32 * z + 1.349_391_5e-11_f32) * z + -8.860_953e-7_f32) * z + 0.017_453_292_f32);
    let c = (((2.106_408_7e-19_f32 * z + -3.925_464_8e-14_f32) * z + 3.866_322_4e-9_f32) * z + -0.000_152_308_71_f32)
        * z
        + 1.0;
    let odd = (quarter & 1) == 1;
    let sine = if odd { c } else { s };
    let cosine = if odd { s } else { c };
    let sine_signed = if (quarter & 2) == 2 { -sine } else { sine };
    let cosine_signed = if ((quarter + 1) & 2) == 2 { -cosine } else { cosine };
    (sine_signed, cosine_signed)
}

/// A heading brought back to [0, 360) degrees after a turn of less than 360.
#[inline(always)]
pub fn wrap_degrees(degrees: f32) -> f32 {
    let below = if degrees < 0.0 { degrees + 360.0 } else { degrees };
    // A tiny negative angle plus 360 rounds to 360, hence this order.
    if below >= 360.0 { below - 360.0 } else { below }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(from: f64, to: f64, n: u32) -> impl Iterator<Item = f32> {
        (0..=n).map(move |i| (from + (to - from) * f64::from(i) / f64::from(n)) as f32)
    }

    #[test]
    fn whole_cuts_as_a_cast_does() {
        let mut x = 0.5_f32;
        while x < 8.0e6 {
            assert_eq!(whole(x), x as i32, "{x}");
            x = x * 1.000_13 + 0.000_7;
        }
        for edge in [0.5, 0.999_999_94, 1.0, 1.999_999_9, 2.0, 215.999_98, 216.0, 8_388_607.5] {
            assert_eq!(whole(edge), edge as i32, "{edge}");
        }
    }

    #[test]
    fn exp_matches_f64() {
        for x in sweep(-60.0, 60.0, 200_000) {
            let exact = f64::from(x).exp();
            assert!((f64::from(exponential(x)) / exact - 1.0).abs() < 1.0e-6, "exp({x})");
        }
        assert_eq!(exponential(0.0), 1.0);
        assert_eq!(exponential(-1.0e9), exponential(-60.0));
    }

    #[test]
    fn ln_matches_f64() {
        for x in sweep(1.0e-7, 1.0, 200_000).chain(sweep(1.0, 1000.0, 20_000)) {
            assert!((f64::from(ln(x)) - f64::from(x).ln()).abs() < 1.0e-6, "ln({x})");
        }
    }

    #[test]
    fn reciprocals_match_f64() {
        for e in sweep(-24.0, 24.0, 200_000) {
            let x = f64::from(e).exp() as f32;
            assert!((f64::from(reciprocal(x)) * f64::from(x) - 1.0).abs() < 2.0e-7, "1/{x}");
            let root = f64::from(x).sqrt();
            assert!((f64::from(reciprocal_sqrt(x)) * root - 1.0).abs() < 3.0e-7, "1/sqrt {x}");
            assert!((f64::from(square_root(x)) / root - 1.0).abs() < 3.0e-7, "sqrt {x}");
        }
        assert_eq!(square_root(0.0), 0.0);
        assert_eq!(square_root(-1.0), 0.0);
    }

    #[test]
    fn squash_matches_f64() {
        for x in sweep(-20.0, 20.0, 200_000) {
            assert!((f64::from(tanh(x)) - f64::from(x).tanh()).abs() < 5.0e-7, "tanh({x})");
            assert!(tanh(x).abs() < 1.0 && tanh(-x) == -tanh(x));
        }
        assert_eq!(tanh(0.0), 0.0);
        assert!(tanh(f32::NAN).is_nan() && tanh(f32::INFINITY) == f32::INFINITY && tanh(f32::MAX) < 1.01);
    }

    #[test]
    fn sin_cos_match_f64_and_are_exact_at_right_angles() {
        for x in sweep(0.0, 720.0, 200_000) {
            let (s, c) = sin_cos(x);
            let (es, ec) = f64::from(x).to_radians().sin_cos();
            assert!((f64::from(s) - es).abs() < 2.0e-7 && (f64::from(c) - ec).abs() < 2.0e-7, "{x}");
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(90.0), (1.0, 0.0));
        assert_eq!(sin_cos(180.0), (0.0, -1.0));
        assert_eq!(sin_cos(270.0), (-1.0, 0.0));
    }

    #[test]
    fn headings_stay_in_range() {
        assert_eq!(wrap_degrees(-15.0), 345.0);
        assert_eq!(wrap_degrees(360.0), 0.0);
        assert_eq!(wrap_degrees(-1.0e-9), 0.0);
        assert_eq!(wrap_degrees(719.0), 359.0);
    }
}
