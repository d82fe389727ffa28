// Elementary functions from `+ - *`, comparisons and bit patterns.
//
// Coefficients: interpolation at Chebyshev nodes in 40 digits, rounded to f32 (our own).

const TINY: f32 = 1.0e-30f;

fn flush(x: f32) -> f32 {
    return select(x, 0.0f, abs(x) < TINY);
}

fn whole(x: f32) -> i32 {
    return i32(x);
}

fn exponential(x: f32) -> f32 {
    let held = select(-60.0f, x, x > -60.0f);
    let bounded = select(60.0f, held, held < 60.0f);
    // Adding 128.5 makes the conversion, which cuts towards zero, round to nearest.
    let n = whole(bounded * 1.442695f + 128.5f) - 128;
    let k = f32(n);
    let r = (bounded - k * 0.6933594f) - k * -0.00021219444f;
    let z = r * r;
    let p = (((0.0013926176f * r + 0.008363173f) * r + 0.041666556f) * r + 0.16666578f) * r + 0.5f;
    let y = (p * z + r) + 1.0f;
    return y * bitcast<f32>(u32(n + 127) << 23u);
}

fn ln(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    let mantissa = bitcast<f32>((bits & 0x007fffffu) | 0x3f800000u);
    let exponent = f32(i32(bits >> 23u) - 127);
    // Keeping the mantissa between sqrt(1/2) and sqrt(2) keeps the polynomial short.
    let high = mantissa > 1.4142135f;
    let m = select(mantissa, mantissa * 0.5f, high);
    let e = select(exponent, exponent + 1.0f, high);
    let f = m - 1.0f;
    let z = f * f;
    let p = ((((((0.087872654f * f + -0.14159647f) * f + 0.14834787f) * f + -0.16588488f) * f
        + 0.1997205f)
        * f
        + -0.25001147f)
        * f
        + 0.3333367f)
        * f
        + -0.5f;
    let tail = p * z + e * -0.00021219444f;
    return (tail + f) + e * 0.6933594f;
}

fn reciprocal(x: f32) -> f32 {
    let g0 = bitcast<f32>(0x7ef311c3u - bitcast<u32>(x));
    let g1 = g0 * (2.0f - x * g0);
    let g2 = g1 * (2.0f - x * g1);
    return g2 * (2.0f - x * g2);
}

fn reciprocal_sqrt(x: f32) -> f32 {
    let half = 0.5f * x;
    let g0 = bitcast<f32>(0x5f375a86u - (bitcast<u32>(x) >> 1u));
    let g1 = g0 * (1.5f - half * (g0 * g0));
    let g2 = g1 * (1.5f - half * (g1 * g1));
    return g2 * (1.5f - half * (g2 * g2));
}

fn square_root(x: f32) -> f32 {
    let bounded = select(TINY, x, x > TINY);
    let root = bounded * reciprocal_sqrt(bounded);
    return select(0.0f, root, x > TINY);
}

fn is_number(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn tanh(x: f32) -> f32 {
    // Beyond, tanh is 1 to f32's last place but one.
    let held = select(-7.9f, x, x > -7.9f);
    let b = select(7.9f, held, held < 7.9f);
    let z = b * b;
    let over = (((1.5259674e-8f * z + 2.1903414e-5f) * z + 0.0035716959f) * z + 0.13444452f) * z + 1.0f;
    let under = (((8.5305453e-7f * z + 0.00034117428f) * z + 0.0261644125f) * z + 0.46777773f) * z + 1.0f;
    let y = b * over * reciprocal(under);
    return select(x, y, is_number(x));
}

// Sine, then cosine.
fn sin_cos(degrees: f32) -> vec2<f32> {
    let quarter = i32(degrees * 0.011111111f + 0.5f);
    // Exact: both terms are multiples of the angle's last place.
    let r = degrees - f32(quarter) * 90.0f;
    let z = r * r;
    let s = r
        * (((-9.6219508e-17f * z + 1.3493915e-11f) * z + -8.860953e-7f) * z + 0.017453292f);
    let c = (((2.1064087e-19f * z + -3.9254648e-14f) * z + 3.8663224e-9f) * z + -0.00015230871f)
        * z
        + 1.0f;
    let odd = (quarter & 1) == 1;
    let sine = select(s, c, odd);
    let cosine = select(c, s, odd);
    let sine_signed = select(sine, -sine, (quarter & 2) == 2);
    let cosine_signed = select(cosine, -cosine, ((quarter + 1) & 2) == 2);
    return vec2<f32>(sine_signed, cosine_signed);
}

fn wrap_degrees(degrees: f32) -> f32 {
    let below = select(degrees, degrees + 360.0f, degrees < 0.0f);
    // A tiny negative angle plus 360 rounds to 360, hence this order.
    return select(below, below - 360.0f, below >= 360.0f);
}
