//! Adam (Kingma and Ba, 2015) in its second form, with epsilon under the root: one reciprocal root serves where a
//! root and a division would.

use crate::env::workgroup::Workgroup;
use crate::layout::LANES;
use crate::math::functions::{flush, reciprocal, reciprocal_sqrt, square_root};
use crate::qnet::gradient::NetErrors;

/// Lane of the clock row from which the powers of beta2 stand, net by net; those of beta1 stand from lane 0.
pub const BETA2_POWER: usize = 16;

impl Workgroup<'_> {
    /// The learning rate corrected for the moments' bias; moves the net's clock on.
    pub fn bias_corrected_rate(&mut self, skill: u32, number: u32, step_size: f32) -> f32 {
        let clock = (self.skills[skill as usize].clock_offset + number) as usize;
        let first = flush(self.nets[clock] * self.params[skill as usize].beta1);
        let second = flush(self.nets[clock + BETA2_POWER] * self.params[skill as usize].beta2);
        self.nets.trained()[clock] = first;
        self.nets.trained()[clock + BETA2_POWER] = second;
        step_size * square_root(1.0 - second) * reciprocal(1.0 - first)
    }

    /// Moves net `number`; the second tensor holds the mean gradients, the third the mean squared gradients.
    pub fn adam(&mut self, units: usize, skill: u32, number: u32, output: u32, errors: &NetErrors, rate: f32) {
        let net = self.skills[skill as usize].net_offset(number);
        let weights_at = self.weights_offset(skill, units, number);
        let stride = self.row_stride(units);
        let tensor = self.skills[skill as usize].rows as usize * LANES;
        let beta1 = self.params[skill as usize].beta1;
        let beta2 = self.params[skill as usize].beta2;
        let epsilon2 = self.params[skill as usize].epsilon2;
        let rest1 = 1.0 - beta1;
        let rest2 = 1.0 - beta2;
        for row in 0..self.skills[skill as usize].rows as usize {
            let slope = self.gradient(skill, number, output, row as u32, errors);
            for lane in 0..units {
                let g = slope[lane];
                let at = net + row * LANES + lane;
                let own = weights_at + row * stride + lane;
                let mean = flush(beta1 * self.nets[at + tensor] + rest1 * g);
                let square = flush(beta2 * self.nets[at + 2 * tensor] + rest2 * (g * g));
                self.nets.trained()[at + tensor] = mean;
                self.nets.trained()[at + 2 * tensor] = square;
                self.set_weight(own, self.weight(own) + rate * mean * reciprocal_sqrt(square + epsilon2));
            }
        }
    }
}
