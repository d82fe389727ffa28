//! How a net moves along its gradient: a file pair for each rule, and which of them a skill has.

pub mod adam;
pub mod adam_rows;
pub mod sgd;

use super::gradient::NetErrors;
use crate::env::workgroup::Workgroup;
use crate::layout::choices::{OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
use crate::layout::shader::{Part, parts};

/// The shaders.
pub const PARTS: &[Part] = parts![
    "qnet/optimiser/sgd.wgsl",
    "qnet/optimiser/adam.wgsl",
    "qnet/optimiser/adam_rows.wgsl",
    "qnet/optimiser/mod.wgsl",
];

impl Workgroup<'_> {
    /// Moves net `number` by the skill's rule so that `output` changes by about its error times `step_size`.
    pub fn optimise(&mut self, units: usize, skill: u32, number: u32, output: u32, errors: &NetErrors, step_size: f32) {
        let optimiser = self.params[skill as usize].optimiser;
        if optimiser == OPTIMISER_SGD {
            self.sgd(units, skill, number, output, errors, step_size);
        } else {
            let rate = self.bias_corrected_rate(skill, number, step_size);
            if optimiser == OPTIMISER_ADAM_ROWS {
                self.adam_rows(units, skill, number, output, errors, rate);
            } else {
                self.adam(units, skill, number, output, errors, rate);
            }
        }
    }
}
