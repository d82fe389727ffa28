//! One reading of all sensors, packed into a record.
//!
//! A record's words: 0 to 5 the 24 sonar readings, a byte each; 6 the light bits and, from bit 24, the
//! bumpers; 7 the compass; 8 what was done (see `learn/lesson`); 9 the reward.

use crate::env::light::{brightness, falloff, in_sight};
use crate::env::segments::SegmentGrid;
use crate::env::sonar::{Lines, ranges, rays, reading};
use crate::env::workgroup::CohortData;
use crate::layout::{LANES, Noise, RAYS, RECORD_WORDS};
use crate::math::functions::{sin_cos, wrap_degrees};
use crate::math::reduce::lanes_or;
use crate::math::rng::{StepRandom, Stream, bearing_words, coarse_noise, draws, noise, place_of};
use std::hint::black_box;

/// Words of a record that hold the sonar's readings.
pub const SONAR_WORDS: usize = RAYS / 4;
/// StepRandom that slip the actuators.
pub const DRAW_ACTUATOR: usize = 6;
/// StepRandom that turn the compass.
pub const DRAW_COMPASS: usize = 7;
/// First of the random that choose a child.
pub const DRAW_CHOICE: usize = 8;
/// First of the random of the light's bearings.
pub const DRAW_LIGHT: u32 = 16;

/// The bit of each bearing, at [`place_of`] it.
const BIT: [u32; LANES] = bits();

const fn bits() -> [u32; LANES] {
    let mut bits = [0; LANES];
    let mut bearing = 0;
    while bearing < RAYS {
        bits[place_of(bearing)] = 1 << bearing;
        bearing += 1;
    }
    bits
}

/// Readings of the sonar, inches, under the noise of [`bearing_words`] `words`: each at [`place_of`] its bearing.
#[inline(always)]
pub fn hear(
    floor: &SegmentGrid,
    words: &[u32; LANES],
    x: f32,
    y: f32,
    ux: &Lines,
    uy: &Lines,
    terms: Noise,
) -> [u32; LANES] {
    let range = ranges(floor, x, y, ux, uy);
    let mut readings = [0_u32; LANES];
    for lane in 0..LANES {
        let error = terms.sonar * coarse_noise(terms.kind, words[lane]) + 1.0;
        readings[lane] = reading(range[lane], error);
    }
    readings
}

/// Bits of the bearings on which the light is seen under the noise of `stream`.
#[inline(always)]
pub fn see(floor: &SegmentGrid, stream: Stream, x: f32, y: f32, ux: &Lines, uy: &Lines, terms: Noise) -> u32 {
    let mut lit = 0;
    if floor.plan.lit == 1 {
        let most = falloff(floor, x, y);
        // No noise reaches 3.5.
        if most * (terms.light * 3.5 + 1.0) > 1.0 && in_sight(floor, x, y) {
            let bright = brightness(floor, most, x, y, ux, uy);
            // Behind `black_box` the compiler does not keep the keys of `draw_step` in memory on every step for this one.
            let drawn = draws(black_box(stream), DRAW_LIGHT);
            let words = bearing_words(&drawn[0], &drawn[1], &drawn[2], &drawn[3]);
            let mut bits = [0_u32; LANES];
            for lane in 0..LANES {
                let glow = bright[lane] * (terms.light * coarse_noise(terms.kind, words[lane]) + 1.0);
                bits[lane] = if glow > 1.0 { BIT[lane] } else { 0 };
            }
            lit = lanes_or(&bits);
        }
    }
    lit
}

/// The readings as a record has them, a byte each.
///
/// They go by way of memory, which `black_box` stands for: out of vectors the compiler takes them one by one.
#[inline(always)]
pub fn packed(readings: &[u32; LANES]) -> [u32; SONAR_WORDS] {
    let mut bytes = [0_u8; LANES];
    for lane in 0..LANES {
        bytes[lane] = readings[lane] as u8;
    }
    let bytes = black_box(&bytes);
    let blocks = bytes.as_chunks::<8>().0;
    let mut six = [0; 4];
    for block in 0..4 {
        six[block] = u64::from_le_bytes(blocks[block]) & 0xffff_ffff_ffff;
    }
    let pairs = [six[0] | six[1] << 48, six[1] >> 16 | six[2] << 32, six[2] >> 32 | six[3] << 16];
    let mut words = [0; SONAR_WORDS];
    for pair in 0..3 {
        words[2 * pair] = pairs[pair] as u32;
        words[2 * pair + 1] = (pairs[pair] >> 32) as u32;
    }
    words
}

/// What the compass shows, degrees, where it errs by `error` times `deviation`.
#[inline(always)]
pub fn compass(heading: f32, error: f32, deviation: f32) -> f32 {
    wrap_degrees(heading + deviation * error)
}

/// Senses at a pose and writes the first eight words of the record.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn observe(
    shared: &CohortData,
    record: &mut [u32; RECORD_WORDS],
    random: &StepRandom,
    x: f32,
    y: f32,
    heading: f32,
    bumpers: u32,
    terms: Noise,
) {
    let (sine, cosine) = sin_cos(heading);
    let (ux, uy) = rays(cosine, sine);
    let words = bearing_words(&random.x, &random.y, &random.z, &random.w);
    let readings = hear(&shared.floor, &words, x, y, &ux, &uy, terms);
    let lit = see(&shared.floor, random.stream, x, y, &ux, &uy, terms);
    record[..SONAR_WORDS].copy_from_slice(&packed(&readings));
    record[6] = lit | bumpers << 24;
    let error = noise(terms.kind, random.x[DRAW_COMPASS], random.y[DRAW_COMPASS]);
    record[7] = compass(heading, error, terms.compass).to_bits();
}
