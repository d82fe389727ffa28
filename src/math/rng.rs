//! Counter-based random numbers: Philox4x32-10 (Salmon et al., SC 2011).
//!
//! A draw is a pure function of (run seed, learner seed, trial, step, purpose, draw). Nothing is stored,
//! so no draw depends on where, when or beside whom a learner runs.

use crate::learner::layout::LANES;

/// What a random number is for. The purpose is part of the counter, so streams never meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Purpose {
    /// Everything in one primitive step of training: the draw is the lane.
    Step = 1,
    /// Everything in one primitive step of a test.
    Test = 2,
    /// Where a training trial starts.
    Start = 3,
    /// Where a test trial starts.
    TestStart = 4,
    /// Which lesson is replayed.
    Replay = 5,
    /// Initial weights.
    Init = 6,
    /// Which lessons of the bank a learner is given.
    Lesson = 7,
    /// Steps under given actions: `probe` and the planner's demonstrations.
    Given = 8,
    /// One primitive step of the teacher.
    Teacher = 9,
    /// Where a demonstration starts.
    TeacherStart = 10,
    /// Resampling in statistics; never used by a kernel.
    Statistics = 11,
    /// Which steps between decisions are learned from.
    Inner = 12,
    /// Points of a sweep; never used by a kernel.
    Sweep = 13,
}

/// Name and code of every purpose that a shader names.
pub const PURPOSES: &[(&str, Purpose)] = &[
    ("PURPOSE_STEP", Purpose::Step),
    ("PURPOSE_TEST", Purpose::Test),
    ("PURPOSE_START", Purpose::Start),
    ("PURPOSE_TEST_START", Purpose::TestStart),
    ("PURPOSE_REPLAY", Purpose::Replay),
    ("PURPOSE_INIT", Purpose::Init),
    ("PURPOSE_LESSON", Purpose::Lesson),
    ("PURPOSE_GIVEN", Purpose::Given),
    ("PURPOSE_INNER", Purpose::Inner),
];

/// The stream of one trial: everything in a counter but the draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// All random words of one primitive step: lane `l` holds draw number `l`.
#[derive(Debug, Clone, Copy)]
pub struct Dice {
    /// First word of every lane.
    pub x: [u32; LANES],
    /// Second word.
    pub y: [u32; LANES],
    /// Third word.
    pub z: [u32; LANES],
    /// Fourth word.
    pub w: [u32; LANES],
}

/// Rolls the dice of one primitive step: the rays take lanes 0 to 23, the rest is named below.
#[inline(always)]
pub fn roll(stream: Stream) -> Dice {
    let mut dice = Dice { x: [0; LANES], y: [0; LANES], z: [0; LANES], w: [0; LANES] };
    for lane in 0..LANES {
        let words = draw(stream, lane as u32);
        dice.x[lane] = words[0];
        dice.y[lane] = words[1];
        dice.z[lane] = words[2];
        dice.w[lane] = words[3];
    }
    dice
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
        for (kind, deviation) in [(0, 1.0_f64), (1, 1.0 / 3.0_f64.sqrt())] {
            let (mut sum, mut squares) = (0.0_f64, 0.0_f64);
            for i in 0..n {
                let w = philox([i, 0, 0, 0], [7, 9]);
                let z = f64::from(noise(kind, w[0], w[1]));
                sum += z;
                squares += z * z;
            }
            let mean = sum / f64::from(n);
            let sd = (squares / f64::from(n) - mean * mean).sqrt();
            assert!(mean.abs() < 0.005 && (sd - deviation).abs() < 0.005, "kind {kind}: {mean} {sd}");
        }
    }

    #[test]
    fn uniforms_stay_in_range() {
        assert_eq!(unit(0), 0.0);
        assert!(unit(!0) < 1.0);
        assert_eq!(below(!0, 7), 6);
        assert_eq!(noise(1, 0xffff, 0), 1.0);
        assert_eq!(noise(1, 0, 0), -1.0);
    }
}
