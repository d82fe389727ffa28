// Q-values of every child.

const FEW: u32 = 16u;

var<workgroup> hidden: array<array<f32, LANES>, MAX_CHILDREN>;
var<workgroup> q: array<f32, MAX_CHILDREN>;

fn lanes_of(hidden_units: u32) -> u32 {
    return select(LANES, FEW, hidden_units <= FEW);
}

fn net_of(skill: u32, base: u32, net: u32) -> u32 {
    return base + skills[skill].nets_offset + net * (3u * skills[skill].rows * LANES + FEW);
}

fn layer(lane: u32, units: u32, skill: u32, base: u32) {
    let count = skills[skill].inputs;
    let outputs = skills[skill].outputs;
    let stride = stride_of(units);
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = weights_of(skill, units, base, number);
        var activation = 0.0f;
        if lane < units {
            var sum = weight(net + count * stride + lane);
            for (var row = 0u; row < count; row++) {
                let x = inputs[row];
                let bits = select(skills[skill].bits_low, skills[skill].bits_high, row >= 32u);
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

fn forward(lane: u32, skill: u32, s: u32, base: u32) {
    let children = skills[skill].children;
    let lanes = lanes_of(params[s].hidden);
    layer(lane, lanes, skill, base);
    lanes_sums(lane, children, lanes);
    if lane < children {
        let net = select(lane, 0u, skills[skill].nets == 1u);
        let row = skills[skill].inputs + 1u + skills[skill].outputs;
        let bias = weight(weights_of(skill, lanes, base, net) + row * stride_of(lanes) + (lane - net));
        q[lane] = tanh(partials[lane][0] + bias);
    }
    workgroupBarrier();
}
