//! Where a trial begins: a random point of a region's cells and a random heading.
//!
//! A region is a list of two-inch cells, each free as a whole, so no draw is ever rejected.

use crate::layout::{MAX_STARTS, SkillShape};
use crate::math::functions::wrap_degrees;
use crate::math::rng::{below, unit};
use crate::world::Pose;

/// Side of a region's cells, inches.
pub const CELL: f32 = 2.0;

/// Region in which a training trial starts.
#[inline(always)]
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
#[inline(always)]
pub fn start_pose(tables: &[u32], offset: u32, count: u32, words: [u32; 4]) -> Pose {
    let cell = tables[(offset + below(words[1], count)) as usize];
    let dx = (words[2] & 0xffff) as f32 * 1.525_878_9e-5_f32;
    let dy = (words[2] >> 16) as f32 * 1.525_878_9e-5_f32;
    let x = ((cell & 0xffff) as f32 + dx) * CELL;
    let y = ((cell >> 16) as f32 + dy) * CELL;
    Pose { x, y, heading: wrap_degrees(unit(words[3]) * 360.0) }
}
