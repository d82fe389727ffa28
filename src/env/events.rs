//! What an action brought about, and what that earns.

use super::motion::{ACTED, BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, LIT, PASSED_DOOR};
use super::workgroup::Workgroup;
use crate::layout::events::{ENTERED_REGION, IN_REGION, LEFT_REGION};
use crate::layout::{Area, EVENTS, Observation, RAYS, REGION_EVENTS, WorldUniform};

/// Stands for no room.
pub const NOWHERE: u32 = 255;
/// First ray of the sector on the left, 30 degrees from straight ahead. Our choice.
pub const SIDE_FIRST: usize = 2;
/// Last ray of it, 150 degrees from straight ahead. Our choice: it bridges a doorway.
pub const SIDE_LAST: usize = 10;

impl Area {
    /// Whether the point lies in the rectangle, its left and bottom edges counted in.
    pub fn holds(&self, x: f32, y: f32) -> bool {
        x >= self.x0 && x < self.x1 && y >= self.y0 && y < self.y1
    }

    /// Events of this region where an action took the robot from (`before_x`, `before_y`) to (`x`, `y`).
    pub fn crossing_events(&self, before_x: f32, before_y: f32, x: f32, y: f32) -> u32 {
        let before = self.holds(before_x, before_y);
        let now = self.holds(x, y);
        let inside = if now { IN_REGION } else { 0 };
        let entered = if now && !before { ENTERED_REGION } else { 0 };
        let left = if before && !now { LEFT_REGION } else { 0 };
        inside | entered | left
    }
}

impl WorldUniform {
    /// Room that holds the point, or [`NOWHERE`].
    pub fn room_of(&self, x: f32, y: f32) -> u32 {
        let mut found = NOWHERE;
        for room in 0..self.rooms {
            let inside = self.room[room as usize].holds(x, y);
            found = if inside && found == NOWHERE { room } else { found };
        }
        found
    }

    /// [`PASSED_DOOR`] where the robot is in another room than `origin` and clear of every doorway.
    pub fn passed_door(&self, origin: u32, x: f32, y: f32) -> u32 {
        let room = self.room_of(x, y);
        let mut clear = true;
        for door in 0..self.doors {
            let inside = self.doorway[door as usize].holds(x, y);
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

    /// All events that are found from what is observed after an action.
    pub fn observed_events(&self, near: u32, far: u32, action: u32, events: u32) -> u32 {
        self.following_wall(near, far, action, events) | self.seeing_light(events)
    }

    /// [`LIT`] where some bearing is lit after an action.
    pub fn seeing_light(&self, events: u32) -> u32 {
        let lit = self.lit_bearings() != 0 && (events & ACTED) == ACTED;
        if lit { LIT } else { 0 }
    }
}

impl Workgroup<'_> {
    /// Events of the last action, in the terms of a skill: with those of the regions that it names.
    pub fn skill_events(&self, skill: u32) -> u32 {
        let s = skill as usize;
        let mut events = self.agent.events;
        // Where a trial begins nothing has happened yet.
        let regions = if (events & ACTED) == ACTED { self.skills[s].regions } else { 0 };
        for region in 0..regions {
            let area = self.skills[s].region[region as usize];
            let crossed = area.crossing_events(self.agent.before_x, self.agent.before_y, self.agent.x, self.agent.y);
            events |= crossed << (EVENTS as u32 + region * REGION_EVENTS as u32);
        }
        events
    }

    /// Sum of the amounts of the events that happened, in the terms of a skill.
    pub fn reward_of(&self, skill: u32, events: u32) -> f32 {
        let mut sum = 0.0;
        let mut left = events;
        while left != 0 {
            sum += self.params[skill as usize].reward[left.trailing_zeros() as usize];
            left &= left - 1;
        }
        sum
    }
}
