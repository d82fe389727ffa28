// Which children are applicable, and which may be chosen now: the Applicability Rule and the Persistence Rule
// (paper, section VI.B).

const IDLE: u32 = NO_CHILD;

struct Options {
    applicable: u32,
    choices: u32,
    allowed: u32,
    decision: u32,
}

fn extend(lane: u32, n: u32) {
    let s = params_base + n;
    var applicable = 0u;
    for (var child = 0u; child < skills[n].children; child++) {
        let code = skills[n].child[child];
        let known = code >= SKILL_CODE && ((skills[n].thresholded >> child) & 1u) == 1u;
        var worth = 0.0f;
        if known {
            worth = value[code - SKILL_CODE];
        }
        let above = !known || worth > params[s].threshold[child];
        applicable |= select(0u, 1u << child, above);
        if lane == child {
            record[VALUE_WORD + child] = bitcast<u32>(worth);
        }
    }
    if lane >= skills[n].children && lane < MAX_CHILDREN {
        record[VALUE_WORD + lane] = 0u;
    }
    let running = agent.run[n] & 0xffu;
    let room = room_of(agent.x, agent.y);
    if lane == 0u {
        record[BASE_WORDS] = running | (applicable << 8u) | (room << 16u);
    }
    recall(lane);
}

fn options(n: u32, persist: bool) -> Options {
    let s = params_base + n;
    let all = (1u << skills[n].children) - 1u;
    var open = 0u;
    var actions = 0u;
    for (var child = 0u; child < skills[n].children; child++) {
        let code = skills[n].child[child];
        // A lone child is always available.
        let masked = params[s].mask_blocked == 1u && code == agent.blocked;
        let free = !masked || skills[n].children == 1u;
        open |= select(0u, 1u << child, free);
        actions |= select(0u, 1u << child, code < SKILL_CODE);
    }
    let high = actions != all;
    let applicable = select(all, (record[BASE_WORDS] >> 8u) & 0xffu, high);
    let suited = select(open, applicable & open, params[s].applicability == 1u);
    let choices = select(open, suited, suited != 0u);
    let run = agent.run[n];
    let running = run & 0xffu;
    let since = (run >> 8u) & 0xffu;
    let before = (run >> 16u) & 0xffu;
    var own = 0u;
    var code = NO_ACTION;
    if running < MAX_CHILDREN {
        own = 1u << running;
        code = skills[n].child[running];
    }
    // An action ends by itself; a skill ends where its goal is achieved.
    let skill = own != 0u && code >= SKILL_CODE;
    var ends = 0u;
    if skill {
        ends = skills[code - SKILL_CODE].ends;
    }
    let achieved = (agent.events & ends) != 0u;
    let fresh = (applicable & ~before & ~own) != 0u;
    let lost = params[s].interrupt == 1u && (applicable & own) == 0u;
    let late = params[s].child_timeout > 0u && since >= params[s].child_timeout;
    let free = !persist || !skill || achieved || fresh || lost || late;
    // What runs on is an alternative, even where it is no longer applicable: the step is learned with it.
    let offered = select(choices | own, choices, free);
    return Options(applicable, offered, select(own, choices, free), u32(free));
}

fn commit(n: u32, child: u32, options: Options) {
    let since = (agent.run[n] >> 8u) & 0xffu;
    let counted = select(since + 1u, 1u, options.decision == 1u);
    let held = select(255u, counted, counted < 255u);
    agent.run[n] = child | (held << 8u) | (options.applicable << 16u);
}

fn rest(root: u32, asked: u32) {
    for (var n = 0u; n < root; n++) {
        agent.run[n] = select(IDLE, agent.run[n], ((asked >> n) & 1u) == 1u);
    }
}
