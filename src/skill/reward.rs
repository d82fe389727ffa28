//! What an action earned: events and their amounts.

use crate::learner::layout::{EVENTS, Settings, WorldPlan};
use crate::robot::motion::PASSED_DOOR;

/// Stands for no room.
pub const NOWHERE: u32 = 255;

/// Room that holds the point, or [`NOWHERE`].
#[inline(always)]
pub fn room_of(world: &WorldPlan, x: f32, y: f32) -> u32 {
    let mut found = NOWHERE;
    for room in 0..world.rooms {
        let area = world.room[room as usize];
        let inside = x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
        found = if inside && found == NOWHERE { room } else { found };
    }
    found
}

/// [`PASSED_DOOR`] where the robot is in another room than the trial's first and clear of every doorway.
#[inline(always)]
pub fn passed_door(world: &WorldPlan, origin: u32, x: f32, y: f32) -> u32 {
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

/// Sum of the amounts of the events that happened.
#[inline(always)]
pub fn reward_of(settings: &Settings, events: u32) -> f32 {
    let mut sum = 0.0;
    for event in 0..EVENTS {
        let amount = settings.reward[event];
        sum += if (events >> event) & 1 == 1 { amount } else { 0.0 };
    }
    sum
}
