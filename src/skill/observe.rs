//! One reading of all sensors, packed into a record.
//!
//! A record's words: 0 to 5 the 24 sonar readings, a byte each; 6 the light bits and, from bit 24, the
//! bumpers; 7 the compass; 8 what was done (see `lesson/record`); 9 the reward.

use crate::learner::layout::{LANES, Noise, RAYS};
use crate::learner::memory::{Scratch, Shared};
use crate::math::functions::{sin_cos, wrap_degrees};
use crate::math::lanes::lanes_or;
use crate::math::rng::{Dice, noise};
use crate::robot::light::{brightness, in_sight};
use crate::robot::sonar::{ranges, rays, reading};

/// Lane whose dice slip the actuators.
pub const DICE_ACTUATOR: usize = 24;
/// Lane whose dice turn the compass.
pub const DICE_COMPASS: usize = 25;
/// Lane whose dice choose a child.
pub const DICE_CHOICE: usize = 26;

/// Senses at a pose and writes the first eight words of the record.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn observe(
    shared: &Shared,
    scratch: &mut Scratch,
    dice: &Dice,
    x: f32,
    y: f32,
    heading: f32,
    bumpers: u32,
    terms: Noise,
) {
    let (sine, cosine) = sin_cos(heading);
    let (ux, uy) = rays(cosine, sine);
    let range = ranges(&shared.floor, &shared.atlas, x, y, &ux, &uy);
    let mut readings = [0_u32; LANES];
    for lane in 0..LANES {
        let error = terms.sonar * noise(terms.kind, dice.x[lane], dice.y[lane]) + 1.0;
        readings[lane] = reading(range[lane], error);
    }
    let mut lit = 0;
    if shared.floor.plan.lit == 1 {
        let seen = in_sight(&shared.floor, x, y);
        let bright = brightness(&shared.floor, x, y, &ux, &uy);
        let mut bits = [0_u32; LANES];
        for lane in 0..LANES {
            let glow = bright[lane] * (terms.light * noise(terms.kind, dice.z[lane], dice.w[lane]) + 1.0);
            bits[lane] = if seen && glow > 1.0 && lane < RAYS { 1 << lane } else { 0 };
        }
        lit = lanes_or(&bits);
    }
    for word in 0..6 {
        scratch.record[word] = readings[word * 4]
            | readings[word * 4 + 1] << 8
            | readings[word * 4 + 2] << 16
            | readings[word * 4 + 3] << 24;
    }
    scratch.record[6] = lit | bumpers << 24;
    let error = noise(terms.kind, dice.x[DICE_COMPASS], dice.y[DICE_COMPASS]);
    scratch.record[7] = wrap_degrees(heading + terms.compass * error).to_bits();
}
