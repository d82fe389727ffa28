//! What an action brought about, and what that earns.

use super::motion::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, PASSED_DOOR};
use super::workgroup::Workgroup;
use crate::layout::{EVENTS, Observation, RAYS, WorldUniform};

/// Stands for no room.
pub const NOWHERE: u32 = 255;
/// First ray of the sector on the left, 30 degrees from straight ahead. Our choice.
pub const SIDE_FIRST: usize = 2;
/// Last ray of it, 150 degrees from straight ahead. Our choice: it bridges a doorway.
pub const SIDE_LAST: usize = 10;

impl WorldUniform {
    /// Room that holds the point, or [`NOWHERE`].
    pub fn room_of(&self, x: f32, y: f32) -> u32 {
        let mut found = NOWHERE;
        for room in 0..self.rooms {
            let area = self.room[room as usize];
            let inside = x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1;
            found = if inside && found == NOWHERE { room } else { found };
        }
        found
    }

    /// [`PASSED_DOOR`] where the robot is in another room than `origin` and clear of every doorway.
    pub fn passed_door(&self, origin: u32, x: f32, y: f32) -> u32 {
        let room = self.room_of(x, y);
        let mut clear = true;
        for door in 0..self.doors {
            let way = self.doorway[door as usize];
            let inside = x >= way.x0 && x < way.x1 && y >= way.y0 && y < way.y1;
            clear = clear && !inside;
        }
        let passed = clear && room != NOWHERE && origin != NOWHERE && room != origin;
        if passed { PASSED_DOOR } else { 0 }
    }
}

impl Observation {
    /// [`BESIDE_RIGHT`] and [`BESIDE_LEFT`] where a forward move that was not blocked ended with the nearest reading of
    /// that side between `near` and `far` inches.
    pub fn following_wall(&self, near: u32, far: u32, action: u32, events: u32) -> u32 {
        let mut left = 255;
        let mut right = 255;
        for ray in SIDE_FIRST..=SIDE_LAST {
            let reading = self.sonar_inches(ray);
            let other = self.sonar_inches(RAYS - ray);
            left = if reading < left { reading } else { left };
            right = if other < right { other } else { right };
        }
        // The charger stops a move as a wall does: who pushes against it does not follow a wall.
        let went = action == FORWARD && (events & (COLLISION | DOCKED)) == 0;
        let on_left = if went && left >= near && left <= far { BESIDE_LEFT } else { 0 };
        let on_right = if went && right >= near && right <= far { BESIDE_RIGHT } else { 0 };
        on_left | on_right
    }
}

impl Workgroup<'_> {
    /// Sum of the amounts of the events that happened, in the terms of a skill.
    pub fn reward_of(&self, skill: u32, events: u32) -> f32 {
        let mut sum = 0.0;
        for event in 0..EVENTS {
            let amount = self.params[skill as usize].reward[event];
            sum += if (events >> event) & 1 == 1 { amount } else { 0.0 };
        }
        sum
    }
}
