//! How far actions slip under the noise of the actuators, in a few points for all.

use crate::layout::Noise;
use crate::layout::choices::NOISE_GAUSSIAN;

/// Points of the quadrature over the slip of the actuators.
pub(super) const SLIPS: usize = 3;

/// Three-point quadrature of the actuators' slip: factors and weights.
pub(super) fn slips(noise: &Noise) -> [(f32, f32); SLIPS] {
    let (far, weight) = match noise.kind {
        NOISE_GAUSSIAN => (3.0_f32.sqrt(), 1.0 / 6.0),
        _ => (0.6_f32.sqrt(), 5.0 / 18.0),
    };
    let reach = noise.actuator * far;
    [(1.0 - reach, weight), (1.0, 1.0 - 2.0 * weight), (1.0 + reach, weight)]
}
