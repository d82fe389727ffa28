//! Contact of the disc with the segments: how far a move gets, and what touches the bumpers.
//!
//! Lanes are segments. Contact with a segment is contact with its line between the ends, or with one of
//! its two end points; both are quadratic-free or a single square root.

use super::workgroup::Workgroup;
use crate::layout::LANES;
use crate::layout::lengths::{BUMPER_GAP, INVERSE_RADIUS, RADIUS};
use crate::math::functions::{reciprocal, square_root};
use crate::math::reduce::{lanes_min, lanes_or};

/// A distance beyond any world.
pub const FAR: f32 = 1.0e6;
/// Slower approach than this, per inch travelled, is no approach.
pub const STILL: f32 = 1.0e-7;

/// Where a move along a line ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// Inches travelled, 0 to the wanted reach.
    pub distance: f32,
    /// Whether contact cut the move short.
    pub blocked: bool,
    /// Whether the charger was touched within the docking tolerance of the direction of travel.
    pub connected: bool,
}

/// Distance at which the rim meets a point at (`ex`, `ey`) from the centre, [`FAR`] if it never does, and how
/// far the centre then still is behind the point.
#[inline(always)]
pub fn disc_to_point(ex: f32, ey: f32, ux: f32, uy: f32) -> (f32, f32) {
    let ahead = ex * ux + ey * uy;
    let across = ex * uy - ey * ux;
    let chord = RADIUS * RADIUS - across * across;
    let back = square_root(chord);
    let gap = ahead - back;
    let reach = if gap > 0.0 { gap } else { 0.0 };
    (if chord > 0.0 && ahead > 0.0 { reach } else { FAR }, back)
}

impl Workgroup<'_> {
    /// Distance to contact with segment `i`, and the cosine between the travel and the contact point.
    fn disc_to_segment(&self, i: usize, x: f32, y: f32, ux: f32, uy: f32) -> (f32, f32) {
        let wx = x - self.world.segment[i].ax;
        let wy = y - self.world.segment[i].ay;
        let tx = self.world.segment[i].tx;
        let ty = self.world.segment[i].ty;
        let length = self.world.segment[i].length;
        // The line between the ends: the gap closes at a constant rate.
        let side = tx * wy - ty * wx;
        let drift = tx * uy - ty * ux;
        let closing = if side < 0.0 { drift } else { -drift };
        let rate = if closing > STILL { closing } else { STILL };
        let gap = (side.abs() - RADIUS) * reciprocal(rate);
        let line_reach = if gap > 0.0 { gap } else { 0.0 };
        let along = (tx * wx + ty * wy) + (tx * ux + ty * uy) * line_reach;
        let line_hit = closing > STILL && along >= 0.0 && along <= length;
        let mut reach = if line_hit { line_reach } else { FAR };
        let mut cosine = closing;
        // The end points: the disc's rim meets a point.
        let meet_a = disc_to_point(-wx, -wy, ux, uy);
        let hit_a = length >= 0.0 && meet_a.0 < reach;
        cosine = if hit_a { meet_a.1 * INVERSE_RADIUS } else { cosine };
        reach = if hit_a { meet_a.0 } else { reach };
        let meet_b = disc_to_point(self.world.segment[i].bx - x, self.world.segment[i].by - y, ux, uy);
        let hit_b = length >= 0.0 && meet_b.0 < reach;
        cosine = if hit_b { meet_b.1 * INVERSE_RADIUS } else { cosine };
        reach = if hit_b { meet_b.0 } else { reach };
        (reach, cosine)
    }

    /// Sweeps the disc past the segments from (`x`, `y`) along the unit vector (`ux`, `uy`) for at most `reach` inches.
    /// Contact within the world's `dock_cosine` of the direction of travel connects to the charger.
    pub fn sweep_disc(&self, x: f32, y: f32, ux: f32, uy: f32, reach: f32) -> Travel {
        let mut nearest = [FAR; LANES];
        let mut charger = [0_u32; LANES];
        for first in (0..self.world.segments as usize).step_by(LANES) {
            for lane in 0..LANES {
                let i = first + lane;
                if i < self.world.segments as usize {
                    let hit = self.disc_to_segment(i, x, y, ux, uy);
                    let closer = hit.0 < nearest[lane];
                    let plug = self.world.segment[i].charger == 1 && hit.1 >= self.world.dock_cosine;
                    // Segments touched at once count together, on one lane as on several.
                    let level = if hit.0 == nearest[lane] { charger[lane] | u32::from(plug) } else { charger[lane] };
                    charger[lane] = if closer { u32::from(plug) } else { level };
                    nearest[lane] = if closer { hit.0 } else { nearest[lane] };
                }
            }
        }
        let least = lanes_min(&nearest);
        let mut plug = [0; LANES];
        for lane in 0..LANES {
            plug[lane] = if nearest[lane] == least { charger[lane] } else { 0 };
        }
        let plugged = lanes_or(&plug);
        let blocked = least < reach;
        Travel { distance: if blocked { least } else { reach }, blocked, connected: blocked && plugged == 1 }
    }

    /// Bits of the bumpers that touch something: 1 front, 2 left, 4 back, 8 right. (`cosine`, `sine`) is the heading.
    pub fn touching_bumpers(&self, x: f32, y: f32, cosine: f32, sine: f32) -> u32 {
        let mut bits = [0_u32; LANES];
        for first in (0..self.world.segments as usize).step_by(LANES) {
            for lane in 0..LANES {
                let i = first + lane;
                if i < self.world.segments as usize {
                    let wx = x - self.world.segment[i].ax;
                    let wy = y - self.world.segment[i].ay;
                    let tx = self.world.segment[i].tx;
                    let ty = self.world.segment[i].ty;
                    let length = self.world.segment[i].length;
                    let foot = tx * wx + ty * wy;
                    let low = if foot > 0.0 { foot } else { 0.0 };
                    let along = if low < length { low } else { length };
                    let px = tx * along - wx;
                    let py = ty * along - wy;
                    let near = px * px + py * py < (RADIUS + BUMPER_GAP) * (RADIUS + BUMPER_GAP) && length >= 0.0;
                    let front = px * cosine + py * sine;
                    let left = py * cosine - px * sine;
                    let lengthwise = front.abs() >= left.abs();
                    let sector = if lengthwise {
                        if front > 0.0 { 1 } else { 4 }
                    } else if left > 0.0 {
                        2
                    } else {
                        8
                    };
                    bits[lane] |= if near { sector } else { 0 };
                }
            }
        }
        lanes_or(&bits)
    }
}
