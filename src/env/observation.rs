//! What a reading of all sensors holds, taken out of its words.

use crate::layout::Observation;

/// Bits of the bearings in `light_bumpers`.
pub const LIGHT_MASK: u32 = 0x00ff_ffff;

impl Observation {
    /// Sonar reading of a ray, whole inches, 0 to 127.
    #[inline(always)]
    pub fn sonar_inches(&self, ray: usize) -> u32 {
        (self.sonar[ray / 4] >> (8 * (ray % 4))) & 0xff
    }

    /// Bits of the bearings that are lit.
    #[inline(always)]
    pub fn lit_bearings(&self) -> u32 {
        self.light_bumpers & LIGHT_MASK
    }

    /// Bits of the bumpers that touch something: 1 front, 2 left, 4 back, 8 right.
    #[inline(always)]
    pub fn bumper_bits(&self) -> u32 {
        self.light_bumpers >> crate::layout::BUMPERS_FROM
    }

    /// What the compass shows, degrees.
    #[inline(always)]
    pub fn compass_degrees(&self) -> f32 {
        self.compass
    }
}
