//! Q-values of every child.

use crate::env::workgroup::Workgroup;
use crate::layout::{LANES, MAX_CHILDREN, SkillShape};
use crate::math::functions::tanh;
use crate::math::reduce::lanes_sums;

/// Lanes that do for a net of few hidden units.
pub const HALF_LANES: usize = 16;

/// Lanes in which a net has hidden units. In the others all is 0, and stays so.
#[inline(always)]
pub fn lanes_used(hidden_units: u32) -> usize {
    if hidden_units as usize <= HALF_LANES { HALF_LANES } else { LANES }
}

impl SkillShape {
    /// Word at which net number `net` stands in a learner's nets; its three tensors follow one another.
    ///
    /// Between two nets half a row stays free. That is a line of the CPU's cache: nets of few units, which use the first
    /// half of each row, would otherwise share every other line and leave the rest idle.
    #[inline(always)]
    pub fn net_offset(&self, net: u32) -> usize {
        self.nets_offset as usize + net as usize * (3 * self.rows as usize * LANES + HALF_LANES)
    }
}

impl Workgroup<'_> {
    /// Computes `hidden` of every net, and what its outputs are summed from. `units` lanes are in use.
    fn hidden_layer(&mut self, units: usize, skill: u32) {
        let count = self.skills[skill as usize].inputs as usize;
        let outputs = self.skills[skill as usize].outputs as usize;
        let stride = self.row_stride(units);
        for number in 0..self.skills[skill as usize].nets as usize {
            let net = self.weights_offset(skill, units, number as u32);
            let mut activation = [0.0; LANES];
            for lane in 0..units {
                let mut sum = self.weight(net + count * stride + lane);
                for row in 0..count {
                    let x = self.inputs[row];
                    let shape = &self.skills[skill as usize];
                    let bits = if row >= 32 { shape.bits_high } else { shape.bits_low };
                    // A bit that is not set adds nothing.
                    if x != 0.0 || ((bits >> (row % 32)) & 1) == 0 {
                        sum += self.weight(net + row * stride + lane) * x;
                    }
                }
                activation[lane] = tanh(sum);
                for output in 0..outputs {
                    self.partials[number + output][lane] =
                        activation[lane] * self.weight(net + (count + 1 + output) * stride + lane);
                }
            }
            self.hidden[number] = activation;
        }
    }

    /// Computes `hidden` and `q` of every child of a skill from `inputs`.
    pub fn forward(&mut self, skill: u32) {
        let children = self.skills[skill as usize].children;
        let units = lanes_used(self.params[skill as usize].hidden);
        self.hidden_layer(units, skill);
        lanes_sums(&mut self.partials, children, units);
        for lane in 0..children as usize {
            let net = if self.skills[skill as usize].nets == 1 { 0 } else { lane };
            let row = (self.skills[skill as usize].inputs + 1 + self.skills[skill as usize].outputs) as usize;
            let at = self.weights_offset(skill, units, net as u32) + row * self.row_stride(units) + (lane - net);
            let bias = self.weight(at);
            self.q[lane] = tanh(self.partials[lane][0] + bias);
        }
        for lane in children as usize..MAX_CHILDREN {
            self.q[lane] = 0.0;
        }
    }
}
