//! Q-values of every child.

use crate::learner::layout::{LANES, MAX_CHILDREN, SkillPlan};
use crate::learner::memory::Scratch;
use crate::math::functions::squash;
use crate::math::lanes::lanes_sums;

/// Word at which net number `net` stands; its three slabs follow one another.
#[inline(always)]
pub fn net_of(skill: &SkillPlan, base: u32, net: u32) -> u32 {
    base + skill.nets_offset + net * 3 * skill.rows * LANES as u32
}

/// Computes `hidden` and `q` of every child from `inputs`.
#[inline(always)]
pub fn forward(nets: &[f32], scratch: &mut Scratch, skill: &SkillPlan, base: u32) {
    let inputs = skill.inputs as usize;
    let mut partials = [[0.0; LANES]; MAX_CHILDREN];
    for number in 0..skill.nets as usize {
        let net = net_of(skill, base, number as u32) as usize;
        let outputs = skill.outputs as usize;
        let weights = &nets[net..net + skill.rows as usize * LANES].as_chunks::<LANES>().0[..inputs + 2 + outputs];
        let mut sum = weights[inputs];
        for (row, x) in weights[..inputs].iter().zip(&scratch.inputs) {
            for lane in 0..LANES {
                sum[lane] += row[lane] * *x;
            }
        }
        for lane in 0..LANES {
            scratch.hidden[number][lane] = squash(sum[lane]);
        }
        for output in 0..outputs {
            for lane in 0..LANES {
                partials[number + output][lane] = scratch.hidden[number][lane] * weights[inputs + 1 + output][lane];
            }
        }
    }
    lanes_sums(&mut partials, skill.children);
    for child in 0..skill.children as usize {
        let net = if skill.nets == 1 { 0 } else { child };
        let row = inputs + 1 + skill.outputs as usize;
        let bias = nets[net_of(skill, base, net as u32) as usize + row * LANES + (child - net)];
        scratch.q[child] = squash(partials[child][0] + bias);
    }
}
