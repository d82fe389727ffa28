// One step of a child's net towards a target, by the skill's optimiser.

fn backward(lane: u32, skill: u32, child: u32, delta: f32, step_size: f32) {
    let units = lanes_used(params[params_base + skill].hidden);
    let number = select(child, 0u, skills[skill].nets == 1u);
    let output = child - number;
    let errors = net_errors(lane, units, skill, number, child, delta);
    optimise(lane, units, skill, number, output, errors, step_size);
    // The output bias and the clocks are read by other lanes than the one that wrote them.
    storageBarrier();
    workgroupBarrier();
}
