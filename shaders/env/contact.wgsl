// Contact of the disc with the segments: how far a move gets, and what touches the bumpers.
//
// Lanes are segments. Contact with a segment is contact with its line between the ends, or with one of
// its two end points; both are quadratic-free or a single square root.

const FAR: f32 = 1.0e6f;
const STILL: f32 = 1.0e-7f;

struct Travel {
    distance: f32,
    blocked: bool,
    connected: bool,
}

// Distance at which the rim meets a point at (`ex`, `ey`) from the centre, `FAR` if it never does, and how
// far the centre then still is behind the point.
fn disc_to_point(ex: f32, ey: f32, ux: f32, uy: f32) -> vec2<f32> {
    let ahead = ex * ux + ey * uy;
    let across = ex * uy - ey * ux;
    let chord = RADIUS * RADIUS - across * across;
    let back = square_root(chord);
    let gap = ahead - back;
    let reach = select(0.0f, gap, gap > 0.0f);
    return vec2<f32>(select(FAR, reach, chord > 0.0f && ahead > 0.0f), back);
}

// Distance to contact with one segment, and the cosine between the travel and the contact point.
fn disc_to_segment(i: u32, x: f32, y: f32, ux: f32, uy: f32) -> vec2<f32> {
    let wx = x - world.segment[i].ax;
    let wy = y - world.segment[i].ay;
    let tx = world.segment[i].tx;
    let ty = world.segment[i].ty;
    let length = world.segment[i].length;
    // The line between the ends: the gap closes at a constant rate.
    let side = tx * wy - ty * wx;
    let drift = tx * uy - ty * ux;
    let closing = select(-drift, drift, side < 0.0f);
    let rate = select(STILL, closing, closing > STILL);
    let gap = (abs(side) - RADIUS) * reciprocal(rate);
    let line_reach = select(0.0f, gap, gap > 0.0f);
    let along = (tx * wx + ty * wy) + (tx * ux + ty * uy) * line_reach;
    let line_hit = closing > STILL && along >= 0.0f && along <= length;
    var reach = select(FAR, line_reach, line_hit);
    var cosine = closing;
    // The end points: the disc's rim meets a point.
    let meet_a = disc_to_point(-wx, -wy, ux, uy);
    let hit_a = length >= 0.0f && meet_a.x < reach;
    cosine = select(cosine, meet_a.y * INVERSE_RADIUS, hit_a);
    reach = select(reach, meet_a.x, hit_a);
    let meet_b = disc_to_point(world.segment[i].bx - x, world.segment[i].by - y, ux, uy);
    let hit_b = length >= 0.0f && meet_b.x < reach;
    cosine = select(cosine, meet_b.y * INVERSE_RADIUS, hit_b);
    reach = select(reach, meet_b.x, hit_b);
    return vec2<f32>(reach, cosine);
}

fn sweep_disc(lane: u32, x: f32, y: f32, ux: f32, uy: f32, reach: f32) -> Travel {
    var nearest = FAR;
    var charger = 0u;
    for (var first = 0u; first < world.segments; first += LANES) {
        let i = first + lane;
        if i < world.segments {
            let hit = disc_to_segment(i, x, y, ux, uy);
            let closer = hit.x < nearest;
            let plug = world.segment[i].charger == 1u && hit.y >= world.dock_cosine;
            // Segments touched at once count together, on one lane as on several.
            let level = select(charger, charger | u32(plug), hit.x == nearest);
            charger = select(level, u32(plug), closer);
            nearest = select(nearest, hit.x, closer);
        }
    }
    let least = lanes_min(lane, nearest);
    let plug = select(0u, charger, nearest == least);
    let plugged = lanes_or(lane, plug);
    let blocked = least < reach;
    return Travel(select(reach, least, blocked), blocked, blocked && plugged == 1u);
}

fn touching_bumpers(lane: u32, x: f32, y: f32, cosine: f32, sine: f32) -> u32 {
    var bits = 0u;
    for (var first = 0u; first < world.segments; first += LANES) {
        let i = first + lane;
        if i < world.segments {
            let wx = x - world.segment[i].ax;
            let wy = y - world.segment[i].ay;
            let tx = world.segment[i].tx;
            let ty = world.segment[i].ty;
            let length = world.segment[i].length;
            let foot = tx * wx + ty * wy;
            let low = select(0.0f, foot, foot > 0.0f);
            let along = select(length, low, low < length);
            let px = tx * along - wx;
            let py = ty * along - wy;
            let near = px * px + py * py < (RADIUS + BUMPER_GAP) * (RADIUS + BUMPER_GAP) && length >= 0.0f;
            let front = px * cosine + py * sine;
            let left = py * cosine - px * sine;
            let lengthwise = abs(front) >= abs(left);
            let sector = select(select(8u, 2u, left > 0.0f), select(4u, 1u, front > 0.0f), lengthwise);
            bits |= select(0u, sector, near);
        }
    }
    return lanes_or(lane, bits);
}
