// What the robot remembers within a trial: enough to tell rooms apart that look alike, from its own sensors.
//
// All of it is our choice: the paper's high-level inputs are "abstract information derived from the low-level
// sensory inputs".

fn looking(quarter: u32) -> f32 {
    let turned = u32(bitcast<f32>(record[7]) * READINGS_PER_DEGREE + 0.5f);
    let ray = (6u * quarter + 2u * RAYS - turned) % RAYS;
    return f32((record[ray / 4u] >> (8u * (ray % 4u))) & 0xffu);
}

fn remember(s: u32) {
    let across = (looking(0u) + looking(2u)) * 0.007874016f - 1.0f;
    let along = (looking(1u) + looking(3u)) * 0.007874016f - 1.0f;
    // The first reading stands for the past that there is not.
    let past = select(params[s].range_decay, 0.0f, agent.step == 0u);
    agent.east_west = flush(past * agent.east_west + (1.0f - past) * across);
    agent.north_south = flush(past * agent.north_south + (1.0f - past) * along);
    let lit = (record[6] & 0x00ffffffu) != 0u;
    agent.light = select(flush(agent.light * params[s].light_decay), 1.0f, lit);
    let passed = (agent.events & PASSED_DOOR) != 0u;
    let turn = sin_cos(bitcast<f32>(record[7]));
    agent.door = select(flush(agent.door * params[s].door_decay), 1.0f, passed);
    agent.door_cosine = select(flush(agent.door_cosine * params[s].door_decay), turn.y, passed);
    agent.door_sine = select(flush(agent.door_sine * params[s].door_decay), turn.x, passed);
}

fn recall(lane: u32) {
    if lane == 0u {
        record[MEMORY_WORD] = bitcast<u32>(agent.east_west);
        record[MEMORY_WORD + 1u] = bitcast<u32>(agent.north_south);
        record[MEMORY_WORD + 2u] = bitcast<u32>(agent.light);
        record[MEMORY_WORD + 3u] = bitcast<u32>(agent.door);
        record[MEMORY_WORD + 4u] = bitcast<u32>(agent.door_cosine);
        record[MEMORY_WORD + 5u] = bitcast<u32>(agent.door_sine);
    }
    workgroupBarrier();
}
