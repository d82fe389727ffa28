// From the skills of a tree down to an action.
//
// The choice is made anew on every primitive step at every level (paper, section VI.A); persistence decides how
// free it is.

// Where the learner's hyper-parameters begin: one record per skill.
var<private> params_base: u32;
// All Q-values of each skill that some applicability depends on.
var<workgroup> kept_q: array<array<f32, MAX_CHILDREN>, MAX_SKILLS>;

// Q-values of skill `n`, from its nets or from the planner's table.
fn q_values(lane: u32, n: u32) {
    if skills[n].record_words > ELEMENTARY_STEP_WORDS {
        write_high_level(lane, n);
    }
    if skills[n].planned > 0u {
        planned_values(lane, n);
    } else {
        encode(lane, n, skills[n].mirrored == 1u);
        forward(lane, n);
    }
}

// Asks the skills below the root whose values somebody's applicability depends on, children first.
fn value_children(lane: u32, root: u32) {
    for (var n = 0u; n < root; n++) {
        if ((skills[root].watched >> n) & 1u) == 1u {
            q_values(lane, n);
            var best = -2.0f;
            for (var child = 0u; child < skills[n].children; child++) {
                let worth = q[child];
                best = select(best, worth, worth > best);
                if lane == child {
                    kept_q[n][child] = worth;
                }
            }
            if lane == 0u {
                best_value[n] = best;
            }
            // Nor does any lane go on before all have read the Q-values.
            workgroupBarrier();
        }
    }
}

// Lets the skills below the root choose, down to an action, once the root has chosen `child`.
fn descend_to_action(lane: u32, root: u32, child: u32) -> u32 {
    let inverse_temperature = params[params_base + root].child_inverse_temperature;
    var code = skills[root].child[child];
    var asked = 1u << root;
    var last = root;
    for (var depth = 1u; depth < MAX_DEPTH; depth++) {
        if code < SKILL_CODE {
            break;
        }
        let n = code - SKILL_CODE;
        if ((skills[root].watched >> n) & 1u) == 1u {
            if lane < skills[n].children {
                q[lane] = kept_q[n][lane];
            }
            workgroupBarrier();
            if skills[n].record_words > ELEMENTARY_STEP_WORDS {
                write_high_level(lane, n);
            }
        } else {
            q_values(lane, n);
        }
        let choices = action_mask(n, params[params_base + n].persist_tests == 1u);
        let word = random[DRAW_CHOICE + depth].x;
        let chosen = choose(lane, n, choices.allowed, inverse_temperature, false, word);
        commit(n, chosen, choices);
        code = skills[n].child[chosen];
        asked |= 1u << n;
        last = n;
    }
    stop_unasked(root, asked);
    agent.masks = params[params_base + last].mask_blocked;
    return code;
}
