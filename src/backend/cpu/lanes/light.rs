//! The light, eight segments or all bearings side by side.

use super::sonar::{LINE_LANES, Lines};
use crate::env::light::BEAM_SHARPNESS;
use crate::env::segments::{BLOCK, SegmentGrid};
use crate::env::sonar::crossing;
use crate::layout::LANES;
use crate::math::functions::{exponential, reciprocal, reciprocal_sqrt};
use crate::math::reduce::{Lanes, lanes_or};

/// Whether nothing but the charger stands between the robot and the light.
#[inline(always)]
pub fn light_in_sight(floor: &SegmentGrid, x: f32, y: f32) -> bool {
    let lx = floor.plan.light_x - x;
    let ly = floor.plan.light_y - y;
    let mut hidden = [0_u32; BLOCK];
    for block in floor.hiding(x, y) {
        for lane in 0..BLOCK {
            let ax = block.ax[lane] - x;
            let ay = block.ay[lane] - y;
            let bx = block.bx[lane] - x;
            let by = block.by[lane] - y;
            let dx = block.bx[lane] - block.ax[lane];
            let dy = block.by[lane] - block.ay[lane];
            let (over, under) = crossing(ax, ay, bx, by, dx, dy, lx, ly);
            let solid = block.charger[lane] == 0 && block.length[lane] >= 0.0;
            hidden[lane] |= u32::from(over >= 0.0 && over < under && solid);
        }
    }
    lanes_or(&hidden) == 0
}

/// Brightness of the light on a bearing that points at it, as if in sight; 1 is the threshold.
#[inline(always)]
pub fn falloff(floor: &SegmentGrid, x: f32, y: f32) -> f32 {
    let lx = floor.plan.light_x - x;
    let ly = floor.plan.light_y - y;
    let square = lx * lx + ly * ly;
    // The light itself is out of the robot's reach; the bound keeps the functions in their range.
    let distance2 = if square > 1.0 { square } else { 1.0 };
    floor.plan.light_range2 * reciprocal(distance2)
}

/// Brightness of the light on each bearing, as if in sight, where it is `most` on a bearing that points at it.
#[inline(always)]
pub fn brightness(floor: &SegmentGrid, most: f32, x: f32, y: f32, ux: &Lines, uy: &Lines) -> Lanes {
    let lx = floor.plan.light_x - x;
    let ly = floor.plan.light_y - y;
    let square = lx * lx + ly * ly;
    let distance2 = if square > 1.0 { square } else { 1.0 };
    let nearness = reciprocal_sqrt(distance2);
    let mut aim = [0.0; LANES];
    for line in 0..LINE_LANES {
        aim[line] = (ux[line] * lx + uy[line] * ly) * nearness;
        aim[LINE_LANES + line] = -aim[line];
    }
    let mut bright = [0.0; LANES];
    for lane in 0..LANES {
        bright[lane] = most * exponential(BEAM_SHARPNESS * (aim[lane] - 1.0));
    }
    bright
}
