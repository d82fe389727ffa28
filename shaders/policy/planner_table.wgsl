// The planner in a skill's place: privileged, for it knows floor plan and pose. A baseline.
//
// It stands in the lookup tables: columns, rows, rooms of origin, 1 / pitch, then one word for each origin, row, column
// and heading: the value, with the child's number in its lowest three bits.

const TABLE_HEADER: u32 = 4u;
const TABLE_HEADINGS: u32 = 24u;
const TABLE_GAP: f32 = 1.0f;

fn planned_values(lane: u32, n: u32) {
    let table = skills[n].planned;
    let columns = tables[table];
    let rows = tables[table + 1u];
    let origins = tables[table + 2u];
    let inverse = bitcast<f32>(tables[table + 3u]);
    let column = min(u32(agent.x * inverse + 0.5f), columns - 1u);
    let row = min(u32(agent.y * inverse + 0.5f), rows - 1u);
    let heading = u32(agent.heading * READINGS_PER_DEGREE + 0.5f) % TABLE_HEADINGS;
    // Who began in no room has the first one's table, as with the planner.
    let origin = select(0u, agent.origin, agent.origin < origins);
    let entry = ((origin * rows + row) * columns + column) * TABLE_HEADINGS + heading;
    let word = tables[table + TABLE_HEADER + entry];
    let best = bitcast<f32>(word & 0xfffffff8u);
    if lane < skills[n].children {
        q[lane] = select(best - TABLE_GAP, best, lane == (word & 7u));
    }
    workgroupBarrier();
}
