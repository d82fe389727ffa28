//! Motion and contact, eight segments side by side: those of the cell's list, which holds all that the robot can touch.

use crate::env::contact::{FAR, STILL, Travel, disc_to_point};
use crate::env::motion::{BACKWARD, COLLISION, DOCKED, FORWARD, heading_after};
use crate::env::segments::{BLOCK, SegmentBlock, SegmentGrid};
use crate::env::workgroup::Workgroup;
use crate::layout::Moved;
use crate::layout::lengths::{BUMPER_GAP, INVERSE_RADIUS, RADIUS};
use crate::math::functions::{reciprocal, sin_cos};
use crate::math::reduce::{lanes_min, lanes_or};

/// Distance to contact with one segment, and the cosine between the travel and the contact point.
#[inline(always)]
fn disc_to_segment(block: &SegmentBlock, lane: usize, x: f32, y: f32, ux: f32, uy: f32) -> (f32, f32) {
    let wx = x - block.ax[lane];
    let wy = y - block.ay[lane];
    let tx = block.tx[lane];
    let ty = block.ty[lane];
    let length = block.length[lane];
    // The line between the ends: the gap closes at a constant rate.
    let side = tx * wy - ty * wx;
    let drift = tx * uy - ty * ux;
    let closing = if side < 0.0 { drift } else { -drift };
    let rate = if closing > STILL { closing } else { STILL };
    let gap = (side.abs() - RADIUS) * reciprocal(rate);
    let line_reach = if gap > 0.0 { gap } else { 0.0 };
    let along = (tx * wx + ty * wy) + (tx * ux + ty * uy) * line_reach;
    let line_hit = closing > STILL && along >= 0.0 && along <= length;
    let mut reach = if line_hit { line_reach } else { FAR };
    let mut cosine = closing;
    // The end points: the disc's rim meets a point.
    let (reach_a, back_a) = disc_to_point(-wx, -wy, ux, uy);
    let hit_a = length >= 0.0 && reach_a < reach;
    cosine = if hit_a { back_a * INVERSE_RADIUS } else { cosine };
    reach = if hit_a { reach_a } else { reach };
    let (reach_b, back_b) = disc_to_point(block.bx[lane] - x, block.by[lane] - y, ux, uy);
    let hit_b = length >= 0.0 && reach_b < reach;
    cosine = if hit_b { back_b * INVERSE_RADIUS } else { cosine };
    reach = if hit_b { reach_b } else { reach };
    (reach, cosine)
}

/// Sweeps the disc past the segments in `near` from (`x`, `y`) along the unit vector (`ux`, `uy`) for at most `reach` inches.
/// Contact within `dock_cosine` of the direction of travel connects to the charger.
#[inline(always)]
pub fn sweep_disc(near: &[SegmentBlock], dock_cosine: f32, x: f32, y: f32, ux: f32, uy: f32, reach: f32) -> Travel {
    let mut nearest = [FAR; BLOCK];
    let mut charger = [0_u32; BLOCK];
    for block in near {
        for lane in 0..BLOCK {
            let (distance, cosine) = disc_to_segment(block, lane, x, y, ux, uy);
            let closer = distance < nearest[lane];
            let plug = block.charger[lane] == 1 && cosine >= dock_cosine;
            // Segments touched at once count together, on one lane as on several.
            let level = if distance == nearest[lane] { charger[lane] | u32::from(plug) } else { charger[lane] };
            charger[lane] = if closer { u32::from(plug) } else { level };
            nearest[lane] = if closer { distance } else { nearest[lane] };
        }
    }
    let least = lanes_min(&nearest);
    let mut plugs = [0_u32; BLOCK];
    for lane in 0..BLOCK {
        plugs[lane] = if nearest[lane] == least { charger[lane] } else { 0 };
    }
    let plugged = lanes_or(&plugs);
    let blocked = least < reach;
    Travel { distance: if blocked { least } else { reach }, blocked, connected: blocked && plugged == 1 }
}

/// Bits of the bumpers that touch something in `near`: 1 front, 2 left, 4 back, 8 right. (`cosine`, `sine`) is the heading.
#[inline(always)]
pub fn touching_bumpers(near: &[SegmentBlock], x: f32, y: f32, cosine: f32, sine: f32) -> u32 {
    let mut bits = [0_u32; BLOCK];
    for block in near {
        for lane in 0..BLOCK {
            let wx = x - block.ax[lane];
            let wy = y - block.ay[lane];
            let tx = block.tx[lane];
            let ty = block.ty[lane];
            let length = block.length[lane];
            let foot = tx * wx + ty * wy;
            let low = if foot > 0.0 { foot } else { 0.0 };
            let along = if low < length { low } else { length };
            let px = tx * along - wx;
            let py = ty * along - wy;
            let near = px * px + py * py < (RADIUS + BUMPER_GAP) * (RADIUS + BUMPER_GAP) && length >= 0.0;
            let front = px * cosine + py * sine;
            let left = py * cosine - px * sine;
            let lengthwise = front.abs() >= left.abs();
            let sector = if lengthwise {
                if front > 0.0 { 1 } else { 4 }
            } else if left > 0.0 {
                2
            } else {
                8
            };
            bits[lane] |= if near { sector } else { 0 };
        }
    }
    lanes_or(&bits)
}

/// Carries out an action whose length is off by the factor `slip`.
#[inline(always)]
pub fn move_body(group: &Workgroup<'_>, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved {
    body_after(group.floor, x, y, heading, action, slip)
}

/// The body after an action whose length is off by the factor `slip`.
#[inline(always)]
pub fn body_after(floor: &SegmentGrid, x: f32, y: f32, heading: f32, action: u32, slip: f32) -> Moved {
    let after = heading_after(heading, action, slip);
    let (sine, cosine) = sin_cos(after);
    travel(floor, x, y, after, sine, cosine, action, slip)
}

/// What is left of an action once the robot has its new `heading`, which comes with its sine and cosine.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "a pose with its sine and cosine, and an action")]
pub fn travel(
    floor: &SegmentGrid,
    x: f32,
    y: f32,
    heading: f32,
    sine: f32,
    cosine: f32,
    action: u32,
    slip: f32,
) -> Moved {
    let mut moved = Moved { x, y, heading, bumpers: 0, events: 0 };
    let wanted = 12.0 * slip;
    let reach = if wanted > 0.0 { wanted } else { 0.0 };
    let near = floor.touchable(x, y, reach);
    if action == FORWARD || action == BACKWARD {
        let ux = if action == FORWARD { cosine } else { -cosine };
        let uy = if action == FORWARD { sine } else { -sine };
        let travel = sweep_disc(near, floor.plan.dock_cosine, x, y, ux, uy, reach);
        moved.x = x + ux * travel.distance;
        moved.y = y + uy * travel.distance;
        let docked = travel.connected && action == FORWARD;
        let stopped = if travel.blocked { COLLISION } else { 0 };
        moved.events = if docked { DOCKED } else { stopped };
    }
    moved.bumpers = touching_bumpers(near, moved.x, moved.y, cosine, sine);
    moved
}
