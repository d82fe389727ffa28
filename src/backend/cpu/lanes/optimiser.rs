//! The optimisers, a row of weights at a time.

use crate::env::workgroup::{Nets, Workgroup};
use crate::layout::choices::{OPTIMISER_ADAM, OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::layout::{HyperParams, LANES, MAX_INPUTS, MAX_ROWS, SkillShape};
use crate::math::functions::{flush, reciprocal_sqrt};
use crate::math::reduce::Lanes;
use crate::qnet::forward::{HALF_LANES, lanes_used};
use crate::qnet::gradient::NetErrors;

/// Rows whose step sizes are found together: a divisor of `MAX_ROWS`.
const ROW_BLOCK: usize = 16;

/// Rules that have a form here; any other is carried out as its plain twin has it.
const TUNED: [u32; 3] = [OPTIMISER_SGD, OPTIMISER_ADAM, OPTIMISER_ADAM_ROWS];

/// One net's update.
struct Update<'a> {
    shape: &'a SkillShape,
    params: &'a HyperParams,
    /// The net.
    number: u32,
    /// Which of its outputs should rise.
    output: u32,
    errors: NetErrors,
    /// The learning rate, corrected for the moments' bias where there are moments.
    rate: f32,
}

impl Update<'_> {
    /// Ascent direction of one row of weights.
    #[inline(always)]
    fn gradient(&self, group: &Workgroup<'_>, row: u32) -> Lanes {
        let count = self.shape.inputs;
        let last = count + 1 + self.shape.outputs;
        let mut slope = self.errors.hidden;
        if row < count {
            let x = group.inputs[row as usize];
            for lane in 0..LANES {
                slope[lane] = self.errors.hidden[lane] * x;
            }
        }
        if row > count && row < last {
            let own = row == count + 1 + self.output;
            for lane in 0..LANES {
                slope[lane] = if own { self.errors.output * group.hidden[self.number as usize][lane] } else { 0.0 };
            }
        }
        if row == last {
            slope = self.chosen(self.errors.output);
        }
        slope
    }

    /// A value in the lane of the output that should rise.
    #[inline(always)]
    fn chosen(&self, value: f32) -> Lanes {
        std::array::from_fn(|lane| if lane == self.output as usize { value } else { 0.0 })
    }

    /// Finds, for each row of weights, the factor that its gradient has in common and how far it moves along its mean
    /// gradient; lanes are rows. `squares` are the rows' second moments.
    #[inline(always)]
    fn row_step_sizes<const UNITS: usize>(&self, group: &mut Workgroup<'_>, squares: &mut [f32]) {
        let (mut below, mut above) = ([0.0; UNITS], [0.0; UNITS]);
        for lane in 0..UNITS {
            let activation = group.hidden[self.number as usize][lane];
            below[lane] = self.errors.hidden[lane] * self.errors.hidden[lane];
            above[lane] = activation * activation;
        }
        let hidden = lanes_sum(&below) * self.params.unit_share;
        let activation = lanes_sum(&above) * self.params.unit_share;
        let count = self.shape.inputs as usize;
        let last = count + 1 + self.shape.outputs as usize;
        let rest2 = 1.0 - self.params.beta2;
        let mut inputs = [0.0; MAX_ROWS];
        inputs[..MAX_INPUTS].copy_from_slice(&group.inputs);
        // Blocks of rows, as many as there are.
        for block in (0..=last).step_by(ROW_BLOCK) {
            let mut factors = [0.0; ROW_BLOCK];
            let mut moved = units::<ROW_BLOCK>(&squares[block..]);
            let mut step_sizes = [0.0; ROW_BLOCK];
            let x = units::<ROW_BLOCK>(&inputs[block..]);
            for lane in 0..ROW_BLOCK {
                let row = block + lane;
                let x = if row < count { x[lane] } else { 1.0 };
                let own = row == count + 1 + self.output as usize || row == last;
                let out = if own { self.errors.output } else { 0.0 };
                let factor = if row <= count { x } else { out };
                let above = if row < last { activation } else { 1.0 };
                let alike = if row <= count { hidden } else { above };
                moved[lane] = flush(self.params.beta2 * moved[lane] + rest2 * (factor * factor * alike));
                factors[lane] = factor;
                step_sizes[lane] = self.rate * reciprocal_sqrt(moved[lane] + self.params.epsilon2);
            }
            squares[block..block + ROW_BLOCK].copy_from_slice(&moved);
            group.row_factor[block..block + ROW_BLOCK].copy_from_slice(&factors);
            group.row_step_size[block..block + ROW_BLOCK].copy_from_slice(&step_sizes);
        }
    }

    /// Moves the net, of which `UNITS` lanes are in use.
    #[inline(always)]
    fn apply<const UNITS: usize>(&self, group: &mut Workgroup<'_>, nets: &mut [f32]) {
        let rows = self.shape.rows as usize;
        let (beta1, beta2, epsilon2) = (self.params.beta1, self.params.beta2, self.params.epsilon2);
        let (rest1, rest2) = (1.0 - beta1, 1.0 - beta2);
        let (weights, moments) = nets[self.shape.net_offset(self.number)..].split_at_mut(rows * LANES);
        let (means, squares) = moments.split_at_mut(rows * LANES);
        let weights = weights.as_chunks_mut::<LANES>().0;
        let means = means.as_chunks_mut::<LANES>().0;
        if self.params.optimiser == OPTIMISER_SGD {
            for row in 0..rows {
                let slope = self.gradient(group, row as u32);
                let (mut velocity, mut weight) = (units::<UNITS>(&means[row]), units::<UNITS>(&weights[row]));
                for lane in 0..UNITS {
                    velocity[lane] = flush(beta1 * velocity[lane] + self.rate * slope[lane]);
                    weight[lane] += velocity[lane];
                }
                means[row][..UNITS].copy_from_slice(&velocity);
                weights[row][..UNITS].copy_from_slice(&weight);
            }
        } else if self.params.optimiser == OPTIMISER_ADAM_ROWS {
            self.row_step_sizes::<UNITS>(group, &mut squares[..MAX_ROWS]);
            let count = self.shape.inputs as usize;
            let below = units::<UNITS>(&self.errors.hidden);
            let above = units::<UNITS>(&group.hidden[self.number as usize]);
            let chosen = units::<UNITS>(&self.chosen(1.0));
            for row in 0..count + 1 {
                let moves = (beta1, rest1 * group.row_factor[row], group.row_step_size[row]);
                momentum_step(&mut means[row], &mut weights[row], moves, &below);
            }
            for row in count + 1..rows {
                let moves = (beta1, rest1 * group.row_factor[row], group.row_step_size[row]);
                let alike = if row + 1 < rows { &above } else { &chosen };
                momentum_step(&mut means[row], &mut weights[row], moves, alike);
            }
        } else {
            let squares = squares.as_chunks_mut::<LANES>().0;
            for row in 0..rows {
                let slope = self.gradient(group, row as u32);
                let (mut mean, mut square) = (units::<UNITS>(&means[row]), units::<UNITS>(&squares[row]));
                let mut weight = units::<UNITS>(&weights[row]);
                for lane in 0..UNITS {
                    let g = slope[lane];
                    mean[lane] = flush(beta1 * mean[lane] + rest1 * g);
                    square[lane] = flush(beta2 * square[lane] + rest2 * (g * g));
                    weight[lane] += self.rate * mean[lane] * reciprocal_sqrt(square[lane] + epsilon2);
                }
                means[row][..UNITS].copy_from_slice(&mean);
                squares[row][..UNITS].copy_from_slice(&square);
                weights[row][..UNITS].copy_from_slice(&weight);
            }
        }
    }
}

/// Sum of the lanes by the tree of [`crate::math::reduce::lanes_sums`], by value: a way through memory takes longer than
/// the sum.
#[inline(always)]
fn lanes_sum<const N: usize>(lanes: &[f32; N]) -> f32 {
    let mut half = [0.0; 16];
    half.copy_from_slice(&lanes[..16]);
    if N == LANES {
        for lane in 0..16 {
            half[lane] += lanes[lane + 16];
        }
    }
    let quarter: [f32; 8] = folded(&half);
    let eighth: [f32; 4] = folded(&quarter);
    let pair: [f32; 2] = folded(&eighth);
    pair[0] + pair[1]
}

/// The upper half of the lanes added to the lower.
#[inline(always)]
fn folded<const N: usize, const HALF: usize>(lanes: &[f32; N]) -> [f32; HALF] {
    let mut half = [0.0; HALF];
    for lane in 0..HALF {
        half[lane] = lanes[lane] + lanes[lane + HALF];
    }
    half
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

/// Moves the net of `child` so that its output changes by about `delta` times the learning rate `step_size`.
#[inline(always)]
pub fn backward(group: &mut Workgroup<'_>, skill: u32, child: u32, delta: f32, step_size: f32) {
    let (shape, params) = (&group.skills[skill as usize], &group.params[skill as usize]);
    if !TUNED.contains(&params.optimiser) {
        return group.backward(skill, child, delta, step_size);
    }
    let number = if shape.nets == 1 { 0 } else { child };
    let moments = params.optimiser != OPTIMISER_SGD;
    let rate = if moments { group.bias_corrected_rate(skill, number, step_size) } else { step_size };
    // Apart from the group, so that both can be written.
    let mut taken = std::mem::replace(&mut group.nets, Nets::Read(&[]));
    let nets = taken.trained();
    let value = group.q[child as usize];
    let output = delta * (1.0 - value * value);
    let row = &nets[shape.net_offset(number) + (shape.inputs + 1 + child - number) as usize * LANES..][..LANES];
    let mut hidden = [0.0; LANES];
    for lane in 0..LANES {
        let activation = group.hidden[number as usize][lane];
        hidden[lane] = output * row[lane] * (1.0 - activation * activation);
    }
    let errors = NetErrors { output, hidden };
    let update = Update { shape, params, number, output: child - number, errors, rate };
    if lanes_used(params.hidden) == HALF_LANES {
        update.apply::<HALF_LANES>(group, nets);
    } else {
        update.apply::<LANES>(group, nets);
    }
    group.nets = taken;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_by_value_follow_the_tree() {
        let values: [f32; LANES] = std::array::from_fn(|i| ((i * 7) % 32) as f32 + 0.5);
        assert_eq!((lanes_sum(&values), lanes_sum::<16>(values.first_chunk().expect("16 of 32"))), (512.0, 240.0));
        let mut uneven = [0.0; LANES];
        (uneven[0], uneven[1], uneven[16]) = (1.0e8, 1.0, -1.0e8);
        assert_eq!(lanes_sum(&uneven), 1.0);
    }
}
