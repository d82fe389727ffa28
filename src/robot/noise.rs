//! Noise of a learner's robot, from its settings.

use crate::learner::layout::{Noise, Settings};

/// The noise terms of a learner's robot.
#[inline(always)]
pub fn noise_of(settings: &Settings) -> Noise {
    Noise {
        kind: settings.noise_kind,
        actuator: settings.noise_actuator,
        sonar: settings.noise_sonar,
        light: settings.noise_light,
        compass: settings.noise_compass,
    }
}
