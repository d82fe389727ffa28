//! The rotating sonar: 24 single rays from the centre, 0 to 127 inches (paper, section III).
//!
//! Lanes are the segments of the cell's list, then rays. A ray and the opposite one are on the same line; the line
//! crosses a segment where its two ends lie on different sides of it. Of all crossings the closest counts: closeness,
//! 1 / distance, is linear in the direction of the ray, and all that depends on the segment alone is worked out once.
//!
//! Here a lane is a line and finds what is ahead and behind; in the shader a lane is a ray, and the last twelve take the
//! negative of their line's closeness. Negation is exact, so the bits are the same. Lines and rays stand at
//! [`place_of`] their bearing.

use super::segments::{BLOCK, SegmentGrid};
use crate::layout::{LANES, RAYS};
use crate::math::functions::{reciprocal, sin_cos};
use crate::math::reduce::Lanes;
use crate::math::rng::place_of;
use std::hint::black_box;

/// Readings per degree.
pub const READINGS_PER_DEGREE: f32 = 0.066_666_67;
/// Longest reading, inches (paper, section III).
pub const SONAR_LIMIT: f32 = 127.0;
/// 1 / [`SONAR_LIMIT`].
const INVERSE_LIMIT: f32 = 0.007_874_016;
/// Segments whose line passes the robot closer than this, inches, are taken to pass at this distance: they are seen
/// end on, and f32 cannot tell on which side the robot is.
const SLIVER: f32 = 1.0e-4;

/// Lines through the robot: a ray and the opposite one are on the same line.
pub const LINES: usize = RAYS / 2;
/// Elements of an array of lines: a vector's, [`LINES`] of them in use. What the others hold means nothing.
pub const LINE_LANES: usize = 16;
/// One f32 for each line.
pub type Lines = [f32; LINE_LANES];

/// Sines and cosines of the lines' bearings, straight ahead being 0. Read through `black_box`: a compiler that knew the
/// numbers would work with each by itself.
static RAY_TABLE: (Lines, Lines) = ray_table();

const fn ray_table() -> (Lines, Lines) {
    let mut sines = [0.0; LINE_LANES];
    let mut cosines = [0.0; LINE_LANES];
    let mut line = 0;
    while line < LINES {
        let place = place_of(line);
        (sines[place], cosines[place]) = sin_cos(line as f32 * 15.0);
        line += 1;
    }
    (sines, cosines)
}

/// Directions of the first 12 rays of a robot with this heading; bearing 0 straight ahead, then counter-clockwise. The
/// other 12 look the opposite ways.
#[inline(always)]
pub fn rays(cosine: f32, sine: f32) -> (Lines, Lines) {
    let (sines, cosines) = black_box(&RAY_TABLE);
    let mut ux = [0.0; LINE_LANES];
    let mut uy = [0.0; LINE_LANES];
    for lane in 0..LINE_LANES {
        ux[lane] = cosine * cosines[lane] - sine * sines[lane];
        uy[lane] = sine * cosines[lane] + cosine * sines[lane];
    }
    (ux, uy)
}

/// Where a line from the origin along (`ux`, `uy`) crosses a segment from (`ax`, `ay`) to (`bx`, `by`), whose
/// direction is (`dx`, `dy`): the distance is `over` / `under`, in lengths of (`ux`, `uy`). `over` is negative
/// where the line does not cross.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function; four points")]
pub fn crossing(ax: f32, ay: f32, bx: f32, by: f32, dx: f32, dy: f32, ux: f32, uy: f32) -> (f32, f32) {
    // Sides come from the ends alone, so a ray cannot slip between two segments that share one.
    let side_a = ax * uy - ay * ux;
    let side_b = bx * uy - by * ux;
    let crosses = (side_a > 0.0) != (side_b > 0.0);
    let over = ax * dy - ay * dx;
    let under = ux * dy - uy * dx;
    let over_signed = if under < 0.0 { -over } else { over };
    (if crosses { over_signed } else { -1.0 }, under.abs())
}

/// Distance along each ray to the nearest segment; [`SONAR_LIMIT`], but for rounding, where there is none so close.
///
/// What a segment brings goes by way of memory, which `black_box` stands for: from there a number reaches all lanes at
/// no cost, and out of a vector at that of two more operations.
#[inline(always)]
pub fn ranges(floor: &SegmentGrid, x: f32, y: f32, ux: &Lines, uy: &Lines) -> Lanes {
    let mut ahead = [INVERSE_LIMIT; LINE_LANES];
    let mut behind = [-INVERSE_LIMIT; LINE_LANES];
    let (blocks, mut left) = floor.audible(x, y);
    for block in blocks {
        let mut ax = [0.0; BLOCK];
        let mut ay = [0.0; BLOCK];
        let mut bx = [0.0; BLOCK];
        let mut by = [0.0; BLOCK];
        let mut px = [0.0; BLOCK];
        let mut py = [0.0; BLOCK];
        for lane in 0..BLOCK {
            ax[lane] = block.ax[lane] - x;
            ay[lane] = block.ay[lane] - y;
            bx[lane] = block.bx[lane] - x;
            by[lane] = block.by[lane] - y;
            let dx = block.bx[lane] - block.ax[lane];
            let dy = block.by[lane] - block.ay[lane];
            let over = ax[lane] * dy - ay[lane] * dx;
            let least = SLIVER * block.length[lane];
            let held = if over.abs() > least { over.abs() } else { least };
            let inverse = reciprocal(held);
            let signed = if over < 0.0 { -inverse } else { inverse };
            px[lane] = dy * signed;
            py[lane] = dx * signed;
        }
        let held = [ax, ay, bx, by, px, py];
        let [ax, ay, bx, by, px, py] = black_box(&held);
        for i in 0..left.min(BLOCK) {
            for lane in 0..LINE_LANES {
                let side_a = ax[i] * uy[lane] > ay[i] * ux[lane];
                let side_b = bx[i] * uy[lane] > by[i] * ux[lane];
                let closeness = ux[lane] * px[i] - uy[lane] * py[i];
                let seen = if side_a != side_b { closeness } else { 0.0 };
                ahead[lane] = if seen > ahead[lane] { seen } else { ahead[lane] };
                behind[lane] = if seen < behind[lane] { seen } else { behind[lane] };
            }
        }
        left = left.saturating_sub(BLOCK);
    }
    let mut range = [0.0; LANES];
    for line in 0..LINE_LANES {
        range[line] = reciprocal(ahead[line]);
        range[LINE_LANES + line] = reciprocal(-behind[line]);
    }
    range
}

/// Whole inches that the sonar reports for a range that is off by the factor `error`.
#[inline(always)]
pub fn reading(range: f32, error: f32) -> u32 {
    let noisy = range * error;
    let low = if noisy > 0.0 { noisy } else { 0.0 };
    let bounded = if low < SONAR_LIMIT { low } else { SONAR_LIMIT };
    // Beyond 2^23 f32 holds whole numbers only: the sum is rounded to one, which its lowest bits then are.
    (bounded + 8_388_608.0).to_bits() & 0x7f
}
