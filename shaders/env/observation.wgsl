// What a reading of all sensors holds, taken out of its words.

// The step being recorded or replayed: what was sensed comes first.
var<workgroup> record: array<u32, STEP_WORDS>;

const LIGHT_MASK: u32 = 0x00ffffffu;

fn sonar_inches(ray: u32) -> u32 {
    return (record[OBSERVATION_SONAR + ray / 4u] >> (8u * (ray % 4u))) & 0xffu;
}

fn lit_bearings() -> u32 {
    return record[OBSERVATION_LIGHT_BUMPERS] & LIGHT_MASK;
}

fn bumper_bits() -> u32 {
    return record[OBSERVATION_LIGHT_BUMPERS] >> BUMPERS_FROM;
}

fn compass_degrees() -> f32 {
    return bitcast<f32>(record[OBSERVATION_COMPASS]);
}
