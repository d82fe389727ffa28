//! Initial weights. Made once on the host for both backends, so it has no twin in WGSL.

use crate::layout::{HyperParams, LANES, SkillShape};
use crate::math::rng::{Purpose, Stream, draw, unit};
use crate::qnet::optimiser::adam::BETA2_POWER;

/// Fills one skill's nets: weights of the units in use uniform in plus or minus `init`, everything else 0,
/// the clocks 1. `skill_number` keeps the skills' random numbers apart.
pub fn init(nets: &mut [f32], skill: &SkillShape, skill_number: u32, params: &HyperParams) {
    for child in 0..skill.nets {
        let net = skill.net_offset(child);
        for row in 0..skill.rows {
            for lane in 0..LANES as u32 {
                let output_biases = row == skill.inputs + 1 + skill.outputs;
                if lane >= params.hidden || (output_biases && lane >= skill.outputs) {
                    continue;
                }
                let stream = Stream {
                    key: [params.run_seed, params.learner_seed],
                    skill: skill_number,
                    trial: child,
                    step: row,
                    purpose: Purpose::Init as u32,
                };
                let word = draw(stream, lane)[0];
                nets[net + (row as usize) * LANES + lane as usize] = (unit(word) * 2.0 - 1.0) * params.init_range;
            }
        }
        let clock = (skill.clock_offset + child) as usize;
        nets[clock] = 1.0;
        nets[clock + BETA2_POWER] = 1.0;
    }
}
