//! Observations that no world gave, and what tests read out of one by themselves.

use bytemuck::Zeroable;
use skilltree::layout::Observation;

/// A made-up observation.
pub(crate) fn made_up(next: &mut impl FnMut() -> f64) -> Observation {
    let mut made = Observation::zeroed();
    for ray in 0..24 {
        made.sonar[ray / 4] |= ((next() * 128.0) as u32) << (8 * (ray % 4));
    }
    made.light_bumpers = (next() * 268_435_456.0) as u32;
    made.compass = (next() * 360.0) as f32;
    made
}

/// The 24 readings of the sonar.
pub(crate) fn readings(observation: &Observation) -> [f64; 24] {
    let bytes: Vec<u8> = observation.sonar.iter().flat_map(|word| word.to_le_bytes()).collect();
    std::array::from_fn(|ray| f64::from(bytes[ray]))
}

/// A bit as a number.
pub(crate) fn bit(word: u32, at: usize) -> f64 {
    f64::from(word >> at & 1)
}

/// The four bumpers: front, left, back, right.
pub(crate) fn bumpers(observation: &Observation) -> [f64; 4] {
    std::array::from_fn(|side| bit(observation.light_bumpers, 24 + side))
}

/// Whether the light is seen on any bearing.
pub(crate) fn sees_light(observation: &Observation) -> bool {
    observation.light_bumpers & 0xff_ffff != 0
}

/// What the mirror image of a robot would sense.
pub(crate) fn reflected(seen: &Observation) -> Observation {
    let mut image = Observation { compass: seen.compass, ..Observation::zeroed() };
    let byte = |ray: usize| seen.sonar[ray / 4] >> (8 * (ray % 4)) & 0xff;
    for ray in 0..24 {
        // Straight ahead and straight back stay; the others change sides.
        let other = if ray == 0 { 0 } else { 24 - ray };
        image.sonar[ray / 4] |= byte(other) << (8 * (ray % 4));
        image.light_bumpers |= (seen.light_bumpers >> other & 1) << ray;
    }
    for (side, other) in [(0, 0), (1, 3), (2, 2), (3, 1)] {
        image.light_bumpers |= (seen.light_bumpers >> (24 + other) & 1) << (24 + side);
    }
    image
}
