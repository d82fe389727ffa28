//! What an action earned: events and their amounts.

use crate::env::motion::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, PASSED_DOOR};
use crate::layout::{EVENTS, HyperParams, RAYS, RECORD_WORDS, WorldUniform};

/// Stands for no room.
pub const NOWHERE: u32 = 255;
/// First ray of the sector on the left, 30 degrees from straight ahead. Our choice.
pub const SIDE_FIRST: u32 = 2;
/// Last ray of it, 150 degrees from straight ahead. Our choice: it bridges a doorway.
pub const SIDE_LAST: u32 = 10;

/// Room that holds the point, or [`NOWHERE`].
#[inline(always)]
pub fn room_of(world: &WorldUniform, x: f32, y: f32) -> u32 {
    let mut found = NOWHERE;
    for room in 0..world.rooms {
        let area = world.room[room as usize];
        let inside = x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
        found = if inside && found == NOWHERE { room } else { found };
    }
    found
}

/// [`PASSED_DOOR`] where the robot is in another room than `origin` and clear of every doorway.
#[inline(always)]
pub fn passed_door(world: &WorldUniform, origin: u32, x: f32, y: f32) -> u32 {
    let room = room_of(world, x, y);
    let mut clear = true;
    for door in 0..world.doors {
        let way = world.doorway[door as usize];
        let inside = x >= way.x0 && x < way.x1 && y >= way.y0 && y < way.y1;
        clear = clear && !inside;
    }
    let passed = clear && room != NOWHERE && origin != NOWHERE && room != origin;
    if passed { PASSED_DOOR } else { 0 }
}

/// [`BESIDE_RIGHT`] and [`BESIDE_LEFT`] where a forward move that was not blocked ended with the nearest reading of
/// that side between `near` and `far` inches.
#[inline(always)]
pub fn following_wall(record: &[u32; RECORD_WORDS], near: u32, far: u32, action: u32, events: u32) -> u32 {
    let mut left = 255;
    let mut right = 255;
    for ray in SIDE_FIRST..=SIDE_LAST {
        let reading = (record[(ray / 4) as usize] >> (8 * (ray % 4))) & 0xff;
        let mirror = RAYS as u32 - ray;
        let other = (record[(mirror / 4) as usize] >> (8 * (mirror % 4))) & 0xff;
        left = if reading < left { reading } else { left };
        right = if other < right { other } else { right };
    }
    // The charger stops a move as a wall does: who pushes against it does not follow a wall.
    let went = action == FORWARD && (events & (COLLISION | DOCKED)) == 0;
    let on_left = if went && left >= near && left <= far { BESIDE_LEFT } else { 0 };
    let on_right = if went && right >= near && right <= far { BESIDE_RIGHT } else { 0 };
    on_left | on_right
}

/// Sum of the amounts of the events that happened.
#[inline(always)]
pub fn reward_of(params: &HyperParams, events: u32) -> f32 {
    let mut sum = 0.0;
    for event in 0..EVENTS {
        let amount = params.reward[event];
        sum += if (events >> event) & 1 == 1 { amount } else { 0.0 };
    }
    sum
}
