//! Q-values of every child.

use crate::learner::layout::{LANES, MAX_CHILDREN, MAX_INPUTS, SkillPlan};
use crate::learner::memory::Scratch;
use crate::math::functions::squash;
use crate::math::lanes::{Lanes, lanes_sums};

/// Word at which net number `net` stands; its three slabs follow one another.
#[inline(always)]
pub fn net_of(skill: &SkillPlan, base: u32, net: u32) -> u32 {
    base + skill.nets_offset + net * 3 * skill.rows * LANES as u32
}

/// Weighted sums of the inputs of `N` nets that follow one another from net `first`, before the hidden units' sigmoid.
/// Each sum has the order of the rows; the nets side by side keep the adders busy.
#[inline(always)]
fn weighted<const N: usize>(
    nets: &[f32],
    inputs: &[f32; MAX_INPUTS],
    skill: &SkillPlan,
    base: u32,
    first: usize,
) -> [Lanes; N] {
    let count = skill.inputs as usize;
    let weights: [&[Lanes]; N] = std::array::from_fn(|n| {
        let net = net_of(skill, base, (first + n) as u32) as usize;
        &nets[net..net + skill.rows as usize * LANES].as_chunks::<LANES>().0[..=count]
    });
    let mut sums: [Lanes; N] = std::array::from_fn(|n| weights[n][count]);
    for row in 0..count.min(MAX_INPUTS) {
        let x = inputs[row];
        for n in 0..N {
            for lane in 0..LANES {
                sums[n][lane] += weights[n][row][lane] * x;
            }
        }
    }
    sums
}

/// Computes `hidden` and `q` of every child from `inputs`.
#[inline(always)]
pub fn forward(nets: &[f32], scratch: &mut Scratch, skill: &SkillPlan, base: u32) {
    let inputs = skill.inputs as usize;
    let outputs = skill.outputs as usize;
    let count = skill.nets as usize;
    let mut number = 0;
    while number + 1 < count {
        let sums = weighted::<2>(nets, &scratch.inputs, skill, base, number);
        scratch.hidden[number..number + 2].copy_from_slice(&sums);
        number += 2;
    }
    if number < count {
        let [sum] = weighted::<1>(nets, &scratch.inputs, skill, base, number);
        scratch.hidden[number] = sum;
    }
    let mut partials = [[0.0; LANES]; MAX_CHILDREN];
    for number in 0..count {
        let net = net_of(skill, base, number as u32) as usize;
        let weights = &nets[net..net + skill.rows as usize * LANES].as_chunks::<LANES>().0[..inputs + 2 + outputs];
        for lane in 0..LANES {
            scratch.hidden[number][lane] = squash(scratch.hidden[number][lane]);
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
        let row = inputs + 1 + outputs;
        let bias = nets[net_of(skill, base, net as u32) as usize + row * LANES + (child - net)];
        scratch.q[child] = squash(partials[child][0] + bias);
    }
}
