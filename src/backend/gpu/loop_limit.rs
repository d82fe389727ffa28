//! Kernel `canary`: counts loop turns. Some drivers end every loop of an invocation, silently, after a
//! fixed number of turns. Twin: `shaders/backend/gpu/loop_limit.wgsl`.

/// Turns that every driver must manage; dispatches are kept below them where the driver cuts loops short.
pub const SAFE_TURNS: u32 = 30_000;

/// Turns after which Mesa's llvmpipe ends loops, one more than it makes; turns of two nested loops that add up to as many; and
/// [`SAFE_TURNS`].
pub const BOUNDS: [u32; 4] = [65_536, 1_000, 70, SAFE_TURNS];

// The state depends on every turn, so that no compiler can leave turns out.
fn single(turns: u32) -> u32 {
    let mut state = 1_u32;
    for turn in 0..turns {
        state = state.wrapping_mul(1_664_525).wrapping_add(turn ^ (state >> 16));
    }
    state
}

fn nested(outer: u32, inner: u32) -> u32 {
    let mut state = 1_u32;
    for _i in 0..outer {
        for j in 0..inner {
            state = state.wrapping_mul(1_664_525).wrapping_add(j ^ (state >> 16));
        }
    }
    state
}

/// The three states that an adapter must reach.
pub fn loop_limit(bounds: [u32; 4]) -> [u32; 3] {
    [single(bounds[0]), nested(bounds[1], bounds[2]), single(bounds[3])]
}
