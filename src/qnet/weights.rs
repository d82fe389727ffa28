//! Where the weights of a net are: in the learner's nets or, while it replays, in the workgroup's own memory.

use super::forward::lanes_used;
use crate::env::workgroup::Workgroup;
use crate::layout::LANES;

impl Workgroup<'_> {
    /// Word at which the weights of net `net` begin, in whichever memory they are.
    pub fn weights_offset(&self, skill: u32, units: usize, net: u32) -> usize {
        if self.weights_held {
            (net * self.skills[skill as usize].rows) as usize * units
        } else {
            self.skills[skill as usize].net_offset(net)
        }
    }

    /// Words from one row of weights to the next.
    pub fn row_stride(&self, units: usize) -> usize {
        if self.weights_held { units } else { LANES }
    }

    /// A weight.
    pub fn weight(&self, at: usize) -> f32 {
        if self.weights_held {
            return self.held_weights[at];
        }
        self.nets[at]
    }

    /// Writes a weight.
    pub fn set_weight(&mut self, at: usize, value: f32) {
        if self.weights_held {
            self.held_weights[at] = value;
        } else {
            self.nets.trained()[at] = value;
        }
    }

    /// Takes the weights of the skill in training into the workgroup's memory, where they fit.
    pub fn hold_weights(&mut self) {
        let skill = self.state.skill as usize;
        let units = lanes_used(self.params[skill].hidden);
        let rows = self.skills[skill].rows as usize;
        if !self.weights_held && self.skills[skill].nets as usize * rows * units <= self.held_weights.len() {
            for number in 0..self.skills[skill].nets {
                let net = self.skills[skill].net_offset(number);
                for row in 0..rows {
                    for lane in 0..units {
                        self.held_weights[(number as usize * rows + row) * units + lane] =
                            self.nets[net + row * LANES + lane];
                    }
                }
            }
            self.weights_held = true;
        }
    }

    /// Puts them back.
    pub fn release_weights(&mut self) {
        if self.weights_held {
            let skill = self.state.skill as usize;
            let units = lanes_used(self.params[skill].hidden);
            let rows = self.skills[skill].rows as usize;
            for number in 0..self.skills[skill].nets {
                let net = self.skills[skill].net_offset(number);
                for row in 0..rows {
                    for lane in 0..units {
                        self.nets.trained()[net + row * LANES + lane] =
                            self.held_weights[(number as usize * rows + row) * units + lane];
                    }
                }
            }
            self.weights_held = false;
        }
    }
}
