//! Noise of a learner's robot, from its params.

use crate::layout::{HyperParams, Noise};

/// The noise terms of a learner's robot.
#[inline(always)]
pub fn noise_of(params: &HyperParams) -> Noise {
    Noise {
        kind: params.noise_kind,
        actuator: params.noise_actuator,
        sonar: params.noise_sonar,
        light: params.noise_light,
        compass: params.noise_compass,
    }
}
