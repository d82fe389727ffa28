// One reading of all sensors, written into the record.

const DRAW_SONAR: u32 = 0u;
const DRAW_ACTUATOR: u32 = 6u;
const DRAW_COMPASS: u32 = 7u;
const DRAW_CHOICE: u32 = 8u;
const DRAW_LIGHT: u32 = 16u;

var<workgroup> readings: array<u32, LANES>;

fn sonar_scan(lane: u32, x: f32, y: f32, ux: f32, uy: f32, noise_terms: Noise) -> u32 {
    let range = ranges(lane, x, y, ux, uy);
    let error = noise_terms.sonar * coarse_noise(noise_terms.kind, bearing_word(DRAW_SONAR, lane % RAYS)) + 1.0f;
    return sonar_reading(range, error);
}

fn light_scan(lane: u32, x: f32, y: f32, ux: f32, uy: f32, noise_terms: Noise) -> u32 {
    var lit = 0u;
    if world.lit == 1u {
        let most = falloff(x, y);
        // No noise reaches 3.5.
        if most * (noise_terms.light * 3.5f + 1.0f) > 1.0f && light_in_sight(lane, x, y) {
            let facing_x = select(ux, -ux, lane >= LINES);
            let facing_y = select(uy, -uy, lane >= LINES);
            let bright = brightness(most, x, y, facing_x, facing_y);
            let shift = coarse_noise(noise_terms.kind, bearing_word(DRAW_LIGHT, lane % RAYS));
            let glow = bright * (noise_terms.light * shift + 1.0f);
            let bit = select(0u, 1u << lane, glow > 1.0f && lane < RAYS);
            lit = lanes_or(lane, bit);
        }
    }
    return lit;
}

fn compass_reading(heading: f32, error: f32, deviation: f32) -> f32 {
    return wrap_degrees(heading + deviation * error);
}

fn observe(lane: u32, x: f32, y: f32, heading: f32, bumpers: u32, noise_terms: Noise) {
    let turn = sin_cos(heading);
    let u = line_direction(lane, turn.y, turn.x);
    readings[lane] = sonar_scan(lane, x, y, u.x, u.y, noise_terms);
    let lit = light_scan(lane, x, y, u.x, u.y, noise_terms);
    workgroupBarrier();
    if lane < SONAR_WORDS {
        record[OBSERVATION_SONAR + lane] = readings[lane * 4u]
            | (readings[lane * 4u + 1u] << 8u)
            | (readings[lane * 4u + 2u] << 16u)
            | (readings[lane * 4u + 3u] << 24u);
    }
    if lane == 6u {
        record[OBSERVATION_LIGHT_BUMPERS] = lit | (bumpers << BUMPERS_FROM);
    }
    if lane == 7u {
        let error = noise(noise_terms.kind, random[DRAW_COMPASS].x, random[DRAW_COMPASS].y);
        record[OBSERVATION_COMPASS] = bitcast<u32>(compass_reading(heading, error, noise_terms.compass));
    }
    workgroupBarrier();
}
