// Q-values of every child.

const HALF_LANES: u32 = 16u;

var<workgroup> hidden: array<array<f32, LANES>, MAX_CHILDREN>;
var<workgroup> q: array<f32, MAX_CHILDREN>;
// Where the learner's nets begin.
var<private> nets_base: u32;

fn lanes_used(hidden_units: u32) -> u32 {
    return select(LANES, HALF_LANES, hidden_units <= HALF_LANES);
}

fn net_offset(skill: u32, net: u32) -> u32 {
    return nets_base + skills[skill].nets_offset + net * (3u * skills[skill].rows * LANES + HALF_LANES);
}

fn hidden_layer(lane: u32, units: u32, skill: u32) {
    let count = skills[skill].inputs;
    let outputs = skills[skill].outputs;
    let stride = row_stride(units);
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = weights_offset(skill, units, number);
        var activation = 0.0f;
        if lane < units {
            var sum = weight(net + count * stride + lane);
            for (var row = 0u; row < count; row++) {
                let x = inputs[row];
                let bits = select(skills[skill].bits_low, skills[skill].bits_high, row >= 32u);
                // A bit that is not set adds nothing.
                if x != 0.0f || ((bits >> (row % 32u)) & 1u) == 0u {
                    sum = sum + weight(net + row * stride + lane) * x;
                }
            }
            activation = tanh(sum);
            for (var output = 0u; output < outputs; output++) {
                partials[number + output][lane] = activation * weight(net + (count + 1u + output) * stride + lane);
            }
        }
        hidden[number][lane] = activation;
    }
}

fn forward(lane: u32, skill: u32) {
    let children = skills[skill].children;
    let units = lanes_used(params[params_base + skill].hidden);
    hidden_layer(lane, units, skill);
    lanes_sums(lane, children, units);
    if lane < children {
        let net = select(lane, 0u, skills[skill].nets == 1u);
        let row = skills[skill].inputs + 1u + skills[skill].outputs;
        let bias = weight(weights_offset(skill, units, net) + row * row_stride(units) + (lane - net));
        q[lane] = tanh(partials[lane][0] + bias);
    }
    workgroupBarrier();
}
