// Kernel `canary`: counts loop turns. Some drivers end every loop of an invocation, silently, after a
// fixed number of turns.

@group(0) @binding(0) var<storage, read> bounds: array<u32>;
@group(0) @binding(1) var<storage, read_write> counts: array<u32>;

// The state depends on every turn, so that no compiler can leave turns out.
fn single(turns: u32) -> u32 {
    var state = 1u;
    for (var turn = 0u; turn < turns; turn++) {
        state = state * 1664525u + (turn ^ (state >> 16u));
    }
    return state;
}

fn nested(outer: u32, inner: u32) -> u32 {
    var state = 1u;
    for (var i = 0u; i < outer; i++) {
        for (var j = 0u; j < inner; j++) {
            state = state * 1664525u + (j ^ (state >> 16u));
        }
    }
    return state;
}

@compute @workgroup_size(LANES)
fn loop_limit(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    if lane == 0u {
        if group.x == 0u {
            counts[0] = single(bounds[0]);
        } else if group.x == 1u {
            counts[1] = nested(bounds[1], bounds[2]);
        } else {
            counts[2] = single(bounds[3]);
        }
    }
}
