//! Where a trial begins: a random point of a region's cells and a random heading.
//!
//! A region is a list of two-inch cells, each free as a whole, so no draw is ever rejected.

use super::motion::NO_ACTION;
use super::workgroup::Workgroup;
use crate::layout::{Agent, MAX_SKILLS, MAX_STARTS, NO_CHILD, SkillShape};
use crate::math::functions::wrap_degrees;
use crate::math::rng::{below, unit};
use crate::world::Pose;
use bytemuck::Zeroable;

/// Side of a region's cells, inches.
pub const REGION_CELL: f32 = 2.0;

/// Region in which a training trial of a skill starts.
pub fn start_region(skill: &SkillShape, word: u32) -> u32 {
    let mark = unit(word);
    let mut chosen = skill.starts - 1;
    let mut open = true;
    for region in 0..MAX_STARTS as u32 {
        let here = open && region < skill.starts && mark < skill.start_share[region as usize];
        chosen = if here { region } else { chosen };
        open = open && !here;
    }
    chosen
}

/// A pose in a region: `words` pick the cell (y), the point in it (z) and the heading (w).
pub fn start_pose(tables: &[u32], offset: u32, count: u32, words: [u32; 4]) -> Pose {
    let cell = tables[(offset + below(words[1], count)) as usize];
    let dx = (words[2] & 0xffff) as f32 * 1.525_878_9e-5_f32;
    let dy = (words[2] >> 16) as f32 * 1.525_878_9e-5_f32;
    let x = ((cell & 0xffff) as f32 + dx) * REGION_CELL;
    let y = ((cell >> 16) as f32 + dy) * REGION_CELL;
    Pose { x, y, heading: wrap_degrees(unit(words[3]) * 360.0) }
}

impl Workgroup<'_> {
    /// Puts the robot at the start of a trial.
    pub fn reset(&mut self, pose: Pose) {
        self.agent = Agent::zeroed();
        self.agent.x = pose.x;
        self.agent.y = pose.y;
        self.agent.heading = pose.heading;
        self.agent.origin = self.world.room_of(pose.x, pose.y);
        self.agent.blocked = NO_ACTION;
        self.agent.action = NO_ACTION;
        self.agent.discount = 1.0;
        for n in 0..MAX_SKILLS {
            self.agent.run[n] = NO_CHILD;
        }
    }
}
