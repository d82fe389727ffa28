// Error back-propagation through one child's net (paper, section I, step 2).

// Back-propagated errors: of the output's sum, and of the lane's hidden unit's sum.
struct NetErrors {
    output: f32,
    hidden: f32,
}

fn net_errors(lane: u32, units: u32, skill: u32, number: u32, child: u32, delta: f32) -> NetErrors {
    let value = q[child];
    let output = delta * (1.0f - value * value);
    let activation = hidden[number][lane];
    let row = skills[skill].inputs + 1u + child - number;
    var own = 0.0f;
    if lane < units {
        own = weight(weights_offset(skill, units, number) + row * row_stride(units) + lane);
    }
    return NetErrors(output, output * own * (1.0f - activation * activation));
}

fn gradient(lane: u32, skill: u32, number: u32, output: u32, row: u32, errors: NetErrors) -> f32 {
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

// Learning rate of a trial: it falls linearly over the first trials.
fn learning_rate(skill: u32, trial: u32) -> f32 {
    let s = params_base + skill;
    let risen = select(params[s].learning_rate_trials, trial, trial < params[s].learning_rate_trials);
    return params[s].learning_rate * (1.0f - params[s].learning_rate_fall * f32(risen));
}
