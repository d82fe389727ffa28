//! Counter-based random numbers: Philox4x32-10 (Salmon et al., SC 2011).
//!
//! A draw is a pure function of (run seed, learner seed, trial, step, purpose, draw). Nothing is stored,
//! so no draw depends on where, when or beside whom a learner runs.

use crate::layout::LANES;
pub use crate::layout::purpose::{PURPOSES, Purpose};

/// The stream of one trial: everything in a counter but the draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Stream {
    /// Run seed and learner seed.
    pub key: [u32; 2],
    /// The skill in training, or the test's number.
    pub skill: u32,
    /// The trial, lesson or episode.
    pub trial: u32,
    /// The primitive step or a running count.
    pub step: u32,
    /// What the numbers are for.
    pub purpose: u32,
}

/// High word of the 64-bit product.
#[inline(always)]
pub fn mul_high(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// Philox4x32-10.
#[inline(always)]
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let mut c = counter;
    let mut k = key;
    for _round in 0..10 {
        let high0 = mul_high(0xd251_1f53, c[0]);
        let low0 = 0xd251_1f53_u32.wrapping_mul(c[0]);
        let high1 = mul_high(0xcd9e_8d57, c[2]);
        let low1 = 0xcd9e_8d57_u32.wrapping_mul(c[2]);
        c = [high1 ^ c[1] ^ k[0], low1, high0 ^ c[3] ^ k[1], low0];
        k = [k[0].wrapping_add(0x9e37_79b9), k[1].wrapping_add(0xbb67_ae85)];
    }
    c
}

/// Four random words: draw number `draw` of a stream.
#[inline(always)]
pub fn draw(stream: Stream, draw: u32) -> [u32; 4] {
    philox([stream.trial, stream.step, (stream.purpose << 16) | draw, stream.skill], stream.key)
}

/// The random words of one primitive step: entry `i` holds draw number `i`. Rays share the first six draws, a word
/// each, and so do the light's bearings theirs. The rest is named in `env/observe`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepRandom {
    /// What they are drawn from: a backend may leave the light's draws for when the light is seen.
    pub stream: Stream,
    /// First word of every draw.
    pub x: [u32; LANES],
    /// Second word.
    pub y: [u32; LANES],
    /// Third word.
    pub z: [u32; LANES],
    /// Fourth word.
    pub w: [u32; LANES],
}

impl StepRandom {
    /// Draws the random words of a primitive step.
    pub fn draw_step(&mut self, stream: Stream) {
        self.stream = stream;
        for lane in 0..LANES {
            [self.x[lane], self.y[lane], self.z[lane], self.w[lane]] = draw(stream, lane as u32);
        }
    }

    /// The word of bearing `b`, whose six draws begin with number `first`: word `b` / 6 of draw `b` % 6.
    pub fn bearing_word(&self, first: usize, b: usize) -> u32 {
        [&self.x, &self.y, &self.z, &self.w][b / 6][first + b % 6]
    }
}

/// Uniform in [0, 1), on a grid of 2^-24.
#[inline(always)]
pub fn unit(word: u32) -> f32 {
    (word >> 8) as f32 * 5.960_464_5e-8_f32
}

/// Uniform integer below `n`, for `n` far below 2^32.
#[inline(always)]
pub fn below(word: u32, n: u32) -> u32 {
    mul_high(word, n)
}

/// A noise term of mean 0: standard deviation 1 (kind 0: four 16-bit uniforms summed) or uniform in
/// [-1, 1] (kind 1).
#[inline(always)]
pub fn noise(kind: u32, first: u32, second: u32) -> f32 {
    let sum = (first & 0xffff) + (first >> 16) + (second & 0xffff) + (second >> 16);
    let bell = (sum as i32 - 131_070) as f32 * 2.642_90e-5_f32;
    let flat = ((first & 0xffff) as i32 * 2 - 65_535) as f32 * 1.525_902_2e-5_f32;
    if kind == 0 { bell } else { flat }
}

/// [`noise`] from one word, on a coarser grid: four 8-bit uniforms summed, or 16 bits.
#[inline(always)]
pub fn coarse_noise(kind: u32, word: u32) -> f32 {
    let pairs = (word & 0x00ff_00ff) + ((word >> 8) & 0x00ff_00ff);
    let sum = (pairs & 0xffff) + (pairs >> 16);
    let bell = (sum as i32 - 510) as f32 * 6.765_875e-3_f32;
    let flat = ((word & 0xffff) as i32 * 2 - 65_535) as f32 * 1.525_902_2e-5_f32;
    if kind == 0 { bell } else { flat }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Known answers published with Random123 (kat_vectors).
    #[test]
    fn philox_gives_the_published_answers() {
        assert_eq!(philox([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(philox([!0; 4], [!0; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        assert_eq!(
            philox([0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344], [0xa409_3822, 0x299f_31d0]),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn noise_has_the_promised_moments() {
        let n = 400_000;
        let two_words: fn(u32, [u32; 4]) -> f32 = |kind, w| noise(kind, w[0], w[1]);
        let one_word: fn(u32, [u32; 4]) -> f32 = |kind, w| coarse_noise(kind, w[2]);
        for (name, noise) in [("noise", two_words), ("coarse_noise", one_word)] {
            for (kind, deviation) in [(0, 1.0_f64), (1, 1.0 / 3.0_f64.sqrt())] {
                let (mut sum, mut squares) = (0.0_f64, 0.0_f64);
                for i in 0..n {
                    let z = f64::from(noise(kind, philox([i, 0, 0, 0], [7, 9])));
                    sum += z;
                    squares += z * z;
                }
                let mean = sum / f64::from(n);
                let sd = (squares / f64::from(n) - mean * mean).sqrt();
                assert!(mean.abs() < 0.005 && (sd - deviation).abs() < 0.005, "{name}, kind {kind}: {mean} {sd}");
            }
        }
    }

    /// A step's words, one by one: no two rays and nobody else share any.
    #[test]
    fn every_bearing_has_a_word_of_its_own() {
        let stream = Stream { key: [1, 2], skill: 3, trial: 4, step: 5, purpose: Purpose::Step as u32 };
        let mut random = StepRandom::default();
        random.draw_step(stream);
        let mut seen = std::collections::HashSet::new();
        for first in [0, 16] {
            for bearing in 0..24 {
                let word = random.bearing_word(first, bearing);
                assert_eq!(word, draw(stream, (first + bearing % 6) as u32)[bearing / 6]);
                assert!(seen.insert(word), "bearing {bearing}");
            }
        }
        for i in 6..16 {
            let words = draw(stream, i as u32);
            assert_eq!([random.x[i], random.y[i], random.z[i], random.w[i]], words);
            assert!(words.iter().all(|word| seen.insert(*word)), "draw {i}");
        }
    }

    #[test]
    fn uniforms_stay_in_range() {
        assert_eq!(unit(0), 0.0);
        assert!(unit(!0) < 1.0);
        assert_eq!(below(!0, 7), 6);
        assert_eq!(noise(1, 0xffff, 0), 1.0);
        assert_eq!(noise(1, 0, 0), -1.0);
        assert_eq!((coarse_noise(1, 0xffff), coarse_noise(1, 0)), (1.0, -1.0));
        assert_eq!(coarse_noise(0, 0x7f80_7f80), 0.0);
        // What `observe` takes to be out of reach.
        assert!(coarse_noise(0, !0) < 3.5 && coarse_noise(0, 0) > -3.5);
    }
}
