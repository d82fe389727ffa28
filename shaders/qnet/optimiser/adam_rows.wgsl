// Adam with one second moment for each row of weights.
//
// Adam-mini (Zhang and others, 2024) keeps one second moment for a block of weights. Ours takes a row, the weights of
// one input, as the block: its gradient is a factor times the errors of the hidden units, so that the mean of its
// square needs no pass over the weights.

// What the gradient of each row of weights has in common.
var<workgroup> row_factor: array<f32, MAX_ROWS>;
// How far each row of weights moves along its mean gradient.
var<workgroup> row_step_size: array<f32, MAX_ROWS>;

// Lanes are hidden units, then rows.
fn row_step_sizes(lane: u32, units: u32, skill: u32, number: u32, output: u32, errors: NetErrors, rate: f32) {
    let s = params_base + skill;
    workgroupBarrier();
    let own_activation = hidden[number][lane];
    partials[0][lane] = errors.hidden * errors.hidden;
    partials[1][lane] = own_activation * own_activation;
    lanes_sums(lane, 2u, units);
    let hidden_share = partials[0][0] * params[s].unit_share;
    let activation = partials[1][0] * params[s].unit_share;
    let count = skills[skill].inputs;
    let last = count + 1u + skills[skill].outputs;
    let rest2 = 1.0f - params[s].beta2;
    let squares = net_offset(skill, number) + 2u * skills[skill].rows * LANES;
    // Blocks of rows, as many as there are.
    for (var block = 0u; block <= last; block += LANES) {
        let row = block + lane;
        let x = select(1.0f, inputs[min(row, MAX_INPUTS - 1u)], row < count);
        let own = row == count + 1u + output || row == last;
        let out = select(0.0f, errors.output, own);
        let factor = select(out, x, row <= count);
        let above = select(1.0f, activation, row < last);
        let alike = select(above, hidden_share, row <= count);
        let square = flush(params[s].beta2 * nets[squares + row] + rest2 * (factor * factor * alike));
        nets[squares + row] = square;
        row_factor[row] = factor;
        row_step_size[row] = rate * reciprocal_sqrt(square + params[s].epsilon2);
    }
    workgroupBarrier();
}

fn adam_rows(lane: u32, units: u32, skill: u32, number: u32, output: u32, errors: NetErrors, rate: f32) {
    let net = net_offset(skill, number);
    let weights_at = weights_offset(skill, units, number);
    let stride = row_stride(units);
    let tensor = skills[skill].rows * LANES;
    let beta1 = params[params_base + skill].beta1;
    let rest1 = 1.0f - beta1;
    row_step_sizes(lane, units, skill, number, output, errors, rate);
    let chosen = select(0.0f, 1.0f, lane == output);
    for (var row = 0u; row < skills[skill].rows; row++) {
        if lane < units {
            let at = net + row * LANES + lane;
            let own = weights_at + row * stride + lane;
            let last = row + 1u == skills[skill].rows;
            let above = select(hidden[number][lane], chosen, last);
            let alike = select(above, errors.hidden, row <= skills[skill].inputs);
            let factor = rest1 * row_factor[row];
            let mean = flush(beta1 * nets[at + tensor] + factor * alike);
            nets[at + tensor] = mean;
            set_weight(own, weight(own) + row_step_size[row] * mean);
        }
    }
}
