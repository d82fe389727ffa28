//! One reading of all sensors.

use super::draws::{bearing_words, draws, place_of};
use super::light::{brightness, falloff, light_in_sight};
use super::sonar::{Lines, ranges, rays};
use crate::env::observe::{DRAW_COMPASS, DRAW_LIGHT, compass_reading};
use crate::env::segments::SegmentGrid;
use crate::env::sonar::sonar_reading;
use crate::env::workgroup::Workgroup;
use crate::layout::{BUMPERS_FROM, LANES, Noise, RAYS, SONAR_WORDS};
use crate::math::functions::sin_cos;
use crate::math::reduce::lanes_or;
use crate::math::rng::{Stream, coarse_noise, noise};
use std::hint::black_box;

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
pub fn sonar_scan(
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
        readings[lane] = sonar_reading(range[lane], error);
    }
    readings
}

/// Bits of the bearings on which the light is seen under the noise of `stream`.
#[inline(always)]
pub fn light_scan(floor: &SegmentGrid, stream: Stream, x: f32, y: f32, ux: &Lines, uy: &Lines, terms: Noise) -> u32 {
    let mut lit = 0;
    if floor.plan.lit == 1 {
        let most = falloff(floor, x, y);
        // No noise reaches 3.5.
        if most * (terms.light * 3.5 + 1.0) > 1.0 && light_in_sight(floor, x, y) {
            let bright = brightness(floor, most, x, y, ux, uy);
            // Behind `black_box` the compiler does not keep the keys of `draw_step` in memory on every step for this one.
            let drawn = draws(black_box(stream), DRAW_LIGHT as u32);
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
pub fn pack_bytes(readings: &[u32; LANES]) -> [u32; SONAR_WORDS] {
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

/// Senses at a pose.
#[inline(always)]
pub fn observe(group: &mut Workgroup<'_>, x: f32, y: f32, heading: f32, bumpers: u32, terms: Noise) {
    let (sine, cosine) = sin_cos(heading);
    let (ux, uy) = rays(cosine, sine);
    let random = &group.random;
    let words = bearing_words(&random.x, &random.y, &random.z, &random.w);
    let readings = sonar_scan(group.floor, &words, x, y, &ux, &uy, terms);
    let lit = light_scan(group.floor, random.stream, x, y, &ux, &uy, terms);
    let error = noise(terms.kind, random.x[DRAW_COMPASS], random.y[DRAW_COMPASS]);
    group.record.observation.sonar = pack_bytes(&readings);
    group.record.observation.light_bumpers = lit | bumpers << BUMPERS_FROM;
    group.record.observation.compass = compass_reading(heading, error, terms.compass);
}
