// A record's encoding as inputs of a net: groups of inputs, one after another.

var<workgroup> inputs: array<f32, MAX_INPUTS>;

fn coded(table: u32, ray: u32) -> f32 {
    let byte = (record[ray / 4u] >> (8u * (ray % 4u))) & 0xffu;
    return bitcast<f32>(tables[table + byte]);
}

fn marked(skill: u32, kind: u32, lane: u32) -> f32 {
    let word = record[BASE_WORDS];
    let running = word & 0xffu;
    let applicable = (word >> 8u) & 0xffu;
    let room = (word >> 16u) & 0xffu;
    var value = 0.0f;
    if kind == GROUP_LIT {
        value = select(0.0f, 1.0f, (record[6] & 0x00ffffffu) != 0u);
    } else if kind == GROUP_RUNNING {
        value = select(0.0f, 1.0f, running == lane);
    } else if kind == GROUP_ROOM {
        value = select(0.0f, 1.0f, room == lane);
    } else if kind == GROUP_RANGE_MEANS {
        value = bitcast<f32>(record[MEMORY_WORD + lane]);
    } else if kind == GROUP_LIGHT_TRACE {
        value = bitcast<f32>(record[MEMORY_WORD + 2u]);
    } else if kind == GROUP_DOOR_TRACE {
        value = bitcast<f32>(record[MEMORY_WORD + 3u + lane]);
    } else {
        // Of the children that have a threshold, the one that as many stand before as this lane has.
        var before = 0u;
        for (var child = 0u; child < skills[skill].children; child++) {
            let has = ((skills[skill].thresholded >> child) & 1u) == 1u;
            if has && before == lane {
                let own = bitcast<f32>(record[VALUE_WORD + child]);
                let bit = select(0.0f, 1.0f, ((applicable >> child) & 1u) == 1u);
                value = select(bit, own, kind == GROUP_VALUES);
            }
            before += u32(has);
        }
    }
    return value;
}

fn encode(lane: u32, skill: u32, mirrored: bool) {
    for (var group = 0u; group < skills[skill].groups; group++) {
        let kind = skills[skill].group_kind[group];
        let first = skills[skill].group_first[group];
        let width = skills[skill].group_width[group];
        let table = skills[skill].group_table[group];
        if kind == GROUP_SONAR {
            if lane < RAYS {
                let ray = select(lane, (RAYS - lane) % RAYS, mirrored);
                inputs[first + lane] = coded(table, ray);
            }
        } else if kind == GROUP_SONAR_COMPASS {
            // Bearing b of the compass lies between the readings that look just before and just after it.
            let turn = bitcast<f32>(record[7]) * READINGS_PER_DEGREE;
            let whole = u32(turn);
            let part = turn - f32(whole);
            if lane < RAYS {
                let after = (lane + 2u * RAYS - whole) % RAYS;
                let before = (after + RAYS - 1u) % RAYS;
                let near = coded(table, after);
                inputs[first + lane] = near + part * (coded(table, before) - near);
            }
        } else if kind == GROUP_LIGHT {
            if lane < RAYS {
                let ray = select(lane, (RAYS - lane) % RAYS, mirrored);
                inputs[first + lane] = f32((record[6] >> ray) & 1u);
            }
        } else if kind == GROUP_BUMPERS {
            if lane < 4u {
                let side = select(lane, (4u - lane) % 4u, mirrored);
                inputs[first + lane] = f32((record[6] >> (24u + side)) & 1u);
            }
        } else if kind == GROUP_COMPASS || kind == GROUP_COMPASS2 {
            let compass = bitcast<f32>(record[7]);
            let turn = sin_cos(select(wrap_degrees(compass * 2.0f), compass, kind == GROUP_COMPASS));
            if lane == 0u {
                inputs[first] = turn.y;
                inputs[first + 1u] = turn.x;
            }
        } else {
            if lane < width {
                inputs[first + lane] = marked(skill, kind, lane);
            }
        }
    }
    workgroupBarrier();
}
