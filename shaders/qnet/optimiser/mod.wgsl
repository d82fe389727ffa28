// How a net moves along its gradient: a file pair for each rule, and which of them a skill has.

fn optimise(lane: u32, units: u32, skill: u32, number: u32, output: u32, errors: NetErrors, step_size: f32) {
    let optimiser = params[params_base + skill].optimiser;
    if optimiser == OPTIMISER_SGD {
        sgd(lane, units, skill, number, output, errors, step_size);
    } else {
        let rate = bias_corrected_rate(lane, skill, number, step_size);
        if optimiser == OPTIMISER_ADAM_ROWS {
            adam_rows(lane, units, skill, number, output, errors, rate);
        } else {
            adam(lane, units, skill, number, output, errors, rate);
        }
    }
}
