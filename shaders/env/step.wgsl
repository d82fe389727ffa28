// One primitive step of a robot in a trial: it observes, which settles what its last action earned, and it acts.

fn observe_and_score(lane: u32, skill: u32) {
    let s = params_base + skill;
    observe(lane, agent.x, agent.y, agent.heading, agent.bumpers, params[s].noise);
    agent.events |= observed_events(params[s].beside_near, params[s].beside_far, agent.action, agent.events);
    agent.earned = reward_of(skill, skill_events(skill));
    agent.reward = agent.reward + agent.earned;
    agent.returned = agent.returned + agent.discount * agent.earned;
    agent.discount = select(flush(agent.discount * params[s].gamma), 1.0f, agent.step == 0u);
    remember(skill);
}

fn apply_action(lane: u32, skill: u32, action: u32) {
    let noise_terms = params[params_base + skill].noise;
    let slip = noise_terms.actuator * noise(noise_terms.kind, random[DRAW_ACTUATOR].x, random[DRAW_ACTUATOR].y) + 1.0f;
    let moved = move_body(lane, agent.x, agent.y, agent.heading, action, slip);
    let passed = passed_door(agent.origin, moved.x, moved.y);
    let hit = (moved.events & COLLISION) == COLLISION;
    agent.before_x = agent.x;
    agent.before_y = agent.y;
    agent.x = moved.x;
    agent.y = moved.y;
    agent.heading = moved.heading;
    agent.bumpers = moved.bumpers;
    if passed == PASSED_DOOR {
        agent.origin = room_of(moved.x, moved.y);
    }
    agent.blocked = select(NO_ACTION, action, hit && agent.masks == 1u);
    agent.action = action;
    agent.events = moved.events | passed | ACTED;
    agent.step += 1u;
    agent.collisions += u32(hit);
}
