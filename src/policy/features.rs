//! A record's encoding as inputs of a net: groups of inputs, one after another.

use crate::env::sonar::READINGS_PER_DEGREE;
use crate::env::workgroup::{CohortData, Scratch};
use crate::layout::sensors::{
    GROUP_BUMPERS, GROUP_COMPASS, GROUP_COMPASS2, GROUP_DOOR_TRACE, GROUP_LIGHT, GROUP_LIGHT_TRACE, GROUP_LIT,
    GROUP_RANGE_MEANS, GROUP_ROOM, GROUP_RUNNING, GROUP_SONAR, GROUP_SONAR_COMPASS, GROUP_VALUES,
};
use crate::layout::{BASE_WORDS, MEMORY_WORD, RAYS, SkillShape, VALUE_WORD};
use crate::math::functions::{sin_cos, wrap_degrees};

/// Entry of a sonar table for one ray of the record.
#[inline(always)]
pub fn coded(shared: &CohortData, scratch: &Scratch, table: u32, ray: usize) -> f32 {
    let byte = (scratch.record[ray / 4] >> (8 * (ray % 4))) & 0xff;
    f32::from_bits(shared.tables[(table + byte) as usize])
}

/// Input `lane` of the groups that are bits, or words handed on: 0 where there is none.
#[inline(always)]
pub fn marked(scratch: &Scratch, skill: &SkillShape, kind: u32, lane: u32) -> f32 {
    let word = scratch.record[BASE_WORDS];
    let running = word & 0xff;
    let applicable = (word >> 8) & 0xff;
    let room = (word >> 16) & 0xff;
    let mut value = 0.0;
    if kind == GROUP_LIT {
        value = if (scratch.record[6] & 0x00ff_ffff) != 0 { 1.0 } else { 0.0 };
    } else if kind == GROUP_RUNNING {
        value = if running == lane { 1.0 } else { 0.0 };
    } else if kind == GROUP_ROOM {
        value = if room == lane { 1.0 } else { 0.0 };
    } else if kind == GROUP_RANGE_MEANS {
        value = f32::from_bits(scratch.record[MEMORY_WORD + lane as usize]);
    } else if kind == GROUP_LIGHT_TRACE {
        value = f32::from_bits(scratch.record[MEMORY_WORD + 2]);
    } else if kind == GROUP_DOOR_TRACE {
        value = f32::from_bits(scratch.record[MEMORY_WORD + 3 + lane as usize]);
    } else {
        // Of the children that have a threshold, the one that as many stand before as this lane has.
        let mut before = 0;
        for child in 0..skill.children {
            let has = ((skill.thresholded >> child) & 1) == 1;
            if has && before == lane {
                let own = f32::from_bits(scratch.record[VALUE_WORD + child as usize]);
                let bit = if ((applicable >> child) & 1) == 1 { 1.0 } else { 0.0 };
                value = if kind == GROUP_VALUES { own } else { bit };
            }
            before += u32::from(has);
        }
    }
    value
}

/// A ring of `count` bits, or what a mirror would show of it: the first stays, the others change sides.
#[inline(always)]
fn shown(ring: u32, count: usize, mirrored: bool) -> u32 {
    let others = (ring.reverse_bits() >> (31 - count)) & !(1 << count);
    if mirrored { (ring & 1) | others } else { ring }
}

/// Turns the record, or what a mirror would show of it, into the inputs of a skill's nets.
#[inline(always)]
pub fn encode(shared: &CohortData, scratch: &mut Scratch, skill: &SkillShape, mirrored: bool) {
    scratch.set = 0;
    for group in 0..skill.groups as usize {
        let kind = skill.group_kind[group];
        let first = skill.group_first[group] as usize;
        let width = skill.group_width[group];
        let table = skill.group_table[group];
        if kind == GROUP_SONAR {
            for lane in 0..RAYS {
                let ray = if mirrored { (RAYS - lane) % RAYS } else { lane };
                scratch.inputs[first + lane] = coded(shared, scratch, table, ray);
            }
        } else if kind == GROUP_SONAR_COMPASS {
            // Bearing b of the compass lies between the readings that look just before and just after it.
            let turn = f32::from_bits(scratch.record[7]) * READINGS_PER_DEGREE;
            let whole = turn as u32;
            let part = turn - whole as f32;
            for lane in 0..RAYS {
                let after = (lane + 2 * RAYS - whole as usize) % RAYS;
                let before = (after + RAYS - 1) % RAYS;
                let near = coded(shared, scratch, table, after);
                scratch.inputs[first + lane] = near + part * (coded(shared, scratch, table, before) - near);
            }
        } else if kind == GROUP_LIGHT {
            let lit = shown(scratch.record[6] & 0x00ff_ffff, RAYS, mirrored);
            for lane in 0..RAYS {
                scratch.inputs[first + lane] = ((lit >> lane) & 1) as f32;
            }
            scratch.set |= u64::from(lit) << first;
        } else if kind == GROUP_BUMPERS {
            let touched = shown((scratch.record[6] >> 24) & 0xf, 4, mirrored);
            for lane in 0..4 {
                scratch.inputs[first + lane] = ((touched >> lane) & 1) as f32;
            }
            scratch.set |= u64::from(touched) << first;
        } else if kind == GROUP_COMPASS || kind == GROUP_COMPASS2 {
            let compass = f32::from_bits(scratch.record[7]);
            let (sine, cosine) = sin_cos(if kind == GROUP_COMPASS { compass } else { wrap_degrees(compass * 2.0) });
            scratch.inputs[first] = cosine;
            scratch.inputs[first + 1] = sine;
        } else {
            for lane in 0..width {
                scratch.inputs[first + lane as usize] = marked(scratch, skill, kind, lane);
            }
        }
    }
}
