// The 32 lanes of a learner: arrays in Rust, the invocations of a workgroup in WGSL.
//
// Every function must be reached by all lanes together. Each opens with a barrier, so that a
// reduction never overwrites a value that a slower lane still has to read.

// One value per lane for each child: what the nets' outputs are summed from.
var<workgroup> partials: array<array<f32, LANES>, MAX_CHILDREN>;
var<workgroup> lanes_bits: atomic<u32>;

fn lanes_sums(lane: u32, children: u32, lanes: u32) {
    workgroupBarrier();
    for (var width = lanes / 2u; width > 0u; width /= 2u) {
        for (var child = 0u; child < children; child++) {
            if lane < width {
                partials[child][lane] += partials[child][lane + width];
            }
        }
        workgroupBarrier();
    }
}

fn lanes_min(lane: u32, value: f32) -> f32 {
    workgroupBarrier();
    if lane == 0u {
        atomicStore(&lanes_bits, 0x7f800000u);
    }
    workgroupBarrier();
    atomicMin(&lanes_bits, bitcast<u32>(value));
    workgroupBarrier();
    return bitcast<f32>(atomicLoad(&lanes_bits));
}

fn lanes_or(lane: u32, value: u32) -> u32 {
    workgroupBarrier();
    if lane == 0u {
        atomicStore(&lanes_bits, 0u);
    }
    workgroupBarrier();
    atomicOr(&lanes_bits, value);
    workgroupBarrier();
    return atomicLoad(&lanes_bits);
}
