//! Error back-propagation through one child's net (paper, section I, step 2).

use crate::env::workgroup::Workgroup;
use crate::layout::LANES;
use crate::math::reduce::Lanes;

/// Back-propagated errors.
#[derive(Debug, Clone, Copy)]
pub struct NetErrors {
    /// Of the output's sum.
    pub output: f32,
    /// Of each hidden unit's sum.
    pub hidden: Lanes,
}

impl Workgroup<'_> {
    /// Errors of net `number`, whose output for `child` should rise by `delta`.
    pub fn net_errors(&self, units: usize, skill: u32, number: u32, child: u32, delta: f32) -> NetErrors {
        let value = self.q[child as usize];
        let output = delta * (1.0 - value * value);
        let row = (self.skills[skill as usize].inputs + 1 + child - number) as usize;
        let mut hidden = [0.0; LANES];
        for lane in 0..LANES {
            let activation = self.hidden[number as usize][lane];
            let mut own = 0.0;
            if lane < units {
                own = self.weight(self.weights_offset(skill, units, number) + row * self.row_stride(units) + lane);
            }
            hidden[lane] = output * own * (1.0 - activation * activation);
        }
        NetErrors { output, hidden }
    }

    /// Ascent direction of one row of weights of net `number`, for its output `output`.
    pub fn gradient(&self, skill: u32, number: u32, output: u32, row: u32, errors: &NetErrors) -> Lanes {
        let count = self.skills[skill as usize].inputs;
        let last = count + 1 + self.skills[skill as usize].outputs;
        let mut slope = errors.hidden;
        for lane in 0..LANES {
            if row < count {
                slope[lane] = errors.hidden[lane] * self.inputs[row as usize];
            }
            if row > count && row < last {
                let own = row == count + 1 + output;
                slope[lane] = if own { errors.output * self.hidden[number as usize][lane] } else { 0.0 };
            }
            if row == last {
                slope[lane] = if lane == output as usize { errors.output } else { 0.0 };
            }
        }
        slope
    }

    /// Learning rate of a trial: it falls linearly over the first trials.
    pub fn learning_rate(&self, skill: u32, trial: u32) -> f32 {
        let s = skill as usize;
        let risen =
            if trial < self.params[s].learning_rate_trials { trial } else { self.params[s].learning_rate_trials };
        self.params[s].learning_rate * (1.0 - self.params[s].learning_rate_fall * risen as f32)
    }
}
