// One step of a robot that pursues a skill: it senses, remembers, asks the skills of the tree, and moves.
//
// The choice is made anew on every primitive step at every level (paper, section VI.A); persistence decides how
// free it is. Every lane keeps the same copy of the robot.

// The robot, between the kernel's reading of it and its writing it back.
var<private> agent: Agent;
// Where the learner's params begin: one record per skill.
var<private> params_base: u32;
// Greatest Q-value of each watched skill.
var<workgroup> value: array<f32, MAX_SKILLS>;
// All Q-values of each watched skill.
var<workgroup> kept: array<array<f32, MAX_CHILDREN>, MAX_SKILLS>;

fn place(pose: Pose) {
    agent = Agent();
    agent.x = pose.x;
    agent.y = pose.y;
    agent.heading = pose.heading;
    agent.origin = room_of(pose.x, pose.y);
    agent.blocked = NO_ACTION;
    agent.action = NO_ACTION;
    agent.discount = 1.0f;
    for (var n = 0u; n < MAX_SKILLS; n++) {
        agent.run[n] = IDLE;
    }
}

fn sense(lane: u32, s: u32) {
    let terms = params[s].noise;
    observe(lane, agent.x, agent.y, agent.heading, agent.bumpers, terms);
    agent.events |= following_wall(params[s].beside_near, params[s].beside_far, agent.action, agent.events);
    agent.earned = reward_of(s, agent.events);
    agent.reward = agent.reward + agent.earned;
    agent.returned = agent.returned + agent.discount * agent.earned;
    agent.discount = select(flush(agent.discount * params[s].gamma), 1.0f, agent.step == 0u);
    remember(s);
}

fn think(lane: u32, base: u32, n: u32) {
    if skills[n].record_words > BASE_WORDS {
        extend(lane, n);
    }
    if skills[n].planned > 0u {
        consult(lane, n);
    } else {
        encode(lane, n, skills[n].mirrored == 1u);
        forward(lane, n, params_base + n, base);
    }
}

fn watch(lane: u32, base: u32, root: u32) {
    let watched = skills[root].watched;
    for (var n = 0u; n < root; n++) {
        if ((watched >> n) & 1u) == 1u {
            think(lane, base, n);
            var best = -2.0f;
            for (var child = 0u; child < skills[n].children; child++) {
                let worth = q[child];
                best = select(best, worth, worth > best);
                if lane == child {
                    kept[n][child] = worth;
                }
            }
            if lane == 0u {
                value[n] = best;
            }
            // Nor does any lane think on before all have read the Q-values.
            workgroupBarrier();
        }
    }
}

fn descend(lane: u32, base: u32, root: u32, child: u32) -> u32 {
    let watched = skills[root].watched;
    let heat = params[params_base + root].child_inverse_temperature;
    var code = skills[root].child[child];
    var asked = 1u << root;
    var last = root;
    for (var depth = 1u; depth < MAX_DEPTH; depth++) {
        if code < SKILL_CODE {
            break;
        }
        let n = code - SKILL_CODE;
        if ((watched >> n) & 1u) == 1u {
            if lane < skills[n].children {
                q[lane] = kept[n][lane];
            }
            workgroupBarrier();
            if skills[n].record_words > BASE_WORDS {
                extend(lane, n);
            }
        } else {
            think(lane, base, n);
        }
        let own = params_base + n;
        let found = options(n, params[own].persist_tests == 1u);
        let word = random[DRAW_CHOICE + depth].x;
        let chosen = choose(lane, own, skills[n].children, found.allowed, heat, false, word);
        commit(n, chosen, found);
        code = skills[n].child[chosen];
        asked |= 1u << n;
        last = n;
    }
    rest(root, asked);
    agent.masks = params[params_base + last].mask_blocked;
    return code;
}

fn execute(lane: u32, s: u32, action: u32) {
    let terms = params[s].noise;
    let slip = terms.actuator * noise(terms.kind, random[DRAW_ACTUATOR].x, random[DRAW_ACTUATOR].y) + 1.0f;
    let moved = move_body(lane, agent.x, agent.y, agent.heading, action, slip);
    let passed = passed_door(agent.origin, moved.x, moved.y);
    let hit = (moved.events & COLLISION) == COLLISION;
    agent.x = moved.x;
    agent.y = moved.y;
    agent.heading = moved.heading;
    agent.bumpers = moved.bumpers;
    if passed == PASSED_DOOR {
        agent.origin = room_of(moved.x, moved.y);
    }
    agent.blocked = select(NO_ACTION, action, hit && agent.masks == 1u);
    agent.action = action;
    agent.events = moved.events | passed;
    agent.step += 1u;
    agent.collisions += u32(hit);
}
