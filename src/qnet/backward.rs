//! One step of a child's net towards a target, by the skill's optimiser.

use super::forward::lanes_used;
use crate::env::workgroup::Workgroup;

impl Workgroup<'_> {
    /// Moves the net of `child` so that its output changes by about `delta` times the learning rate `step_size`.
    pub fn backward(&mut self, skill: u32, child: u32, delta: f32, step_size: f32) {
        let units = lanes_used(self.params[skill as usize].hidden);
        let number = if self.skills[skill as usize].nets == 1 { 0 } else { child };
        let output = child - number;
        let errors = self.net_errors(units, skill, number, child, delta);
        self.optimise(units, skill, number, output, &errors, step_size);
    }
}
