//! The rotating light sensor: 24 bits, lit where the charger's light is bright enough on that bearing.
//!
//! Brightness = (range / d)^2 exp(k (cos(angle off the light) - 1)), k = 1 / (15 degrees)^2, in line of
//! sight only. Our choice: the paper states 24 binary readings and no more. Near the charger several
//! bearings are lit, far away one.

use super::sonar::crossing;
use super::workgroup::Workgroup;
use crate::layout::LANES;
use crate::math::functions::{exponential, reciprocal, reciprocal_sqrt};
use crate::math::reduce::lanes_or;

/// 1 / (15 degrees in radians)^2.
pub const BEAM_SHARPNESS: f32 = 14.590_25;

impl Workgroup<'_> {
    /// Whether nothing but the charger stands between the robot and the light.
    pub fn light_in_sight(&self, x: f32, y: f32) -> bool {
        let lx = self.world.light_x - x;
        let ly = self.world.light_y - y;
        let mut hidden = [0_u32; LANES];
        for first in (0..self.world.segments as usize).step_by(LANES) {
            for lane in 0..LANES {
                let i = first + lane;
                if i < self.world.segments as usize {
                    let ax = self.world.segment[i].ax - x;
                    let ay = self.world.segment[i].ay - y;
                    let bx = self.world.segment[i].bx - x;
                    let by = self.world.segment[i].by - y;
                    let dx = self.world.segment[i].bx - self.world.segment[i].ax;
                    let dy = self.world.segment[i].by - self.world.segment[i].ay;
                    let at = crossing(ax, ay, bx, by, dx, dy, lx, ly);
                    let solid = self.world.segment[i].charger == 0 && self.world.segment[i].length >= 0.0;
                    hidden[lane] |= u32::from(at.0 >= 0.0 && at.0 < at.1 && solid);
                }
            }
        }
        lanes_or(&hidden) == 0
    }

    /// Brightness of the light on a bearing that points at it, as if in sight; 1 is the threshold.
    pub fn falloff(&self, x: f32, y: f32) -> f32 {
        let lx = self.world.light_x - x;
        let ly = self.world.light_y - y;
        let square = lx * lx + ly * ly;
        // The light itself is out of the robot's reach; the bound keeps the functions in their range.
        let distance2 = if square > 1.0 { square } else { 1.0 };
        self.world.light_range2 * reciprocal(distance2)
    }

    /// Brightness of the light on a bearing, as if in sight, where it is `most` on a bearing that points at it.
    pub fn brightness(&self, most: f32, x: f32, y: f32, ux: f32, uy: f32) -> f32 {
        let lx = self.world.light_x - x;
        let ly = self.world.light_y - y;
        let square = lx * lx + ly * ly;
        let distance2 = if square > 1.0 { square } else { 1.0 };
        let nearness = reciprocal_sqrt(distance2);
        let aim = (ux * lx + uy * ly) * nearness;
        most * exponential(BEAM_SHARPNESS * (aim - 1.0))
    }
}
