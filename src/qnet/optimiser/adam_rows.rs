//! Adam with one second moment for each row of weights.
//!
//! Adam-mini (Zhang and others, 2024) keeps one second moment for a block of weights. Ours takes a row, the weights of
//! one input, as the block: its gradient is a factor times the errors of the hidden units, so that the mean of its
//! square needs no pass over the weights.

use crate::env::workgroup::Workgroup;
use crate::layout::{LANES, MAX_INPUTS};
use crate::math::functions::{flush, reciprocal_sqrt};
use crate::math::reduce::lanes_sums;
use crate::qnet::gradient::NetErrors;

impl Workgroup<'_> {
    /// Finds, for each row of weights of net `number`, the factor that its gradient has in common and how far it moves
    /// along its mean gradient. The second moments of the rows are the first words of the third tensor. Lanes are hidden
    /// units, then rows.
    fn row_step_sizes(&mut self, units: usize, skill: u32, number: u32, output: u32, errors: &NetErrors, rate: f32) {
        let s = skill as usize;
        for lane in 0..LANES {
            let own_activation = self.hidden[number as usize][lane];
            self.partials[0][lane] = errors.hidden[lane] * errors.hidden[lane];
            self.partials[1][lane] = own_activation * own_activation;
        }
        lanes_sums(&mut self.partials, 2, units);
        let hidden_share = self.partials[0][0] * self.params[s].unit_share;
        let activation = self.partials[1][0] * self.params[s].unit_share;
        let count = self.skills[s].inputs as usize;
        let last = count + 1 + self.skills[s].outputs as usize;
        let rest2 = 1.0 - self.params[s].beta2;
        let squares = self.skills[s].net_offset(number) + 2 * self.skills[s].rows as usize * LANES;
        // Blocks of rows, as many as there are.
        for block in (0..=last).step_by(LANES) {
            for lane in 0..LANES {
                let row = block + lane;
                let x = if row < count { self.inputs[row.min(MAX_INPUTS - 1)] } else { 1.0 };
                let own = row == count + 1 + output as usize || row == last;
                let out = if own { errors.output } else { 0.0 };
                let factor = if row <= count { x } else { out };
                let above = if row < last { activation } else { 1.0 };
                let alike = if row <= count { hidden_share } else { above };
                let square = flush(self.params[s].beta2 * self.nets[squares + row] + rest2 * (factor * factor * alike));
                self.nets.trained()[squares + row] = square;
                self.row_factor[row] = factor;
                self.row_step_size[row] = rate * reciprocal_sqrt(square + self.params[s].epsilon2);
            }
        }
    }

    /// Moves net `number`; the second tensor holds the mean gradients.
    pub fn adam_rows(&mut self, units: usize, skill: u32, number: u32, output: u32, errors: &NetErrors, rate: f32) {
        let net = self.skills[skill as usize].net_offset(number);
        let weights_at = self.weights_offset(skill, units, number);
        let stride = self.row_stride(units);
        let tensor = self.skills[skill as usize].rows as usize * LANES;
        let beta1 = self.params[skill as usize].beta1;
        let rest1 = 1.0 - beta1;
        self.row_step_sizes(units, skill, number, output, errors, rate);
        for row in 0..self.skills[skill as usize].rows as usize {
            for lane in 0..units {
                let chosen = if lane == output as usize { 1.0 } else { 0.0 };
                let at = net + row * LANES + lane;
                let own = weights_at + row * stride + lane;
                let last = row + 1 == self.skills[skill as usize].rows as usize;
                let above = if last { chosen } else { self.hidden[number as usize][lane] };
                let alike =
                    if row <= self.skills[skill as usize].inputs as usize { errors.hidden[lane] } else { above };
                let factor = rest1 * self.row_factor[row];
                let mean = flush(beta1 * self.nets[at + tensor] + factor * alike);
                self.nets.trained()[at + tensor] = mean;
                self.set_weight(own, self.weight(own) + self.row_step_size[row] * mean);
            }
        }
    }
}
