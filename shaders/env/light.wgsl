// The rotating light sensor: 24 bits, lit where the charger's light is bright enough on that bearing.
//
// Brightness = (range / d)^2 exp(k (cos(angle off the light) - 1)), k = 1 / (15 degrees)^2, in line of
// sight only. Our choice: the paper states 24 binary readings and no more. Near the charger several
// bearings are lit, far away one.

const BEAM_SHARPNESS: f32 = 14.59025f;

fn light_in_sight(lane: u32, x: f32, y: f32) -> bool {
    let lx = world.light_x - x;
    let ly = world.light_y - y;
    var hidden = 0u;
    for (var first = 0u; first < world.segments; first += LANES) {
        let i = first + lane;
        if i < world.segments {
            let ax = world.segment[i].ax - x;
            let ay = world.segment[i].ay - y;
            let bx = world.segment[i].bx - x;
            let by = world.segment[i].by - y;
            let dx = world.segment[i].bx - world.segment[i].ax;
            let dy = world.segment[i].by - world.segment[i].ay;
            let at = crossing(ax, ay, bx, by, dx, dy, lx, ly);
            let solid = world.segment[i].charger == 0u && world.segment[i].length >= 0.0f;
            hidden |= u32(at.x >= 0.0f && at.x < at.y && solid);
        }
    }
    return lanes_or(lane, hidden) == 0u;
}

// Brightness of the light on a bearing that points at it, as if in sight; 1 is the threshold.
fn falloff(x: f32, y: f32) -> f32 {
    let lx = world.light_x - x;
    let ly = world.light_y - y;
    let square = lx * lx + ly * ly;
    // The light itself is out of the robot's reach; the bound keeps the functions in their range.
    let distance2 = select(1.0f, square, square > 1.0f);
    return world.light_range2 * reciprocal(distance2);
}

// Brightness of the light on a bearing, as if in sight, where it is `most` on a bearing that points at it.
fn brightness(most: f32, x: f32, y: f32, ux: f32, uy: f32) -> f32 {
    let lx = world.light_x - x;
    let ly = world.light_y - y;
    let square = lx * lx + ly * ly;
    let distance2 = select(1.0f, square, square > 1.0f);
    let nearness = reciprocal_sqrt(distance2);
    let aim = (ux * lx + uy * ly) * nearness;
    return most * exponential(BEAM_SHARPNESS * (aim - 1.0f));
}
