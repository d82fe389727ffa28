// One reading of all sensors, packed into a record.
//
// A record's words: 0 to 5 the 24 sonar readings, a byte each; 6 the light bits and, from bit 24, the
// bumpers; 7 the compass; 8 what was done (see `lesson/record`); 9 the reward.

const DRAW_SONAR: u32 = 0u;
const DRAW_ACTUATOR: u32 = 6u;
const DRAW_COMPASS: u32 = 7u;
const DRAW_CHOICE: u32 = 8u;
const DRAW_LIGHT: u32 = 16u;

var<workgroup> record: array<u32, RECORD_WORDS>;
var<workgroup> readings: array<u32, LANES>;

fn hear(lane: u32, x: f32, y: f32, ux: f32, uy: f32, terms: Noise) -> u32 {
    let range = ranges(lane, x, y, ux, uy);
    let error = terms.sonar * coarse_noise(terms.kind, bearing_words(DRAW_SONAR, lane % RAYS)) + 1.0f;
    return reading(range, error);
}

fn see(lane: u32, x: f32, y: f32, ux: f32, uy: f32, terms: Noise) -> u32 {
    var lit = 0u;
    if world.lit == 1u {
        let most = falloff(x, y);
        // No noise reaches 3.5.
        if most * (terms.light * 3.5f + 1.0f) > 1.0f && in_sight(lane, x, y) {
            let facing_x = select(ux, -ux, lane >= LINES);
            let facing_y = select(uy, -uy, lane >= LINES);
            let bright = brightness(most, x, y, facing_x, facing_y);
            let shift = coarse_noise(terms.kind, bearing_words(DRAW_LIGHT, lane % RAYS));
            let glow = bright * (terms.light * shift + 1.0f);
            lit = lanes_or(lane, select(0u, 1u << lane, glow > 1.0f && lane < RAYS));
        }
    }
    return lit;
}

fn compass(heading: f32, error: f32, deviation: f32) -> f32 {
    return wrap_degrees(heading + deviation * error);
}

fn observe(lane: u32, x: f32, y: f32, heading: f32, bumpers: u32, terms: Noise) {
    let turn = sin_cos(heading);
    let u = rays(lane, turn.y, turn.x);
    readings[lane] = hear(lane, x, y, u.x, u.y, terms);
    let lit = see(lane, x, y, u.x, u.y, terms);
    workgroupBarrier();
    if lane < 6u {
        record[lane] = readings[lane * 4u]
            | (readings[lane * 4u + 1u] << 8u)
            | (readings[lane * 4u + 2u] << 16u)
            | (readings[lane * 4u + 3u] << 24u);
    }
    if lane == 6u {
        record[6] = lit | (bumpers << 24u);
    }
    if lane == 7u {
        let error = noise(terms.kind, random[DRAW_COMPASS].x, random[DRAW_COMPASS].y);
        record[7] = bitcast<u32>(compass(heading, error, terms.compass));
    }
    workgroupBarrier();
}
