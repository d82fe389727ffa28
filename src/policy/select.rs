//! Boltzmann exploration over the allowed children, and the greedy choice (paper, section V: "the robot
//! chose actions randomly, but preferred to choose actions having high utilities").
//!
//! Sets of children are bits: bit c stands for child c.

use crate::env::workgroup::Workgroup;
use crate::layout::choices::{POLICY_LEARNED, POLICY_RANDOM};
use crate::layout::{Boltzmann, MAX_CHILDREN};
use crate::math::functions::exponential;
use crate::math::rng::unit;

impl Workgroup<'_> {
    /// Inverse temperature of a trial: it rises linearly over the first trials.
    pub fn inverse_temperature(&self, skill: u32, trial: u32) -> f32 {
        let s = skill as usize;
        let risen = if trial < self.params[s].inverse_temperature_trials {
            trial
        } else {
            self.params[s].inverse_temperature_trials
        };
        self.params[s].inverse_temperature_slope * risen as f32 + self.params[s].inverse_temperature_start
    }

    /// Weighs the children: `weights` holds exponential(inverse temperature (Q - best)), 0 for those not allowed.
    #[inline(always)]
    pub fn boltzmann(&mut self, children: u32, allowed: u32, inverse_temperature: f32) -> Boltzmann {
        let mut best = -2.0;
        let mut greedy = 0;
        for child in 0..children {
            let value = self.q[child as usize];
            let better = value > best && ((allowed >> child) & 1) == 1;
            best = if better { value } else { best };
            greedy = if better { child } else { greedy };
        }
        for lane in 0..MAX_CHILDREN {
            let available = lane < children as usize && ((allowed >> lane) & 1) == 1;
            let weight = exponential(inverse_temperature * (self.q[lane] - best));
            self.weights[lane] = if available { weight } else { 0.0 };
        }
        let mut total = self.weights[0];
        for child in 1..MAX_CHILDREN {
            total += self.weights[child];
        }
        Boltzmann { best, greedy, total }
    }

    /// Draws a child with probability weight / total.
    pub fn sample(&self, found: Boltzmann, word: u32) -> u32 {
        let mark = unit(word) * found.total;
        let mut sum = 0.0;
        let mut chosen = found.greedy;
        let mut open = true;
        for child in 0..MAX_CHILDREN {
            sum += self.weights[child];
            let here = open && mark < sum;
            chosen = if here { child as u32 } else { chosen };
            open = open && !here;
        }
        chosen
    }

    /// Chooses among the allowed children by the skill's own rule. `greedy` takes the best learned value.
    pub fn choose(&mut self, skill: u32, allowed: u32, inverse_temperature: f32, greedy: bool, word: u32) -> u32 {
        let choice = self.params[skill as usize].policy;
        let even = choice != POLICY_LEARNED;
        let children = self.skills[skill as usize].children;
        let found = (self.forms.boltzmann)(self, children, allowed, if even { 0.0 } else { inverse_temperature });
        let drawn = self.sample(found, word);
        let first = allowed.trailing_zeros();
        let learned = if greedy { found.greedy } else { drawn };
        let other = if choice == POLICY_RANDOM { drawn } else { first };
        if even { other } else { learned }
    }
}
