// Where a trial begins: a random point of a region's cells and a random heading.
//
// A region is a list of two-inch cells, each free as a whole, so no draw is ever rejected.

const REGION_CELL: f32 = 2.0f;

struct Pose {
    x: f32,
    y: f32,
    heading: f32,
}

// The robot, between the kernel's reading of it and its writing it back. Every lane keeps the same copy.
var<private> agent: Agent;

fn start_region(skill: u32, word: u32) -> u32 {
    let mark = unit(word);
    var chosen = skills[skill].starts - 1u;
    var open = true;
    for (var region = 0u; region < MAX_STARTS; region++) {
        let here = open && region < skills[skill].starts && mark < skills[skill].start_share[region];
        chosen = select(chosen, region, here);
        open = open && !here;
    }
    return chosen;
}

fn start_pose(offset: u32, count: u32, words: vec4<u32>) -> Pose {
    let cell = tables[offset + below(words.y, count)];
    let dx = f32(words.z & 0xffffu) * 1.5258789e-5f;
    let dy = f32(words.z >> 16u) * 1.5258789e-5f;
    let x = (f32(cell & 0xffffu) + dx) * REGION_CELL;
    let y = (f32(cell >> 16u) + dy) * REGION_CELL;
    return Pose(x, y, wrap_degrees(unit(words.w) * 360.0f));
}

fn reset(pose: Pose) {
    agent = Agent();
    agent.x = pose.x;
    agent.y = pose.y;
    agent.heading = pose.heading;
    agent.origin = room_of(pose.x, pose.y);
    agent.blocked = NO_ACTION;
    agent.action = NO_ACTION;
    agent.discount = 1.0f;
    for (var n = 0u; n < MAX_SKILLS; n++) {
        agent.run[n] = NO_CHILD;
    }
}
