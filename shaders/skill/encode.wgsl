// A record's encoding as inputs of a net: groups of inputs, one after another.

const GROUP_SONAR: u32 = 0u;
const GROUP_LIGHT: u32 = 1u;
const GROUP_BUMPERS: u32 = 2u;
const GROUP_COMPASS: u32 = 3u;

var<workgroup> inputs: array<f32, MAX_INPUTS>;

fn encode(lane: u32, skill: u32) {
    for (var group = 0u; group < skills[skill].groups; group++) {
        let kind = skills[skill].group_kind[group];
        let first = skills[skill].group_first[group];
        if kind == GROUP_SONAR {
            let table = skills[skill].group_table[group];
            if lane < RAYS {
                let byte = (record[lane / 4u] >> (8u * (lane % 4u))) & 0xffu;
                inputs[first + lane] = bitcast<f32>(atlas[table + byte]);
            }
        } else if kind == GROUP_LIGHT {
            if lane < RAYS {
                inputs[first + lane] = f32((record[6] >> lane) & 1u);
            }
        } else if kind == GROUP_BUMPERS {
            if lane < 4u {
                inputs[first + lane] = f32((record[6] >> (24u + lane)) & 1u);
            }
        } else {
            let turn = sin_cos(bitcast<f32>(record[7]));
            if lane == 0u {
                inputs[first] = turn.y;
                inputs[first + 1u] = turn.x;
            }
        }
    }
    workgroupBarrier();
}
