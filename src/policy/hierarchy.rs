//! From the skills of a tree down to an action.
//!
//! The choice is made anew on every primitive step at every level (paper, section VI.A); persistence decides how
//! free it is.

use crate::env::observe::DRAW_CHOICE;
use crate::env::workgroup::Workgroup;
use crate::layout::{ELEMENTARY_STEP_WORDS, MAX_DEPTH, SKILL_CODE};

impl Workgroup<'_> {
    /// Q-values of skill `n`, from its nets or from the planner's table.
    pub fn q_values(&mut self, n: u32) {
        if self.skills[n as usize].record_words > ELEMENTARY_STEP_WORDS as u32 {
            self.write_high_level(n);
        }
        if self.skills[n as usize].planned > 0 {
            self.planned_values(n);
        } else {
            (self.forms.encode)(self, n, self.skills[n as usize].mirrored == 1);
            (self.forms.forward)(self, n);
        }
    }

    /// Asks the skills below the root whose values somebody's applicability depends on, children first.
    pub fn value_children(&mut self, root: u32) {
        for n in 0..root {
            if ((self.skills[root as usize].watched >> n) & 1) == 1 {
                self.q_values(n);
                let mut best = -2.0;
                for child in 0..self.skills[n as usize].children as usize {
                    let worth = self.q[child];
                    best = if worth > best { worth } else { best };
                    self.kept_q[n as usize][child] = worth;
                }
                self.best_value[n as usize] = best;
            }
        }
    }

    /// Lets the skills below the root choose, down to an action, once the root has chosen `child`.
    pub fn descend_to_action(&mut self, root: u32, child: u32) -> u32 {
        let inverse_temperature = self.params[root as usize].child_inverse_temperature;
        let mut code = self.skills[root as usize].child[child as usize];
        let mut asked = 1 << root;
        let mut last = root;
        for depth in 1..MAX_DEPTH {
            if code < SKILL_CODE as u32 {
                break;
            }
            let n = code - SKILL_CODE as u32;
            if ((self.skills[root as usize].watched >> n) & 1) == 1 {
                for lane in 0..self.skills[n as usize].children as usize {
                    self.q[lane] = self.kept_q[n as usize][lane];
                }
                if self.skills[n as usize].record_words > ELEMENTARY_STEP_WORDS as u32 {
                    self.write_high_level(n);
                }
            } else {
                self.q_values(n);
            }
            let choices = self.action_mask(n, self.params[n as usize].persist_tests == 1);
            let word = self.random.x[DRAW_CHOICE + depth];
            let chosen = self.choose(n, choices.allowed, inverse_temperature, false, word);
            self.commit(n, chosen, choices);
            code = self.skills[n as usize].child[chosen as usize];
            asked |= 1 << n;
            last = n;
        }
        self.stop_unasked(root, asked);
        self.agent.masks = self.params[last as usize].mask_blocked;
        code
    }
}
