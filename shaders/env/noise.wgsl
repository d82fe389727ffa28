// Noise of a learner's robot, from its params.

fn noise_of(s: u32) -> Noise {
    return Noise(
        params[s].noise_kind,
        params[s].noise_actuator,
        params[s].noise_sonar,
        params[s].noise_light,
        params[s].noise_compass,
    );
}
