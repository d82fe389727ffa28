//! One reading of all sensors, written into the record.

use super::sonar::{LINES, line_direction, sonar_reading};
use super::workgroup::Workgroup;
use crate::layout::{BUMPERS_FROM, LANES, Noise, RAYS, SONAR_WORDS};
use crate::math::functions::{sin_cos, wrap_degrees};
use crate::math::reduce::{Lanes, lanes_or};
use crate::math::rng::{coarse_noise, noise};

/// First of the draws that err the sonar's ranges.
pub const DRAW_SONAR: usize = 0;
/// Draw that slips the actuators.
pub const DRAW_ACTUATOR: usize = 6;
/// Draw that turns the compass.
pub const DRAW_COMPASS: usize = 7;
/// First of the draws that choose a child.
pub const DRAW_CHOICE: usize = 8;
/// First of the draws that err the light's brightness.
pub const DRAW_LIGHT: usize = 16;

/// What the compass shows, degrees, where it errs by `error` times `deviation`.
#[inline(always)]
pub fn compass_reading(heading: f32, error: f32, deviation: f32) -> f32 {
    wrap_degrees(heading + deviation * error)
}

impl Workgroup<'_> {
    /// Readings of the sonar, inches. (`ux`, `uy`) are the directions of the rays' lines.
    pub fn sonar_scan(&mut self, x: f32, y: f32, ux: &Lanes, uy: &Lanes, noise_terms: Noise) -> [u32; LANES] {
        let range = self.ranges(x, y, ux, uy);
        let mut readings = [0; LANES];
        for lane in 0..LANES {
            let word = self.random.bearing_word(DRAW_SONAR, lane % RAYS);
            let error = noise_terms.sonar * coarse_noise(noise_terms.kind, word) + 1.0;
            readings[lane] = sonar_reading(range[lane], error);
        }
        readings
    }

    /// Bits of the bearings on which the light is seen.
    pub fn light_scan(&self, x: f32, y: f32, ux: &Lanes, uy: &Lanes, noise_terms: Noise) -> u32 {
        let mut lit = 0;
        if self.world.lit == 1 {
            let most = self.falloff(x, y);
            // No noise reaches 3.5.
            if most * (noise_terms.light * 3.5 + 1.0) > 1.0 && self.light_in_sight(x, y) {
                let mut bit = [0; LANES];
                for lane in 0..LANES {
                    let facing_x = if lane >= LINES { -ux[lane] } else { ux[lane] };
                    let facing_y = if lane >= LINES { -uy[lane] } else { uy[lane] };
                    let bright = self.brightness(most, x, y, facing_x, facing_y);
                    let shift = coarse_noise(noise_terms.kind, self.random.bearing_word(DRAW_LIGHT, lane % RAYS));
                    let glow = bright * (noise_terms.light * shift + 1.0);
                    bit[lane] = if glow > 1.0 && lane < RAYS { 1 << lane } else { 0 };
                }
                lit = lanes_or(&bit);
            }
        }
        lit
    }

    /// Senses at a pose.
    pub fn observe(&mut self, x: f32, y: f32, heading: f32, bumpers: u32, noise_terms: Noise) {
        let turn = sin_cos(heading);
        let mut ux = [0.0; LANES];
        let mut uy = [0.0; LANES];
        for lane in 0..LANES {
            let u = line_direction(lane, turn.1, turn.0);
            (ux[lane], uy[lane]) = u;
        }
        self.readings = self.sonar_scan(x, y, &ux, &uy, noise_terms);
        let lit = self.light_scan(x, y, &ux, &uy, noise_terms);
        for lane in 0..SONAR_WORDS {
            self.record.observation.sonar[lane] = self.readings[lane * 4]
                | (self.readings[lane * 4 + 1] << 8)
                | (self.readings[lane * 4 + 2] << 16)
                | (self.readings[lane * 4 + 3] << 24);
        }
        self.record.observation.light_bumpers = lit | (bumpers << BUMPERS_FROM);
        let error = noise(noise_terms.kind, self.random.x[DRAW_COMPASS], self.random.y[DRAW_COMPASS]);
        self.record.observation.compass = compass_reading(heading, error, noise_terms.compass);
    }
}
