// Q-values of every child.

var<workgroup> hidden: array<array<f32, LANES>, MAX_CHILDREN>;
var<workgroup> q: array<f32, MAX_CHILDREN>;

fn net_of(skill: u32, base: u32, child: u32) -> u32 {
    return base + skills[skill].nets_offset + child * 3u * skills[skill].rows * LANES;
}

fn forward(lane: u32, skill: u32, base: u32) {
    let count = skills[skill].inputs;
    let children = skills[skill].children;
    for (var child = 0u; child < children; child++) {
        let net = net_of(skill, base, child);
        var sum = nets[net + count * LANES + lane];
        for (var row = 0u; row < count; row++) {
            sum = sum + nets[net + row * LANES + lane] * inputs[row];
        }
        let activation = squash(sum);
        hidden[child][lane] = activation;
        partials[child][lane] = activation * nets[net + (count + 1u) * LANES + lane];
    }
    lanes_sums(lane, children);
    if lane < children {
        let bias = nets[net_of(skill, base, lane) + (count + 2u) * LANES];
        q[lane] = squash(partials[lane][0] + bias);
    }
    workgroupBarrier();
}
