// Where a trial begins: a random point of a region's cells and a random heading.
//
// A region is a list of two-inch cells, each free as a whole, so no draw is ever rejected.

const CELL: f32 = 2.0f;

struct Pose {
    x: f32,
    y: f32,
    heading: f32,
}

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
    let x = (f32(cell & 0xffffu) + dx) * CELL;
    let y = (f32(cell >> 16u) + dy) * CELL;
    return Pose(x, y, wrap_degrees(unit(words.w) * 360.0f));
}
