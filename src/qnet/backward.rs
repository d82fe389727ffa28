//! One step of error back-propagation through one child's net (paper, section I, step 2).

use super::forward::{FEW, lanes_of, net_of};
use crate::env::workgroup::Scratch;
pub use crate::layout::choices::{OPTIMISER_ADAM, OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::layout::{HyperParams, LANES, MAX_INPUTS, MAX_ROWS, SkillShape};
use crate::math::functions::{flush, reciprocal, reciprocal_sqrt, square_root};
use crate::math::reduce::{Lanes, lanes_sum};

/// Rows whose paces are found together: a divisor of `MAX_ROWS`.
pub const ROW_BLOCK: usize = 16;

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
    plan: &SkillShape,
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
pub fn gradient(scratch: &Scratch, plan: &SkillShape, number: u32, output: u32, row: u32, errors: &Errors) -> Lanes {
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

/// Finds, for each row of weights of the net at word `net`, the factor that its gradient has in common and the pace at
/// which it moves along its mean gradient; lanes are rows.
///
/// Adam-mini (Zhang and others, 2024) keeps one second moment for a block of weights. Ours takes a row, the weights of
/// one input, as the block: its gradient is the factor times the errors of the hidden units, so that the mean of its
/// square needs no pass over the weights.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn paces<const UNITS: usize>(
    nets: &mut [f32],
    scratch: &mut Scratch,
    plan: &SkillShape,
    params: &HyperParams,
    net: u32,
    (number, output): (u32, u32),
    errors: &Errors,
    rate: f32,
) {
    let (mut below, mut above) = ([0.0; UNITS], [0.0; UNITS]);
    for lane in 0..UNITS {
        let activation = scratch.hidden[number as usize][lane];
        below[lane] = errors.hidden[lane] * errors.hidden[lane];
        above[lane] = activation * activation;
    }
    let hidden = lanes_sum(&below) * params.unit_share;
    let activation = lanes_sum(&above) * params.unit_share;
    let count = plan.inputs as usize;
    let last = count + 1 + plan.outputs as usize;
    let rest2 = 1.0 - params.beta2;
    let mut inputs = [0.0; MAX_ROWS];
    inputs[..MAX_INPUTS].copy_from_slice(&scratch.inputs);
    let squares = &mut nets[(net + 2 * plan.rows * LANES as u32) as usize..][..MAX_ROWS];
    // Blocks of rows, as many as there are.
    for block in (0..=last).step_by(ROW_BLOCK) {
        let mut factors = [0.0; ROW_BLOCK];
        let mut moved = units::<ROW_BLOCK>(&squares[block..]);
        let mut paces = [0.0; ROW_BLOCK];
        let x = units::<ROW_BLOCK>(&inputs[block..]);
        for lane in 0..ROW_BLOCK {
            let row = block + lane;
            let x = if row < count { x[lane] } else { 1.0 };
            let own = row == count + 1 + output as usize || row == last;
            let out = if own { errors.output } else { 0.0 };
            let factor = if row <= count { x } else { out };
            let above = if row < last { activation } else { 1.0 };
            let alike = if row <= count { hidden } else { above };
            moved[lane] = flush(params.beta2 * moved[lane] + rest2 * (factor * factor * alike));
            factors[lane] = factor;
            paces[lane] = rate * reciprocal_sqrt(moved[lane] + params.epsilon2);
        }
        squares[block..block + ROW_BLOCK].copy_from_slice(&moved);
        scratch.row_factor[block..block + ROW_BLOCK].copy_from_slice(&factors);
        scratch.row_pace[block..block + ROW_BLOCK].copy_from_slice(&paces);
    }
}

/// Learning rate of a trial: it falls linearly over the first trials.
#[inline(always)]
pub fn learning_rate(params: &HyperParams, trial: u32) -> f32 {
    let risen = if trial < params.learning_rate_trials { trial } else { params.learning_rate_trials };
    params.learning_rate * (1.0 - params.learning_rate_fall * risen as f32)
}

/// The first numbers of a row, as a value: they are loaded, computed and stored together.
#[inline(always)]
fn units<const UNITS: usize>(row: &[f32]) -> [f32; UNITS] {
    let mut own = [0.0; UNITS];
    own.copy_from_slice(&row[..UNITS]);
    own
}

/// Moves a row of weights at its pace along its mean gradient, which decays and takes in a factor times what the row's
/// gradient is alike to.
#[inline(always)]
fn turn<const UNITS: usize>(
    means: &mut Lanes,
    weights: &mut Lanes,
    (decay, factor, pace): (f32, f32, f32),
    alike: &[f32; UNITS],
) {
    let (mut mean, mut weight) = (units::<UNITS>(means), units::<UNITS>(weights));
    for lane in 0..UNITS {
        mean[lane] = flush(decay * mean[lane] + factor * alike[lane]);
        weight[lane] += pace * mean[lane];
    }
    means[..UNITS].copy_from_slice(&mean);
    weights[..UNITS].copy_from_slice(&weight);
}

/// Moves net `number`, of which `UNITS` lanes are in use, so that its output `output` changes by about the errors' delta
/// times the learning rate `pace`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
fn learn<const UNITS: usize>(
    nets: &mut [f32],
    scratch: &mut Scratch,
    skill: &SkillShape,
    params: &HyperParams,
    base: u32,
    (number, output): (u32, u32),
    found: &Errors,
    pace: f32,
) {
    let net = net_of(skill, base, number);
    let rows = skill.rows;
    let slab = rows * LANES as u32;
    let beta1 = params.beta1;
    let beta2 = params.beta2;
    let epsilon2 = params.epsilon2;
    if params.optimiser == OPTIMISER_SGD {
        let (weights, velocities) = nets[net as usize..(net + 2 * slab) as usize].split_at_mut(slab as usize);
        let weights = weights.as_chunks_mut::<LANES>().0;
        let velocities = velocities.as_chunks_mut::<LANES>().0;
        for row in 0..rows as usize {
            let slope = gradient(scratch, skill, number, output, row as u32, found);
            let (mut velocity, mut weight) = (units::<UNITS>(&velocities[row]), units::<UNITS>(&weights[row]));
            for lane in 0..UNITS {
                velocity[lane] = flush(beta1 * velocity[lane] + pace * slope[lane]);
                weight[lane] += velocity[lane];
            }
            velocities[row][..UNITS].copy_from_slice(&velocity);
            weights[row][..UNITS].copy_from_slice(&weight);
        }
    } else {
        // Adam (Kingma and Ba, 2015) in its second form, with epsilon under the root: one reciprocal root serves where a
        // root and a division would.
        let clock = (base + skill.clock_offset + number) as usize;
        let first = flush(nets[clock] * beta1);
        let second = flush(nets[clock + CLOCK_SECOND as usize] * beta2);
        let rate = pace * square_root(1.0 - second) * reciprocal(1.0 - first);
        nets[clock] = first;
        nets[clock + CLOCK_SECOND as usize] = second;
        let rest1 = 1.0 - beta1;
        if params.optimiser == OPTIMISER_ADAM_ROWS {
            paces::<UNITS>(nets, scratch, skill, params, net, (number, output), found, rate);
            let count = skill.inputs as usize;
            let (weights, means) = nets[net as usize..(net + 2 * slab) as usize].split_at_mut(slab as usize);
            let weights = weights.as_chunks_mut::<LANES>().0;
            let means = means.as_chunks_mut::<LANES>().0;
            let mut chosen = [0.0; LANES];
            chosen[output as usize] = 1.0;
            let below = units::<UNITS>(&found.hidden);
            let above = units::<UNITS>(&scratch.hidden[number as usize]);
            let chosen = units::<UNITS>(&chosen);
            for row in 0..count + 1 {
                let moves = (beta1, rest1 * scratch.row_factor[row], scratch.row_pace[row]);
                turn(&mut means[row], &mut weights[row], moves, &below);
            }
            for row in count + 1..rows as usize {
                let moves = (beta1, rest1 * scratch.row_factor[row], scratch.row_pace[row]);
                let alike = if row + 1 < rows as usize { &above } else { &chosen };
                turn(&mut means[row], &mut weights[row], moves, alike);
            }
        } else {
            let rest2 = 1.0 - beta2;
            let (weights, moments) = nets[net as usize..(net + 3 * slab) as usize].split_at_mut(slab as usize);
            let (means, squares) = moments.split_at_mut(slab as usize);
            let weights = weights.as_chunks_mut::<LANES>().0;
            let means = means.as_chunks_mut::<LANES>().0;
            let squares = squares.as_chunks_mut::<LANES>().0;
            for row in 0..rows as usize {
                let slope = gradient(scratch, skill, number, output, row as u32, found);
                let (mut mean, mut square) = (units::<UNITS>(&means[row]), units::<UNITS>(&squares[row]));
                let mut weight = units::<UNITS>(&weights[row]);
                for lane in 0..UNITS {
                    let g = slope[lane];
                    mean[lane] = flush(beta1 * mean[lane] + rest1 * g);
                    square[lane] = flush(beta2 * square[lane] + rest2 * (g * g));
                    weight[lane] += rate * mean[lane] * reciprocal_sqrt(square[lane] + epsilon2);
                }
                means[row][..UNITS].copy_from_slice(&mean);
                squares[row][..UNITS].copy_from_slice(&square);
                weights[row][..UNITS].copy_from_slice(&weight);
            }
        }
    }
}

/// Moves the net of `child` so that its output changes by about `delta` times the learning rate `pace`.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "the twin of a shader function, which has no methods")]
pub fn backward(
    nets: &mut [f32],
    scratch: &mut Scratch,
    skill: &SkillShape,
    params: &HyperParams,
    base: u32,
    child: u32,
    delta: f32,
    pace: f32,
) {
    let number = if skill.nets == 1 { 0 } else { child };
    let net = net_of(skill, base, number);
    let found = errors(nets, scratch, skill, net, number, child, delta);
    let own = (number, child - number);
    if lanes_of(params.hidden) == FEW {
        learn::<FEW>(nets, scratch, skill, params, base, own, &found, pace);
    } else {
        learn::<LANES>(nets, scratch, skill, params, base, own, &found, pace);
    }
}
