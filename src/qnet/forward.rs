//! Q-values of every child.

use crate::env::workgroup::Scratch;
use crate::layout::{HyperParams, LANES, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, SkillShape};
use crate::math::functions::tanh;
use crate::math::reduce::{Lanes, lanes_sums};

/// Lanes that do for a net of few hidden units: half of them.
pub const FEW: usize = 16;

/// Lanes in which a net has hidden units. In the others all is 0, and stays so.
#[inline(always)]
pub fn lanes_of(hidden: u32) -> usize {
    if hidden as usize <= FEW { FEW } else { LANES }
}

/// Which of a skill's inputs are bits: those of light and bumpers.
#[inline(always)]
pub fn bits_of(skill: &SkillShape) -> u64 {
    (u64::from(skill.bits_high) << 32) | u64::from(skill.bits_low)
}

/// Word at which net number `net` stands; its three slabs follow one another.
///
/// Between two nets half a row stays free. That is a line of the CPU's cache: nets of few units, which use the first half
/// of each row, would otherwise share every other line and leave the rest idle.
#[inline(always)]
pub fn net_of(skill: &SkillShape, base: u32, net: u32) -> u32 {
    base + skill.nets_offset + net * (3 * skill.rows * LANES as u32 + FEW as u32)
}

/// The rows of net number `net`, and what lies behind them.
#[inline(always)]
fn rows_of<'a>(nets: &'a [f32], skill: &SkillShape, base: u32, net: u32) -> &'a [Lanes; MAX_ROWS] {
    let rows = nets[net_of(skill, base, net) as usize..].as_chunks::<LANES>().0;
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

/// Computes `hidden` of every net, of which `UNITS` lanes are in use, and what its outputs are summed from.
///
/// `ABREAST` nets are summed side by side, so that one need not wait for the other's sum. Bits that are not set are
/// passed over: of those of light few are.
#[inline(always)]
fn layer<const UNITS: usize, const ABREAST: usize>(nets: &[f32], scratch: &mut Scratch, skill: &SkillShape, base: u32) {
    let inputs = skill.inputs as usize;
    let outputs = skill.outputs as usize;
    let used = ((u64::MAX >> (MAX_INPUTS - inputs)) & !bits_of(skill)) | scratch.set;
    for first in (0..skill.nets).step_by(ABREAST) {
        // The last one stands in for who is missing beside it.
        let mut numbers = [first; ABREAST];
        let mut weights = [rows_of(nets, skill, base, first); ABREAST];
        for beside in 1..ABREAST {
            numbers[beside] = (first + beside as u32).min(skill.nets - 1);
            weights[beside] = rows_of(nets, skill, base, numbers[beside]);
        }
        let mut sums = [[0.0; UNITS]; ABREAST];
        for beside in 0..ABREAST {
            sums[beside].copy_from_slice(&weights[beside][inputs][..UNITS]);
        }
        let mut left = used;
        while left != 0 {
            let row = left.trailing_zeros() as usize;
            left &= left - 1;
            let x = scratch.inputs[row];
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
            for output in 0..outputs {
                let mut parts = [0.0; UNITS];
                for lane in 0..UNITS {
                    parts[lane] = activations[lane] * weights[beside][inputs + 1 + output][lane];
                }
                scratch.partials[number + output][..UNITS].copy_from_slice(&parts);
            }
            scratch.hidden[number] = activations;
        }
    }
}

/// Computes `hidden` and `q` of every child from `inputs`.
#[inline(always)]
pub fn forward(nets: &[f32], scratch: &mut Scratch, skill: &SkillShape, params: &HyperParams, base: u32) {
    let lanes = lanes_of(params.hidden);
    if lanes == FEW {
        layer::<FEW, 6>(nets, scratch, skill, base);
    } else {
        layer::<LANES, 1>(nets, scratch, skill, base);
    }
    lanes_sums(&mut scratch.partials, skill.children, lanes);
    let mut sums = [0.0; MAX_CHILDREN];
    for child in 0..skill.children as usize {
        let net = if skill.nets == 1 { 0 } else { child };
        let row = skill.inputs as usize + 1 + skill.outputs as usize;
        let bias = nets[net_of(skill, base, net as u32) as usize + row * LANES + (child - net)];
        sums[child] = scratch.partials[child][0] + bias;
    }
    for child in 0..MAX_CHILDREN {
        scratch.q[child] = tanh(sums[child]);
    }
}
