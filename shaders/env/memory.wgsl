// What the robot remembers within a trial: enough to tell rooms apart that look alike, from its own sensors.
//
// All of it is our choice: the paper's high-level inputs are "abstract information derived from the low-level
// sensory inputs".

// Reading of the record that looks along the compass's direction `quarter` x 90 degrees, inches.
fn range_toward(quarter: u32) -> f32 {
    let turned = u32(compass_degrees() * READINGS_PER_DEGREE + 0.5f);
    let ray = (6u * quarter + 2u * RAYS - turned) % RAYS;
    return f32(sonar_inches(ray));
}

fn remember(skill: u32) {
    let s = params_base + skill;
    let across = (range_toward(0u) + range_toward(2u)) * INVERSE_LIMIT - 1.0f;
    let along = (range_toward(1u) + range_toward(3u)) * INVERSE_LIMIT - 1.0f;
    // The first reading stands for the past that there is not.
    let past = select(params[s].range_decay, 0.0f, agent.step == 0u);
    agent.east_west = flush(past * agent.east_west + (1.0f - past) * across);
    agent.north_south = flush(past * agent.north_south + (1.0f - past) * along);
    let lit = lit_bearings() != 0u;
    agent.light = select(flush(agent.light * params[s].light_decay), 1.0f, lit);
    let passed = (agent.events & PASSED_DOOR) != 0u;
    let turn = sin_cos(compass_degrees());
    agent.door = select(flush(agent.door * params[s].door_decay), 1.0f, passed);
    agent.door_cosine = select(flush(agent.door_cosine * params[s].door_decay), turn.y, passed);
    agent.door_sine = select(flush(agent.door_sine * params[s].door_decay), turn.x, passed);
}

fn recall(lane: u32) {
    if lane == 0u {
        record[STEP_EAST_WEST] = bitcast<u32>(agent.east_west);
        record[STEP_NORTH_SOUTH] = bitcast<u32>(agent.north_south);
        record[STEP_LIGHT_TRACE] = bitcast<u32>(agent.light);
        record[STEP_DOOR_TRACE] = bitcast<u32>(agent.door);
        record[STEP_DOOR_COSINE] = bitcast<u32>(agent.door_cosine);
        record[STEP_DOOR_SINE] = bitcast<u32>(agent.door_sine);
    }
    workgroupBarrier();
}
