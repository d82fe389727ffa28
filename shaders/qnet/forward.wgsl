// Q-values of every child.

var<workgroup> hidden: array<array<f32, LANES>, MAX_CHILDREN>;
var<workgroup> q: array<f32, MAX_CHILDREN>;

fn net_of(skill: u32, base: u32, net: u32) -> u32 {
    return base + skills[skill].nets_offset + net * 3u * skills[skill].rows * LANES;
}

fn forward(lane: u32, skill: u32, base: u32) {
    let count = skills[skill].inputs;
    let outputs = skills[skill].outputs;
    let children = skills[skill].children;
    for (var number = 0u; number < skills[skill].nets; number++) {
        let net = net_of(skill, base, number);
        var sum = nets[net + count * LANES + lane];
        for (var row = 0u; row < count; row++) {
            sum = sum + nets[net + row * LANES + lane] * inputs[row];
        }
        let activation = squash(sum);
        hidden[number][lane] = activation;
        for (var output = 0u; output < outputs; output++) {
            partials[number + output][lane] = activation * nets[net + (count + 1u + output) * LANES + lane];
        }
    }
    lanes_sums(lane, children);
    if lane < children {
        let net = select(lane, 0u, skills[skill].nets == 1u);
        let row = count + 1u + outputs;
        let bias = nets[net_of(skill, base, net) + row * LANES + (lane - net)];
        q[lane] = squash(partials[lane][0] + bias);
    }
    workgroupBarrier();
}
