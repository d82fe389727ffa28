//! Gradient descent with momentum.

use crate::env::workgroup::Workgroup;
use crate::layout::LANES;
use crate::math::functions::flush;
use crate::qnet::gradient::NetErrors;

impl Workgroup<'_> {
    /// Moves net `number` along its gradient; the second tensor holds the velocities.
    pub fn sgd(&mut self, units: usize, skill: u32, number: u32, output: u32, errors: &NetErrors, step_size: f32) {
        let net = self.skills[skill as usize].net_offset(number);
        let weights_at = self.weights_offset(skill, units, number);
        let stride = self.row_stride(units);
        let tensor = self.skills[skill as usize].rows as usize * LANES;
        let momentum = self.params[skill as usize].beta1;
        for row in 0..self.skills[skill as usize].rows as usize {
            let slope = self.gradient(skill, number, output, row as u32, errors);
            // A lane without a hidden unit has no rows.
            for lane in 0..units {
                let at = net + row * LANES + lane;
                let own = weights_at + row * stride + lane;
                let velocity = flush(momentum * self.nets[at + tensor] + step_size * slope[lane]);
                self.nets.trained()[at + tensor] = velocity;
                self.set_weight(own, self.weight(own) + velocity);
            }
        }
    }
}
