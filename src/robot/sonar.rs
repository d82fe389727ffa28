//! The rotating sonar: 24 single rays from the centre, 0 to 127 inches (paper, section III).
//!
//! Lanes are rays. A ray crosses a segment where its two ends lie on different sides of the ray; the
//! distance is a ratio, and ratios are compared by cross-multiplying, so that one reciprocal is enough.

use super::floor::Floor;
use crate::learner::layout::LANES;
use crate::math::functions::{reciprocal, sin_cos};
use crate::math::lanes::Lanes;

/// Longest reading, inches (paper, section III).
pub const SONAR_LIMIT: f32 = 127.0;
/// Cells per inch of the culled segment lists.
const CELLS_PER_INCH: f32 = 0.083_333_336;

/// Directions of the 24 rays of a robot with this heading; index 0 straight ahead, then counter-clockwise.
#[inline(always)]
pub fn rays(cosine: f32, sine: f32) -> (Lanes, Lanes) {
    let mut ux = [0.0; LANES];
    let mut uy = [0.0; LANES];
    for lane in 0..LANES {
        let (ray_sine, ray_cosine) = sin_cos(lane as f32 * 15.0);
        ux[lane] = cosine * ray_cosine - sine * ray_sine;
        uy[lane] = sine * ray_cosine + cosine * ray_sine;
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

/// Distance along each ray to the nearest segment, at most [`SONAR_LIMIT`].
#[inline(always)]
pub fn ranges(floor: &Floor, atlas: &[u32], x: f32, y: f32, ux: &Lanes, uy: &Lanes) -> Lanes {
    let column = ((x * CELLS_PER_INCH) as u32).min(floor.plan.cell_columns - 1);
    let row = ((y * CELLS_PER_INCH) as u32).min(floor.plan.cell_rows - 1);
    let cell = floor.plan.cell_starts + row * floor.plan.cell_columns + column;
    let first = atlas[cell as usize];
    let end = atlas[cell as usize + 1];
    let mut best_over = [SONAR_LIMIT; LANES];
    let mut best_under = [1.0_f32; LANES];
    for entry in first..end {
        let segment = &floor.plan.segment[atlas[entry as usize] as usize];
        let ax = segment.ax - x;
        let ay = segment.ay - y;
        let bx = segment.bx - x;
        let by = segment.by - y;
        let dx = segment.bx - segment.ax;
        let dy = segment.by - segment.ay;
        for lane in 0..LANES {
            let (over, under) = crossing(ax, ay, bx, by, dx, dy, ux[lane], uy[lane]);
            let hit = over >= 0.0 && over * best_under[lane] < best_over[lane] * under;
            best_over[lane] = if hit { over } else { best_over[lane] };
            best_under[lane] = if hit { under } else { best_under[lane] };
        }
    }
    let mut range = [0.0; LANES];
    for lane in 0..LANES {
        range[lane] = best_over[lane] * reciprocal(best_under[lane]);
    }
    range
}

/// Whole inches that the sonar reports for a range that is off by the factor `error`.
#[inline(always)]
pub fn reading(range: f32, error: f32) -> u32 {
    let noisy = range * error;
    let low = if noisy > 0.0 { noisy } else { 0.0 };
    let bounded = if low < SONAR_LIMIT { low } else { SONAR_LIMIT };
    (bounded + 0.5) as u32
}
