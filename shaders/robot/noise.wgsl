// Noise of a learner's robot, from its settings.

fn noise_of(s: u32) -> Noise {
    return Noise(
        settings[s].noise_kind,
        settings[s].noise_actuator,
        settings[s].noise_sonar,
        settings[s].noise_light,
        settings[s].noise_compass,
    );
}
