// Gradient descent with momentum.

fn sgd(lane: u32, units: u32, skill: u32, number: u32, output: u32, errors: NetErrors, step_size: f32) {
    let net = net_offset(skill, number);
    let weights_at = weights_offset(skill, units, number);
    let stride = row_stride(units);
    let tensor = skills[skill].rows * LANES;
    let momentum = params[params_base + skill].beta1;
    for (var row = 0u; row < skills[skill].rows; row++) {
        let slope = gradient(lane, skill, number, output, row, errors);
        // A lane without a hidden unit has no rows.
        if lane < units {
            let at = net + row * LANES + lane;
            let own = weights_at + row * stride + lane;
            let velocity = flush(momentum * nets[at + tensor] + step_size * slope);
            nets[at + tensor] = velocity;
            set_weight(own, weight(own) + velocity);
        }
    }
}
