//! One step of error back-propagation through one child's net (paper, section I, step 2).

use super::forward::net_of;
use crate::learner::layout::{LANES, Settings, SkillPlan};
use crate::learner::memory::Scratch;
use crate::math::functions::{flush, reciprocal, reciprocal_sqrt, square_root};
use crate::math::lanes::Lanes;

/// Lane of the clock row at which the second moments' decay stands; the first moments' stand from lane 0.
pub const CLOCK_SECOND: u32 = 16;

/// Back-propagated error of every lane: of the output, times what it meets.
#[derive(Debug, Clone, Copy)]
pub struct Errors {
    /// Of the output's sum.
    pub output: f32,
    /// Of each hidden unit's sum.
    pub hidden: Lanes,
}

/// Errors of a net whose output should rise by `delta`.
#[inline(always)]
pub fn errors(
    nets: &[f32],
    scratch: &Scratch,
    plan: &SkillPlan,
    net: u32,
    number: u32,
    child: u32,
    delta: f32,
) -> Errors {
    let value = scratch.q[child as usize];
    let output = delta * (1.0 - value * value);
    let mut hidden = [0.0; LANES];
    for lane in 0..LANES {
        let activation = scratch.hidden[number as usize][lane];
        let weight = nets[(net + (plan.inputs + 1 + child - number) * LANES as u32) as usize + lane];
        hidden[lane] = output * weight * (1.0 - activation * activation);
    }
    Errors { output, hidden }
}

/// Ascent direction of one row of weights of net `number`, for its output `output`.
#[inline(always)]
pub fn gradient(scratch: &Scratch, plan: &SkillPlan, number: u32, output: u32, row: u32, errors: &Errors) -> Lanes {
    let count = plan.inputs;
    let last = count + 1 + plan.outputs;
    let mut slope = errors.hidden;
    if row < count {
        let x = scratch.inputs[row as usize];
        for lane in 0..LANES {
            slope[lane] = errors.hidden[lane] * x;
        }
    }
    if row > count && row < last {
        let own = row == count + 1 + output;
        for lane in 0..LANES {
            slope[lane] = if own { errors.output * scratch.hidden[number as usize][lane] } else { 0.0 };
        }
    }
    if row == last {
        for lane in 0..LANES {
            slope[lane] = if lane == output as usize { errors.output } else { 0.0 };
        }
    }
    slope
}

/// Learning rate of a trial: it falls linearly over the first trials.
#[inline(always)]
pub fn learning_rate(settings: &Settings, trial: u32) -> f32 {
    let risen = if trial < settings.rate_trials { trial } else { settings.rate_trials };
    settings.rate * (1.0 - settings.rate_fall * risen as f32)
}

/// Moves the net of `child` so that its output changes by about `delta` times the learning rate `pace`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn backward(
    nets: &mut [f32],
    scratch: &Scratch,
    skill: &SkillPlan,
    settings: &Settings,
    base: u32,
    child: u32,
    delta: f32,
    pace: f32,
) {
    let number = if skill.nets == 1 { 0 } else { child };
    let output = child - number;
    let net = net_of(skill, base, number);
    let rows = skill.rows;
    let slab = rows * LANES as u32;
    let beta1 = settings.beta1;
    let beta2 = settings.beta2;
    let epsilon2 = settings.epsilon2;
    let found = errors(nets, scratch, skill, net, number, child, delta);
    if settings.optimiser == 1 {
        // Adam (Kingma and Ba, 2015) in its second form, with epsilon under the root: one reciprocal root
        // serves where a root and a division would.
        let clock = (base + skill.clock_offset + number) as usize;
        let first = flush(nets[clock] * beta1);
        let second = flush(nets[clock + CLOCK_SECOND as usize] * beta2);
        let rate = pace * square_root(1.0 - second) * reciprocal(1.0 - first);
        nets[clock] = first;
        nets[clock + CLOCK_SECOND as usize] = second;
        let rest1 = 1.0 - beta1;
        let rest2 = 1.0 - beta2;
        let (weights, moments) = nets[net as usize..(net + 3 * slab) as usize].split_at_mut(slab as usize);
        let (means, squares) = moments.split_at_mut(slab as usize);
        let weights = weights.as_chunks_mut::<LANES>().0;
        let means = means.as_chunks_mut::<LANES>().0;
        let squares = squares.as_chunks_mut::<LANES>().0;
        for row in 0..rows as usize {
            let slope = gradient(scratch, skill, number, output, row as u32, &found);
            for lane in 0..LANES {
                let g = slope[lane];
                let mean = flush(beta1 * means[row][lane] + rest1 * g);
                let square = flush(beta2 * squares[row][lane] + rest2 * (g * g));
                means[row][lane] = mean;
                squares[row][lane] = square;
                weights[row][lane] += rate * mean * reciprocal_sqrt(square + epsilon2);
            }
        }
    } else {
        let (weights, velocities) = nets[net as usize..(net + 2 * slab) as usize].split_at_mut(slab as usize);
        let weights = weights.as_chunks_mut::<LANES>().0;
        let velocities = velocities.as_chunks_mut::<LANES>().0;
        for row in 0..rows as usize {
            let slope = gradient(scratch, skill, number, output, row as u32, &found);
            for lane in 0..LANES {
                let g = slope[lane];
                let velocity = flush(beta1 * velocities[row][lane] + pace * g);
                velocities[row][lane] = velocity;
                weights[row][lane] += velocity;
            }
        }
    }
}
