// One step of error back-propagation through one child's net (paper, section I, step 2).

const CLOCK_SECOND: u32 = 16u;

// What the gradient of each row of weights has in common.
var<workgroup> row_factor: array<f32, MAX_ROWS>;
// How far each row of weights moves along its mean gradient.
var<workgroup> row_pace: array<f32, MAX_ROWS>;

struct Errors {
    output: f32,
    hidden: f32,
}

fn errors(lane: u32, units: u32, skill: u32, base: u32, number: u32, child: u32, delta: f32) -> Errors {
    let value = q[child];
    let output = delta * (1.0f - value * value);
    let activation = hidden[number][lane];
    let row = skills[skill].inputs + 1u + child - number;
    var own = 0.0f;
    if lane < units {
        own = weight(weights_of(skill, units, base, number) + row * stride_of(units) + lane);
    }
    return Errors(output, output * own * (1.0f - activation * activation));
}

fn gradient(lane: u32, skill: u32, number: u32, output: u32, row: u32, errors: Errors) -> f32 {
    let count = skills[skill].inputs;
    let last = count + 1u + skills[skill].outputs;
    var slope = errors.hidden;
    if row < count {
        slope = errors.hidden * inputs[row];
    }
    if row > count && row < last {
        let own = row == count + 1u + output;
        slope = select(0.0f, errors.output * hidden[number][lane], own);
    }
    if row == last {
        slope = select(0.0f, errors.output, lane == output);
    }
    return slope;
}

fn paces(
    lane: u32,
    units: u32,
    skill: u32,
    s: u32,
    net: u32,
    number: u32,
    output: u32,
    errors: Errors,
    rate: f32,
) {
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
    let squares = net + 2u * skills[skill].rows * LANES;
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
        row_pace[row] = rate * reciprocal_sqrt(square + params[s].epsilon2);
    }
    workgroupBarrier();
}

fn learning_rate(s: u32, trial: u32) -> f32 {
    let risen = select(params[s].learning_rate_trials, trial, trial < params[s].learning_rate_trials);
    return params[s].learning_rate * (1.0f - params[s].learning_rate_fall * f32(risen));
}

fn learn(
    lane: u32,
    units: u32,
    skill: u32,
    s: u32,
    base: u32,
    number: u32,
    output: u32,
    found: Errors,
    pace: f32,
) {
    let net = net_of(skill, base, number);
    let weights = weights_of(skill, units, base, number) + lane;
    let stride = stride_of(units);
    let slab = skills[skill].rows * LANES;
    // A lane without a hidden unit has no rows.
    let rows = select(0u, skills[skill].rows, lane < units);
    let beta1 = params[s].beta1;
    let beta2 = params[s].beta2;
    let epsilon2 = params[s].epsilon2;
    if params[s].optimiser == OPTIMISER_SGD {
        for (var row = 0u; row < rows; row++) {
            let at = net + row * LANES + lane;
            let own = weights + row * stride;
            let g = gradient(lane, skill, number, output, row, found);
            let velocity = flush(beta1 * nets[at + slab] + pace * g);
            nets[at + slab] = velocity;
            put_weight(own, weight(own) + velocity);
        }
    } else {
        // Adam (Kingma and Ba, 2015) in its second form, with epsilon under the root: one reciprocal root serves where a
        // root and a division would.
        let clock = base + skills[skill].clock_offset + number;
        let first = flush(nets[clock] * beta1);
        let second = flush(nets[clock + CLOCK_SECOND] * beta2);
        let rate = pace * square_root(1.0f - second) * reciprocal(1.0f - first);
        storageBarrier();
        workgroupBarrier();
        if lane == 0u {
            nets[clock] = first;
            nets[clock + CLOCK_SECOND] = second;
        }
        let rest1 = 1.0f - beta1;
        if params[s].optimiser == OPTIMISER_ADAM_ROWS {
            paces(lane, units, skill, s, net, number, output, found, rate);
            let count = skills[skill].inputs;
            let chosen = select(0.0f, 1.0f, lane == output);
            for (var row = 0u; row < rows; row++) {
                let at = net + row * LANES + lane;
                let own = weights + row * stride;
                let above = select(chosen, hidden[number][lane], row + 1u < skills[skill].rows);
                let alike = select(above, found.hidden, row <= count);
                let factor = rest1 * row_factor[row];
                let mean = flush(beta1 * nets[at + slab] + factor * alike);
                nets[at + slab] = mean;
                put_weight(own, weight(own) + row_pace[row] * mean);
            }
        } else {
            let rest2 = 1.0f - beta2;
            for (var row = 0u; row < rows; row++) {
                let at = net + row * LANES + lane;
                let own = weights + row * stride;
                let g = gradient(lane, skill, number, output, row, found);
                let mean = flush(beta1 * nets[at + slab] + rest1 * g);
                let square = flush(beta2 * nets[at + 2u * slab] + rest2 * (g * g));
                nets[at + slab] = mean;
                nets[at + 2u * slab] = square;
                put_weight(own, weight(own) + rate * mean * reciprocal_sqrt(square + epsilon2));
            }
        }
    }
}

fn backward(lane: u32, skill: u32, s: u32, base: u32, child: u32, delta: f32, pace: f32) {
    let number = select(child, 0u, skills[skill].nets == 1u);
    let units = lanes_of(params[s].hidden);
    let found = errors(lane, units, skill, base, number, child, delta);
    learn(lane, units, skill, s, base, number, child - number, found, pace);
    // The output bias and the clocks are read by other lanes than the one that wrote them.
    storageBarrier();
    workgroupBarrier();
}
