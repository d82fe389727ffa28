// Adam (Kingma and Ba, 2015) in its second form, with epsilon under the root: one reciprocal root serves where a
// root and a division would.

// Lane of the clock row from which the powers of beta2 stand, net by net; those of beta1 stand from lane 0.
const BETA2_POWER: u32 = 16u;

fn bias_corrected_rate(lane: u32, skill: u32, number: u32, step_size: f32) -> f32 {
    let clock = nets_base + skills[skill].clock_offset + number;
    let first = flush(nets[clock] * params[params_base + skill].beta1);
    let second = flush(nets[clock + BETA2_POWER] * params[params_base + skill].beta2);
    // All lanes have read before one writes.
    storageBarrier();
    workgroupBarrier();
    if lane == 0u {
        nets[clock] = first;
        nets[clock + BETA2_POWER] = second;
    }
    return step_size * square_root(1.0f - second) * reciprocal(1.0f - first);
}

fn adam(lane: u32, units: u32, skill: u32, number: u32, output: u32, errors: NetErrors, rate: f32) {
    let net = net_offset(skill, number);
    let weights_at = weights_offset(skill, units, number);
    let stride = row_stride(units);
    let tensor = skills[skill].rows * LANES;
    let beta1 = params[params_base + skill].beta1;
    let beta2 = params[params_base + skill].beta2;
    let epsilon2 = params[params_base + skill].epsilon2;
    let rest1 = 1.0f - beta1;
    let rest2 = 1.0f - beta2;
    for (var row = 0u; row < skills[skill].rows; row++) {
        let g = gradient(lane, skill, number, output, row, errors);
        if lane < units {
            let at = net + row * LANES + lane;
            let own = weights_at + row * stride + lane;
            let mean = flush(beta1 * nets[at + tensor] + rest1 * g);
            let square = flush(beta2 * nets[at + 2u * tensor] + rest2 * (g * g));
            nets[at + tensor] = mean;
            nets[at + 2u * tensor] = square;
            set_weight(own, weight(own) + rate * mean * reciprocal_sqrt(square + epsilon2));
        }
    }
}
