//! What the robot remembers within a trial: enough to tell rooms apart that look alike, from its own sensors.
//!
//! All of it is our choice: the paper's high-level inputs are "abstract information derived from the low-level
//! sensory inputs".

use crate::env::motion::PASSED_DOOR;
use crate::env::sonar::READINGS_PER_DEGREE;
use crate::env::workgroup::Scratch;
use crate::layout::{Agent, HyperParams, MEMORY_WORD, RAYS};
use crate::math::functions::{flush, sin_cos};

/// Reading of the record that looks along the compass's direction `quarter` x 90 degrees, inches.
#[inline(always)]
pub fn looking(scratch: &Scratch, quarter: u32) -> f32 {
    let turned = (f32::from_bits(scratch.record[7]) * READINGS_PER_DEGREE + 0.5) as u32;
    let ray = ((6 * quarter + 2 * RAYS as u32 - turned) % RAYS as u32) as usize;
    ((scratch.record[ray / 4] >> (8 * (ray % 4))) & 0xff) as f32
}

/// Takes the record into the robot's memory.
#[inline(always)]
pub fn remember(agent: &mut Agent, scratch: &Scratch, params: &HyperParams) {
    let across = (looking(scratch, 0) + looking(scratch, 2)) * 0.007_874_016_f32 - 1.0;
    let along = (looking(scratch, 1) + looking(scratch, 3)) * 0.007_874_016_f32 - 1.0;
    // The first reading stands for the past that there is not.
    let past = if agent.step == 0 { 0.0 } else { params.range_decay };
    agent.east_west = flush(past * agent.east_west + (1.0 - past) * across);
    agent.north_south = flush(past * agent.north_south + (1.0 - past) * along);
    let lit = (scratch.record[6] & 0x00ff_ffff) != 0;
    agent.light = if lit { 1.0 } else { flush(agent.light * params.light_decay) };
    let passed = (agent.events & PASSED_DOOR) != 0;
    let (sine, cosine) = sin_cos(f32::from_bits(scratch.record[7]));
    agent.door = if passed { 1.0 } else { flush(agent.door * params.door_decay) };
    agent.door_cosine = if passed { cosine } else { flush(agent.door_cosine * params.door_decay) };
    agent.door_sine = if passed { sine } else { flush(agent.door_sine * params.door_decay) };
}

/// Writes the memories into the record.
#[inline(always)]
pub fn recall(agent: &Agent, scratch: &mut Scratch) {
    scratch.record[MEMORY_WORD] = agent.east_west.to_bits();
    scratch.record[MEMORY_WORD + 1] = agent.north_south.to_bits();
    scratch.record[MEMORY_WORD + 2] = agent.light.to_bits();
    scratch.record[MEMORY_WORD + 3] = agent.door.to_bits();
    scratch.record[MEMORY_WORD + 4] = agent.door_cosine.to_bits();
    scratch.record[MEMORY_WORD + 5] = agent.door_sine.to_bits();
}
