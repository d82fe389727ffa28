//! Q-values of every child, several nets side by side.

use crate::env::workgroup::Workgroup;
use crate::layout::{LANES, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, SkillShape};
use crate::math::functions::tanh;
use crate::math::reduce::{Lanes, Partials, lanes_sums};
use crate::qnet::forward::{HALF_LANES, lanes_used};

/// Which of a skill's inputs are bits: those of light and bumpers.
#[inline(always)]
pub fn bits_of(skill: &SkillShape) -> u64 {
    (u64::from(skill.bits_high) << 32) | u64::from(skill.bits_low)
}

/// The rows of net number `net`, and what lies behind them.
#[inline(always)]
fn rows_of<'a>(nets: &'a [f32], skill: &SkillShape, net: u32) -> &'a [Lanes; MAX_ROWS] {
    let rows = nets[skill.net_offset(net)..].as_chunks::<LANES>().0;
    rows.first_chunk().expect("room for the most rows")
}

/// The units' sums with one more input. By value, which keeps them in the machine's lanes.
#[inline(always)]
fn added<const UNITS: usize>(sums: [f32; UNITS], weights: &Lanes, x: f32) -> [f32; UNITS] {
    let mut own = sums;
    for lane in 0..UNITS {
        own[lane] = sums[lane] + weights[lane] * x;
    }
    own
}

/// Which inputs add something: all but the bits that are not set. Of those of light few are.
#[inline(always)]
fn inputs_used(inputs: &[f32; MAX_INPUTS], skill: &SkillShape) -> u64 {
    let bits = bits_of(skill);
    let mut set = [0_u64; MAX_INPUTS];
    for input in 0..MAX_INPUTS {
        set[input] = if inputs[input] != 0.0 { 1 << input } else { 0 };
    }
    let set = set.iter().fold(0, |all, bit| all | bit);
    (u64::MAX >> (MAX_INPUTS - skill.inputs as usize)) & (set | !bits)
}

/// Computes `hidden` of every net, of which `UNITS` lanes are in use, and what its outputs are summed from.
///
/// `ABREAST` nets are summed side by side, so that one need not wait for the other's sum.
#[inline(always)]
fn hidden_layer<const UNITS: usize, const ABREAST: usize>(
    nets: &[f32],
    x: &[f32; MAX_INPUTS],
    skill: &SkillShape,
    hidden: &mut [Lanes; MAX_CHILDREN],
    partials: &mut Partials,
) {
    let inputs = skill.inputs as usize;
    let used = inputs_used(x, skill);
    for first in (0..skill.nets).step_by(ABREAST) {
        // The last one stands in for who is missing beside it.
        let mut numbers = [first; ABREAST];
        let mut weights = [rows_of(nets, skill, first); ABREAST];
        for beside in 1..ABREAST {
            numbers[beside] = (first + beside as u32).min(skill.nets - 1);
            weights[beside] = rows_of(nets, skill, numbers[beside]);
        }
        let mut sums = [[0.0; UNITS]; ABREAST];
        for beside in 0..ABREAST {
            sums[beside].copy_from_slice(&weights[beside][inputs][..UNITS]);
        }
        let mut left = used;
        while left != 0 {
            let row = left.trailing_zeros() as usize;
            left &= left - 1;
            let x = x[row];
            for beside in 0..ABREAST {
                sums[beside] = added(sums[beside], &weights[beside][row], x);
            }
        }
        for beside in 0..ABREAST {
            let number = numbers[beside] as usize;
            let mut activations = [0.0; LANES];
            for lane in 0..UNITS {
                activations[lane] = tanh(sums[beside][lane]);
            }
            for output in 0..skill.outputs as usize {
                let mut parts = [0.0; UNITS];
                for lane in 0..UNITS {
                    parts[lane] = activations[lane] * weights[beside][inputs + 1 + output][lane];
                }
                partials[number + output][..UNITS].copy_from_slice(&parts);
            }
            hidden[number] = activations;
        }
    }
}

/// Computes `hidden` and `q` of every child of skill `n` from `inputs`.
#[inline(always)]
pub fn forward(group: &mut Workgroup<'_>, n: u32) {
    let (skill, params) = (&group.skills[n as usize], &group.params[n as usize]);
    let nets: &[f32] = &group.nets;
    let lanes = lanes_used(params.hidden);
    if lanes == HALF_LANES {
        hidden_layer::<HALF_LANES, 6>(nets, &group.inputs, skill, &mut group.hidden, &mut group.partials);
    } else {
        hidden_layer::<LANES, 1>(nets, &group.inputs, skill, &mut group.hidden, &mut group.partials);
    }
    lanes_sums(&mut group.partials, skill.children, lanes);
    let mut sums = [0.0; MAX_CHILDREN];
    for child in 0..skill.children as usize {
        let net = if skill.nets == 1 { 0 } else { child };
        let row = skill.inputs as usize + 1 + skill.outputs as usize;
        sums[child] = group.partials[child][0] + nets[skill.net_offset(net as u32) + row * LANES + (child - net)];
    }
    for child in 0..MAX_CHILDREN {
        group.q[child] = tanh(sums[child]);
    }
}
