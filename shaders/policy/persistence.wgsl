// Which children may be chosen now: the Persistence Rule (paper, section VI.B).

// What a skill may choose at one step. `offered` is what a free choice is made among; where the running child may not be
// left, that child as well.
struct Choices {
    applicable: u32,
    offered: u32,
    allowed: u32,
    decision: u32,
}

fn action_mask(n: u32, persist: bool) -> Choices {
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
    let applicable = select(all, high_level_applicable(record[STEP_HIGH_LEVEL]), high);
    let suited = select(open, applicable & open, params[s].applicability == 1u);
    let choices = select(open, suited, suited != 0u);
    let running = run_child(agent.run[n]);
    let before = run_applicable(agent.run[n]);
    var own = 0u;
    var code = NO_ACTION;
    if running < MAX_CHILDREN {
        own = 1u << running;
        code = skills[n].child[running];
    }
    // An action ends by itself; a skill ends where its goal is achieved.
    let skill = own != 0u && code >= SKILL_CODE;
    var achieved = false;
    if skill {
        let below = code - SKILL_CODE;
        achieved = (skill_events(below) & skills[below].ends) != 0u;
    }
    let fresh = (applicable & ~before & ~own) != 0u;
    let lost = params[s].interrupt == 1u && (applicable & own) == 0u;
    let late = params[s].child_timeout > 0u && run_steps(agent.run[n]) >= params[s].child_timeout;
    let free = !persist || !skill || achieved || fresh || lost || late;
    // What runs on is an alternative, even where it is no longer applicable: the step is learned with it.
    let offered = select(choices | own, choices, free);
    let allowed = select(own, choices, free);
    return Choices(applicable, offered, allowed, u32(free));
}

fn commit(n: u32, child: u32, choices: Choices) {
    let steps = run_steps(agent.run[n]);
    let counted = select(steps + 1u, 1u, choices.decision == 1u);
    let held = select(255u, counted, counted < 255u);
    agent.run[n] = run_word(child, held, choices.applicable);
}

// Skills that were not asked at this step no longer run.
fn stop_unasked(root: u32, asked: u32) {
    for (var n = 0u; n < root; n++) {
        agent.run[n] = select(NO_CHILD, agent.run[n], ((asked >> n) & 1u) == 1u);
    }
}
