//! Learning against what is not the product: plain f64 nets with the standard library's tanh, finite differences, the
//! forward view of TD(lambda), returns computed by hand, exact softmax and exact distributions.

mod choice;
mod gradients;
mod memory;
mod phases;
mod returns;

use super::configs::shipped;
use super::learner::{Learner, lesson_words};
use super::observations::{bit, readings};
use bytemuck::Zeroable;
use skilltree::layout::{LANES, NO_CHILD, Observation, Step};

/// A learning rate so small that no Q-value changes, and a power of two, so that what was learned can be read off.
const HARDLY: f32 = 1.0 / (1_u64 << 60) as f32;
/// All six actions.
const ALL: u32 = 0x3f;

/// One learner of the docking skill.
fn docking(set: &[&str]) -> Learner {
    Learner::new(shipped("configs/docking.toml", &[&["seeds='0'"], set].concat()))
}

/// A step of which children could be chosen freely, as bits.
fn free_step(observation: Observation, child: u32, allowed: u32, reward: f32) -> Step {
    let choice = child | allowed << 8 | allowed << 16 | 1 << 31;
    Step { observation, choice, reward, ..Step::zeroed() }
}

/// A trial to learn from.
#[derive(Debug, Clone)]
struct Trial {
    steps: Vec<Step>,
    last: Observation,
    end: u32,
}

impl Trial {
    /// The steps, and last the observation that closes the trial.
    fn records(&self) -> Vec<Step> {
        [self.steps.as_slice(), &[free_step(self.last, NO_CHILD, ALL, 0.0)]].concat()
    }
}

impl Learner {
    /// Puts a trial both in the bank and in the memory, at word 0.
    fn keep(&mut self, trial: &Trial) {
        let words = lesson_words(&self.shared.skills[0], trial.end, &trial.records());
        self.lessons[..words.len()].copy_from_slice(&words);
        self.shared.bank = words;
    }

    /// Replays the kept trial; the returns of its steps, last first.
    #[track_caller]
    fn replay(&mut self, taught: u32) -> Vec<f32> {
        self.act(|group| {
            group.begin_replay(0, taught, 0);
            let mut returns = Vec::new();
            while group.state.replay_left > 0 || group.state.replay_open == 1 {
                let open = group.state.replay_open == 1;
                group.replay_step();
                if !open {
                    returns.push(group.state.next_return);
                }
            }
            returns
        })
    }

    /// The output bias of a child's net.
    fn bias(&self, child: u32) -> f32 {
        self.nets[self.net(0, child) + self.tensor(0) - LANES]
    }
}

/// The inputs that an observation stands for, from the definition of the coding in the config's documentation.
fn inputs_of(seen: &Observation) -> Vec<f64> {
    let sonar = readings(seen).map(|d| 2.0 * (-(d - 12.0) / 60.0).exp() - 1.0);
    let bits = (0..28).map(|at| bit(seen.light_bumpers, at));
    sonar.into_iter().chain(bits).collect()
}
