//! The optimisers, a row of weights at a time.

use super::reduce::lanes_sum;
use crate::env::workgroup::Workgroup;
use crate::layout::choices::{OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::layout::{HyperParams, LANES, MAX_CHILDREN, MAX_INPUTS, MAX_ROWS, SkillShape};
use crate::math::functions::{flush, reciprocal, reciprocal_sqrt, square_root};
use crate::math::reduce::Lanes;
use crate::qnet::forward::{HALF_LANES, lanes_used};
use crate::qnet::gradient::NetErrors;
use crate::qnet::optimiser::adam::BETA2_POWER;

/// Rows whose step sizes are found together: a divisor of `MAX_ROWS`.
const ROW_BLOCK: usize = 16;

/// The parts of a workgroup's memory that an update touches, apart from the nets.
struct Scratch<'a> {
    hidden: &'a [Lanes; MAX_CHILDREN],
    inputs: &'a [f32; MAX_INPUTS],
    q: &'a [f32; MAX_CHILDREN],
    row_factor: &'a mut [f32; MAX_ROWS],
    row_step_size: &'a mut [f32; MAX_ROWS],
}

/// Errors of a net whose output should rise by `delta`.
#[inline(always)]
fn net_errors(
    nets: &[f32],
    scratch: &Scratch<'_>,
    plan: &SkillShape,
    number: u32,
    child: u32,
    delta: f32,
) -> NetErrors {
    let net = plan.net_offset(number);
    let value = scratch.q[child as usize];
    let output = delta * (1.0 - value * value);
    let mut hidden = [0.0; LANES];
    for lane in 0..LANES {
        let activation = scratch.hidden[number as usize][lane];
        let weight = nets[net + (plan.inputs + 1 + child - number) as usize * LANES + lane];
        hidden[lane] = output * weight * (1.0 - activation * activation);
    }
    NetErrors { output, hidden }
}

/// Ascent direction of one row of weights of net `number`, for its output `output`.
#[inline(always)]
fn gradient(scratch: &Scratch<'_>, plan: &SkillShape, number: u32, output: u32, row: u32, errors: &NetErrors) -> Lanes {
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

/// Finds, for each row of weights, the factor that its gradient has in common and how far it moves along its mean
/// gradient; lanes are rows.
#[inline(always)]
fn row_step_sizes<const UNITS: usize>(
    nets: &mut [f32],
    scratch: &mut Scratch<'_>,
    plan: &SkillShape,
    params: &HyperParams,
    (number, output): (u32, u32),
    errors: &NetErrors,
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
    inputs[..MAX_INPUTS].copy_from_slice(scratch.inputs);
    let squares = &mut nets[plan.net_offset(number) + 2 * plan.rows as usize * LANES..][..MAX_ROWS];
    // Blocks of rows, as many as there are.
    for block in (0..=last).step_by(ROW_BLOCK) {
        let mut factors = [0.0; ROW_BLOCK];
        let mut moved = units::<ROW_BLOCK>(&squares[block..]);
        let mut step_sizes = [0.0; ROW_BLOCK];
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
            step_sizes[lane] = rate * reciprocal_sqrt(moved[lane] + params.epsilon2);
        }
        squares[block..block + ROW_BLOCK].copy_from_slice(&moved);
        scratch.row_factor[block..block + ROW_BLOCK].copy_from_slice(&factors);
        scratch.row_step_size[block..block + ROW_BLOCK].copy_from_slice(&step_sizes);
    }
}

/// The first numbers of a row, as a value: they are loaded, computed and stored together.
#[inline(always)]
fn units<const UNITS: usize>(row: &[f32]) -> [f32; UNITS] {
    let mut own = [0.0; UNITS];
    own.copy_from_slice(&row[..UNITS]);
    own
}

/// Moves a row of weights by its step size along its mean gradient, which decays and takes in a factor times what the row's
/// gradient is alike to.
#[inline(always)]
fn momentum_step<const UNITS: usize>(
    means: &mut Lanes,
    weights: &mut Lanes,
    (decay, factor, step_size): (f32, f32, f32),
    alike: &[f32; UNITS],
) {
    let (mut mean, mut weight) = (units::<UNITS>(means), units::<UNITS>(weights));
    for lane in 0..UNITS {
        mean[lane] = flush(decay * mean[lane] + factor * alike[lane]);
        weight[lane] += step_size * mean[lane];
    }
    means[..UNITS].copy_from_slice(&mean);
    weights[..UNITS].copy_from_slice(&weight);
}

/// Moves net `number`, of which `UNITS` lanes are in use, so that its output `output` changes by about the errors' delta
/// times the learning rate `step_size`.
#[inline(always)]
fn apply<const UNITS: usize>(
    nets: &mut [f32],
    scratch: &mut Scratch<'_>,
    skill: &SkillShape,
    params: &HyperParams,
    (number, output): (u32, u32),
    found: &NetErrors,
    step_size: f32,
) {
    let net = skill.net_offset(number);
    let rows = skill.rows;
    let tensor = rows as usize * LANES;
    let beta1 = params.beta1;
    let beta2 = params.beta2;
    let epsilon2 = params.epsilon2;
    if params.optimiser == OPTIMISER_SGD {
        let (weights, velocities) = nets[net..net + 2 * tensor].split_at_mut(tensor);
        let weights = weights.as_chunks_mut::<LANES>().0;
        let velocities = velocities.as_chunks_mut::<LANES>().0;
        for row in 0..rows as usize {
            let slope = gradient(scratch, skill, number, output, row as u32, found);
            let (mut velocity, mut weight) = (units::<UNITS>(&velocities[row]), units::<UNITS>(&weights[row]));
            for lane in 0..UNITS {
                velocity[lane] = flush(beta1 * velocity[lane] + step_size * slope[lane]);
                weight[lane] += velocity[lane];
            }
            velocities[row][..UNITS].copy_from_slice(&velocity);
            weights[row][..UNITS].copy_from_slice(&weight);
        }
    } else {
        let clock = (skill.clock_offset + number) as usize;
        let first = flush(nets[clock] * beta1);
        let second = flush(nets[clock + BETA2_POWER] * beta2);
        let rate = step_size * square_root(1.0 - second) * reciprocal(1.0 - first);
        nets[clock] = first;
        nets[clock + BETA2_POWER] = second;
        let rest1 = 1.0 - beta1;
        if params.optimiser == OPTIMISER_ADAM_ROWS {
            row_step_sizes::<UNITS>(nets, scratch, skill, params, (number, output), found, rate);
            let count = skill.inputs as usize;
            let (weights, means) = nets[net..net + 2 * tensor].split_at_mut(tensor);
            let weights = weights.as_chunks_mut::<LANES>().0;
            let means = means.as_chunks_mut::<LANES>().0;
            let mut chosen = [0.0; LANES];
            chosen[output as usize] = 1.0;
            let below = units::<UNITS>(&found.hidden);
            let above = units::<UNITS>(&scratch.hidden[number as usize]);
            let chosen = units::<UNITS>(&chosen);
            for row in 0..count + 1 {
                let moves = (beta1, rest1 * scratch.row_factor[row], scratch.row_step_size[row]);
                momentum_step(&mut means[row], &mut weights[row], moves, &below);
            }
            for row in count + 1..rows as usize {
                let moves = (beta1, rest1 * scratch.row_factor[row], scratch.row_step_size[row]);
                let alike = if row + 1 < rows as usize { &above } else { &chosen };
                momentum_step(&mut means[row], &mut weights[row], moves, alike);
            }
        } else {
            let rest2 = 1.0 - beta2;
            let (weights, moments) = nets[net..net + 3 * tensor].split_at_mut(tensor);
            let (means, squares) = moments.split_at_mut(tensor);
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

/// Moves the net of `child` so that its output changes by about `delta` times the learning rate `step_size`.
#[inline(always)]
pub fn backward(group: &mut Workgroup<'_>, skill: u32, child: u32, delta: f32, step_size: f32) {
    let (skill, params) = (&group.skills[skill as usize], &group.params[skill as usize]);
    let nets = group.nets.trained();
    let scratch = &mut Scratch {
        hidden: &group.hidden,
        inputs: &group.inputs,
        q: &group.q,
        row_factor: &mut group.row_factor,
        row_step_size: &mut group.row_step_size,
    };
    let number = if skill.nets == 1 { 0 } else { child };
    let found = net_errors(nets, scratch, skill, number, child, delta);
    let own = (number, child - number);
    if lanes_used(params.hidden) == HALF_LANES {
        apply::<HALF_LANES>(nets, scratch, skill, params, own, &found, step_size);
    } else {
        apply::<LANES>(nets, scratch, skill, params, own, &found, step_size);
    }
}
