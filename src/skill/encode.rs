//! A record's encoding as inputs of a net: groups of inputs, one after another.

use crate::learner::layout::{RAYS, SkillPlan};
use crate::learner::memory::{Scratch, Shared};
use crate::math::functions::sin_cos;

/// Input group: a table of the sonar reading.
pub const GROUP_SONAR: u32 = 0;
/// Input group: light bits.
pub const GROUP_LIGHT: u32 = 1;
/// Input group: bumper bits.
pub const GROUP_BUMPERS: u32 = 2;
/// Input group: cosine and sine of the compass.
pub const GROUP_COMPASS: u32 = 3;

/// Turns the record into the inputs of a skill's nets.
#[inline(always)]
pub fn encode(shared: &Shared, scratch: &mut Scratch, skill: &SkillPlan) {
    for group in 0..skill.groups as usize {
        let kind = skill.group_kind[group];
        let first = skill.group_first[group] as usize;
        if kind == GROUP_SONAR {
            let table = skill.group_table[group] as usize;
            for lane in 0..RAYS {
                let byte = (scratch.record[lane / 4] >> (8 * (lane % 4))) & 0xff;
                scratch.inputs[first + lane] = f32::from_bits(shared.atlas[table + byte as usize]);
            }
        } else if kind == GROUP_LIGHT {
            for lane in 0..RAYS {
                scratch.inputs[first + lane] = ((scratch.record[6] >> lane) & 1) as f32;
            }
        } else if kind == GROUP_BUMPERS {
            for lane in 0..4 {
                scratch.inputs[first + lane] = ((scratch.record[6] >> (24 + lane)) & 1) as f32;
            }
        } else {
            let (sine, cosine) = sin_cos(f32::from_bits(scratch.record[7]));
            scratch.inputs[first] = cosine;
            scratch.inputs[first + 1] = sine;
        }
    }
}
