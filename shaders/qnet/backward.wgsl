// One step of a child's net towards a target, by the skill's optimiser.

fn backward(lane: u32, skill: u32, child: u32, delta: f32, step_size: f32) {
    let optimiser = params[params_base + skill].optimiser;
    let units = lanes_used(params[params_base + skill].hidden);
    let number = select(child, 0u, skills[skill].nets == 1u);
    let output = child - number;
    let errors = net_errors(lane, units, skill, number, child, delta);
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
    // The output bias and the clocks are read by other lanes than the one that wrote them.
    storageBarrier();
    workgroupBarrier();
}
