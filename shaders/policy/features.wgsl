// What a net is given of a recorded step: groups of inputs, one after another.

var<workgroup> inputs: array<f32, MAX_INPUTS>;

fn sonar_feature(table: u32, ray: u32) -> f32 {
    return bitcast<f32>(tables[table + sonar_inches(ray)]);
}

fn scalar_feature(lane: u32, skill: u32, kind: u32) -> f32 {
    let running = high_level_running(record[STEP_HIGH_LEVEL]);
    let applicable = high_level_applicable(record[STEP_HIGH_LEVEL]);
    let room = high_level_room(record[STEP_HIGH_LEVEL]);
    var value = 0.0f;
    if kind == GROUP_LIT {
        value = select(0.0f, 1.0f, lit_bearings() != 0u);
    } else if kind == GROUP_RUNNING {
        value = select(0.0f, 1.0f, running == lane);
    } else if kind == GROUP_ROOM {
        value = select(0.0f, 1.0f, room == lane);
    } else if kind == GROUP_RANGE_MEANS {
        value = select(bitcast<f32>(record[STEP_NORTH_SOUTH]), bitcast<f32>(record[STEP_EAST_WEST]), lane == 0u);
    } else if kind == GROUP_LIGHT_TRACE {
        value = bitcast<f32>(record[STEP_LIGHT_TRACE]);
    } else if kind == GROUP_DOOR_TRACE {
        let way = select(bitcast<f32>(record[STEP_DOOR_SINE]), bitcast<f32>(record[STEP_DOOR_COSINE]), lane == 1u);
        value = select(way, bitcast<f32>(record[STEP_DOOR_TRACE]), lane == 0u);
    } else {
        // Of the children that have a threshold, the one that as many stand before as this lane has.
        var before = 0u;
        for (var child = 0u; child < skills[skill].children; child++) {
            let has = ((skills[skill].thresholded >> child) & 1u) == 1u;
            if has && before == lane {
                let own = bitcast<f32>(record[STEP_VALUE + child]);
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
                inputs[first + lane] = sonar_feature(table, ray);
            }
        } else if kind == GROUP_SONAR_COMPASS {
            // Bearing b of the compass lies between the readings that look just before and just after it.
            let turn = compass_degrees() * READINGS_PER_DEGREE;
            let whole = u32(turn);
            let part = turn - f32(whole);
            if lane < RAYS {
                let after = (lane + 2u * RAYS - whole) % RAYS;
                let before = (after + RAYS - 1u) % RAYS;
                let near = sonar_feature(table, after);
                inputs[first + lane] = near + part * (sonar_feature(table, before) - near);
            }
        } else if kind == GROUP_LIGHT {
            if lane < RAYS {
                let ray = select(lane, (RAYS - lane) % RAYS, mirrored);
                inputs[first + lane] = f32((lit_bearings() >> ray) & 1u);
            }
        } else if kind == GROUP_BUMPERS {
            if lane < 4u {
                let side = select(lane, (4u - lane) % 4u, mirrored);
                inputs[first + lane] = f32((bumper_bits() >> side) & 1u);
            }
        } else if kind == GROUP_COMPASS || kind == GROUP_COMPASS2 {
            let compass = compass_degrees();
            let angle = select(wrap_degrees(compass * 2.0f), compass, kind == GROUP_COMPASS);
            let turn = sin_cos(angle);
            if lane == 0u {
                inputs[first] = turn.y;
                inputs[first + 1u] = turn.x;
            }
        } else {
            if lane < width {
                inputs[first + lane] = scalar_feature(lane, skill, kind);
            }
        }
    }
    workgroupBarrier();
}
