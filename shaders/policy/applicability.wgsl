// Which children are applicable: the Applicability Rule (paper, section VI.B).

// Greatest Q-value of each skill that some applicability depends on.
var<workgroup> best_value: array<f32, MAX_SKILLS>;

fn run_word(child: u32, steps: u32, applicable: u32) -> u32 {
    return child | (steps << 8u) | (applicable << 16u);
}

fn run_child(run: u32) -> u32 {
    return run & 0xffu;
}

fn run_steps(run: u32) -> u32 {
    return (run >> 8u) & 0xffu;
}

fn run_applicable(run: u32) -> u32 {
    return (run >> 16u) & 0xffu;
}

fn high_level(running: u32, applicable: u32, room: u32) -> u32 {
    return running | (applicable << 8u) | (room << 16u);
}

fn high_level_running(word: u32) -> u32 {
    return word & 0xffu;
}

fn high_level_applicable(word: u32) -> u32 {
    return (word >> 8u) & 0xffu;
}

fn high_level_room(word: u32) -> u32 {
    return (word >> 16u) & 0xffu;
}

fn write_high_level(lane: u32, n: u32) {
    var applicable = 0u;
    for (var child = 0u; child < skills[n].children; child++) {
        let code = skills[n].child[child];
        let known = code >= SKILL_CODE && ((skills[n].thresholded >> child) & 1u) == 1u;
        var worth = 0.0f;
        if known {
            worth = best_value[code - SKILL_CODE];
        }
        let above = !known || worth > params[params_base + n].threshold[child];
        applicable |= select(0u, 1u << child, above);
        if lane == child {
            record[STEP_VALUE + child] = bitcast<u32>(worth);
        }
    }
    if lane >= skills[n].children && lane < MAX_CHILDREN {
        record[STEP_VALUE + lane] = 0u;
    }
    let room = room_of(agent.x, agent.y);
    if lane == 0u {
        record[STEP_HIGH_LEVEL] = high_level(run_child(agent.run[n]), applicable, room);
    }
    recall(lane);
}
