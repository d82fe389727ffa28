//! The rotating sonar: 24 single rays from the centre, 0 to 127 inches (paper, section III).
//!
//! Lanes are the segments of the cell's list, then rays. A ray and the opposite one are on the same line; the line
//! crosses a segment where its two ends lie on different sides of it. Of all crossings the closest counts: closeness,
//! 1 / distance, is linear in the direction of the ray, and all that depends on the segment alone is worked out once.

use super::workgroup::Workgroup;
use crate::layout::lengths::CELLS_PER_INCH;
use crate::layout::{LANES, RAYS};
use crate::math::functions::{reciprocal, sin_cos};
use crate::math::reduce::Lanes;

/// Readings per degree.
pub const READINGS_PER_DEGREE: f32 = 0.066_666_67;
/// Longest reading, inches (paper, section III).
pub const SONAR_LIMIT: f32 = 127.0;
/// 1 / [`SONAR_LIMIT`].
pub const INVERSE_LIMIT: f32 = 0.007_874_016;
/// Segments whose line passes the robot closer than this, inches, are taken to pass at this distance: they are seen
/// end on, and f32 cannot tell on which side the robot is.
pub const SLIVER: f32 = 1.0e-4;
/// Lines through the robot: a ray and the opposite one are on the same line.
pub const LINES: usize = RAYS / 2;

/// Direction of the line of lane `lane`: of its ray, or of the opposite one from ray 12 on.
#[inline(always)]
pub fn line_direction(lane: usize, cosine: f32, sine: f32) -> (f32, f32) {
    let ray = sin_cos((lane % LINES) as f32 * 15.0);
    let ux = cosine * ray.1 - sine * ray.0;
    let uy = sine * ray.1 + cosine * ray.0;
    (ux, uy)
}

/// Where a line from the origin along (`ux`, `uy`) crosses a segment from (`ax`, `ay`) to (`bx`, `by`), whose
/// direction is (`dx`, `dy`): the distance is `over` / `under`, in lengths of (`ux`, `uy`). `over` is negative
/// where the line does not cross.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "four points")]
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

impl Workgroup<'_> {
    /// Distance along each ray to the nearest segment; [`SONAR_LIMIT`], but for rounding, where there is none so close.
    /// (`ux`, `uy`) are the directions of the rays' lines.
    pub fn ranges(&mut self, x: f32, y: f32, ux: &Lanes, uy: &Lanes) -> Lanes {
        let column = ((x * CELLS_PER_INCH) as u32).min(self.world.cell_columns - 1);
        let row = ((y * CELLS_PER_INCH) as u32).min(self.world.cell_rows - 1);
        let cell = (self.world.cell_starts + row * self.world.cell_columns + column) as usize;
        let first = self.tables[cell] as usize;
        let end = self.tables[cell + 1] as usize;
        let mut closest = [INVERSE_LIMIT; LANES];
        for block in (first..end).step_by(LANES) {
            for lane in 0..LANES {
                if block + lane < end {
                    let i = self.tables[block + lane] as usize;
                    let ax = self.world.segment[i].ax - x;
                    let ay = self.world.segment[i].ay - y;
                    let bx = self.world.segment[i].bx - x;
                    let by = self.world.segment[i].by - y;
                    let dx = self.world.segment[i].bx - self.world.segment[i].ax;
                    let dy = self.world.segment[i].by - self.world.segment[i].ay;
                    let over = ax * dy - ay * dx;
                    let least = SLIVER * self.world.segment[i].length;
                    let held = if over.abs() > least { over.abs() } else { least };
                    let inverse = reciprocal(held);
                    let signed = if over < 0.0 { -inverse } else { inverse };
                    self.ends[lane] = [ax, ay, bx, by];
                    self.slopes[lane] = [dy * signed, dx * signed];
                }
            }
            for n in 0..(end - block).min(LANES) {
                for lane in 0..LANES {
                    let side_a = self.ends[n][0] * uy[lane] > self.ends[n][1] * ux[lane];
                    let side_b = self.ends[n][2] * uy[lane] > self.ends[n][3] * ux[lane];
                    let closeness = ux[lane] * self.slopes[n][0] - uy[lane] * self.slopes[n][1];
                    let facing = if lane >= LINES { -closeness } else { closeness };
                    let seen = if side_a != side_b { facing } else { 0.0 };
                    closest[lane] = if seen > closest[lane] { seen } else { closest[lane] };
                }
            }
        }
        closest.map(reciprocal)
    }
}

/// Whole inches that the sonar reports for a range that is off by the factor `error`.
#[inline(always)]
pub fn sonar_reading(range: f32, error: f32) -> u32 {
    let noisy = range * error;
    let low = if noisy > 0.0 { noisy } else { 0.0 };
    let bounded = if low < SONAR_LIMIT { low } else { SONAR_LIMIT };
    // Beyond 2^23 f32 holds whole numbers only: the sum is rounded to one, which its lowest bits then are.
    (bounded + 8_388_608.0).to_bits() & 0x7f
}
