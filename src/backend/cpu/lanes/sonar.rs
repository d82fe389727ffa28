//! The sonar, sixteen lines side by side: a lane is a line and finds what is ahead and behind.
//!
//! In the shader a lane is a ray, and the last twelve take the negative of their line's closeness. Negation is exact, so
//! the bits are the same. Lines and rays stand at [`place_of`] their bearing.

use super::draws::place_of;
use crate::env::segments::{BLOCK, SegmentGrid};
use crate::env::sonar::{INVERSE_LIMIT, LINES, SLIVER};
use crate::layout::LANES;
use crate::math::functions::{reciprocal, sin_cos};
use crate::math::reduce::Lanes;
use std::hint::black_box;

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

/// Distance along each ray to the nearest segment; `SONAR_LIMIT`, but for rounding, where there is none so close.
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
