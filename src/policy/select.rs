//! Boltzmann exploration over the allowed children, and the greedy choice (paper, section V: "the robot
//! chose actions randomly, but preferred to choose actions having high utilities").
//!
//! Sets of children are bits: bit c stands for child c.

use crate::env::workgroup::Scratch;
pub use crate::layout::choices::{POLICY_LEARNED, POLICY_RANDOM};
use crate::layout::{HyperParams, MAX_CHILDREN};
use crate::math::functions::exponential;
use crate::math::rng::unit;

/// Stands for no child.
pub const NO_CHILD: u32 = 255;

/// What the Q-values say about the allowed children.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outlook {
    /// Greatest Q-value.
    pub best: f32,
    /// The child that has it; the first of several.
    pub greedy: u32,
    /// Sum of the Boltzmann weights in `odds`.
    pub total: f32,
}

/// Inverse temperature of a trial: it rises linearly over the first trials.
#[inline(always)]
pub fn inverse_temperature(params: &HyperParams, trial: u32) -> f32 {
    let risen = if trial < params.inverse_temperature_trials { trial } else { params.inverse_temperature_trials };
    params.inverse_temperature_slope * risen as f32 + params.inverse_temperature_start
}

/// Weighs the children: `odds` holds exponential(inverse_temperature (Q - best)), 0 for those not allowed.
#[inline(always)]
pub fn weigh(scratch: &mut Scratch, children: u32, allowed: u32, inverse_temperature: f32) -> Outlook {
    let mut best = -2.0;
    let mut greedy = 0;
    for child in 0..children {
        let value = scratch.q[child as usize];
        let better = value > best && ((allowed >> child) & 1) == 1;
        best = if better { value } else { best };
        greedy = if better { child } else { greedy };
    }
    for child in 0..MAX_CHILDREN {
        let available = (child as u32) < children && ((allowed >> child) & 1) == 1;
        let weight = exponential(inverse_temperature * (scratch.q[child] - best));
        scratch.odds[child] = if available { weight } else { 0.0 };
    }
    let mut total = scratch.odds[0];
    for child in 1..MAX_CHILDREN {
        total += scratch.odds[child];
    }
    Outlook { best, greedy, total }
}

/// Draws a child with probability odds / total.
#[inline(always)]
pub fn pick(scratch: &Scratch, outlook: Outlook, word: u32) -> u32 {
    let mark = unit(word) * outlook.total;
    let mut sum = 0.0;
    let mut chosen = outlook.greedy;
    let mut open = true;
    for child in 0..MAX_CHILDREN {
        sum += scratch.odds[child];
        let here = open && mark < sum;
        chosen = if here { child as u32 } else { chosen };
        open = open && !here;
    }
    chosen
}

/// Chooses among the allowed children by the skill's own rule. `greedy` takes the best learned value.
#[inline(always)]
pub fn choose(
    scratch: &mut Scratch,
    params: &HyperParams,
    children: u32,
    allowed: u32,
    inverse_temperature: f32,
    greedy: bool,
    word: u32,
) -> u32 {
    let even = params.policy != POLICY_LEARNED;
    let outlook = weigh(scratch, children, allowed, if even { 0.0 } else { inverse_temperature });
    let drawn = pick(scratch, outlook, word);
    let first = allowed.trailing_zeros();
    let learned = if greedy { outlook.greedy } else { drawn };
    let other = if params.policy == POLICY_RANDOM { drawn } else { first };
    if even { other } else { learned }
}
