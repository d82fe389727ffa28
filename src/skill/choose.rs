//! Boltzmann exploration over the available children, and the greedy choice (paper, section V: "the robot
//! chose actions randomly, but preferred to choose actions having high utilities").

use crate::learner::layout::{MAX_CHILDREN, Settings};
use crate::learner::memory::Scratch;
use crate::math::functions::exponential;
use crate::math::rng::unit;

/// What the Q-values say about the available children.
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
pub fn sharpness(settings: &Settings, trial: u32) -> f32 {
    let risen = if trial < settings.sharpness_trials { trial } else { settings.sharpness_trials };
    settings.sharpness_slope * risen as f32 + settings.sharpness_start
}

/// Weighs the children: `odds` holds exponential(sharpness (Q - best)), 0 for the masked child.
#[inline(always)]
pub fn weigh(scratch: &mut Scratch, children: u32, masked: u32, sharpness: f32) -> Outlook {
    let mut best = -2.0;
    let mut greedy = 0;
    for child in 0..children {
        let value = scratch.q[child as usize];
        // A lone child is always available.
        let better = value > best && (child != masked || children == 1);
        best = if better { value } else { best };
        greedy = if better { child } else { greedy };
    }
    for child in 0..MAX_CHILDREN {
        let available = (child as u32) < children && (child as u32 != masked || children == 1);
        let weight = exponential(sharpness * (scratch.q[child] - best));
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
