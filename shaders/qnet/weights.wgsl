// Where the weights of a net are: in the learner's nets or, while it replays, in the workgroup's own memory.

// Words of `held_weights`. The host sets it from what the device has and what the cohort's skills take.
override HELD_WORDS: u32 = 1u;

// The weights of the skill in training from the first replayed transition on, until the learner leaves replay: rows are
// packed by the lanes in use. The array is not zeroed; no word is read before `hold_weights` has written it.
var<workgroup> held_weights: array<f32, HELD_WORDS>;
var<private> weights_held: bool;

fn weights_offset(skill: u32, units: u32, net: u32) -> u32 {
    return select(net_offset(skill, net), net * skills[skill].rows * units, weights_held);
}

fn row_stride(units: u32) -> u32 {
    return select(LANES, units, weights_held);
}

fn weight(at: u32) -> f32 {
    if weights_held {
        return held_weights[at];
    }
    return nets[at];
}

fn set_weight(at: u32, value: f32) {
    if weights_held {
        held_weights[at] = value;
    } else {
        nets[at] = value;
    }
}

fn hold_weights(lane: u32) {
    let skill = state.skill;
    let units = lanes_used(params[params_base + skill].hidden);
    let rows = skills[skill].rows;
    if !weights_held && skills[skill].nets * rows * units <= HELD_WORDS {
        for (var number = 0u; number < skills[skill].nets; number++) {
            let net = net_offset(skill, number);
            for (var row = 0u; row < rows; row++) {
                if lane < units {
                    held_weights[(number * rows + row) * units + lane] = nets[net + row * LANES + lane];
                }
            }
        }
        weights_held = true;
        workgroupBarrier();
    }
}

fn release_weights(lane: u32) {
    if weights_held {
        let skill = state.skill;
        let units = lanes_used(params[params_base + skill].hidden);
        let rows = skills[skill].rows;
        for (var number = 0u; number < skills[skill].nets; number++) {
            let net = net_offset(skill, number);
            for (var row = 0u; row < rows; row++) {
                if lane < units {
                    nets[net + row * LANES + lane] = held_weights[(number * rows + row) * units + lane];
                }
            }
        }
        weights_held = false;
        storageBarrier();
        workgroupBarrier();
    }
}
