//! What a skill is: its children, its inputs, what pays, what ends it.

use super::Learning;
use crate::layout::{Action, Event, Input};

/// A skill as defined in TOML.
#[derive(Debug, Clone, PartialEq)]
pub struct Skill {
    /// Key of the skill in the config.
    pub name: String,
    /// The net's inputs, in order.
    pub inputs: Vec<Input>,
    /// What the skill chooses among: actions, or skills that stand before it.
    pub children: Vec<Child>,
    /// For each child, from what value on it is applicable; none for a child that always is.
    pub applicable: Vec<Option<Threshold>>,
    /// How a child is chosen.
    pub choice: Choice,
    /// Keeping to the chosen child.
    pub persistence: Persistence,
    /// Index of the skill whose nets this one uses as their mirror image; it has no trials of its own.
    pub mirror: Option<usize>,
    /// Whether the planner, which knows floor plan and pose, stands in for the nets. Privileged.
    pub planned: bool,
    /// Amount paid for each event, in the order of [`Event::ALL`].
    pub reward: [f32; Event::ALL.len()],
    /// Where training trials start: regions of the world and the share of trials that start there (shares sum to 1).
    pub starts: Vec<(String, f32)>,
    /// Region in which tests start.
    pub tests: String,
    /// Trials after which the skill is tested, ascending; it also is after its last one.
    pub tested_at: Vec<u32>,
    /// Bits of the events (see [`Event::bit`]) that end a trial as achieved.
    pub ends: u32,
    /// Primitive steps after which a trial is cut, 1 to 255.
    pub max_steps: u32,
    /// Taught lessons given before the first trial.
    pub lessons: u32,
    /// Training trials.
    pub trials: u32,
    /// How the skill is learned.
    pub learning: Learning,
}

impl Skill {
    /// Whether the children are skills.
    pub fn is_high(&self) -> bool {
        self.children.iter().any(|child| matches!(child, Child::Skill(_)))
    }

    /// Children that have an applicability threshold.
    pub fn thresholds(&self) -> u32 {
        self.applicable.iter().flatten().count() as u32
    }

    /// The actions below it: its own, or all for one that chooses among skills.
    pub fn actions(&self) -> Vec<Action> {
        let own = self.children.iter().filter_map(|child| match child {
            Child::Action(action) => Some(*action),
            Child::Skill(_) => None,
        });
        if self.is_high() { Action::ALL.to_vec() } else { own.collect() }
    }

    /// Inputs that a group takes in a net of this skill, in a world of so many rooms.
    pub fn width_of(&self, input: Input, rooms: usize) -> u32 {
        input.width(self.thresholds(), self.children.len() as u32, rooms as u32)
    }

    /// Inputs of each net in a world of so many rooms.
    pub fn width(&self, rooms: usize) -> u32 {
        self.inputs.iter().map(|input| self.width_of(*input, rooms)).sum()
    }
}

/// What a skill can choose: nothing else tells elementary from high-level skills.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Child {
    /// A primitive action.
    Action(Action),
    /// The skill at this index of the arm's skills.
    Skill(usize),
}

impl Child {
    /// What a mirror shows of it: a turn the other way.
    pub fn mirrored(self) -> Self {
        match self {
            Self::Action(action) => Self::Action(action.mirrored()),
            same => same,
        }
    }
}

/// From which value of its best child on a skill is applicable (paper, section VI.B).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// Set by hand, in units of Q (reward / `reward_scale`).
    Fixed(f32),
    /// Learned from the skill's own training trials: the value at which success has this probability.
    Learned(f32),
}

/// How a skill's child is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Choice {
    /// By the learned Q-values.
    Learned = 0,
    /// Uniformly at random among those allowed. A baseline.
    Random = 1,
    /// The first allowed one, in the order of `children`: fixed arbitration. A baseline.
    Ordered = 2,
}

/// The Persistence Rule (paper, section VI.B) and our additions to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Persistence {
    /// Whether it holds in training.
    pub training: bool,
    /// Whether it holds in tests too.
    pub tests: bool,
    /// Whether applicability limits the choice.
    pub applicability: bool,
    /// Whether a running child that stops being applicable may be left. Ours.
    pub interrupt: bool,
    /// Steps without any event after which the choice is open again, 0 for never. Ours.
    pub decision_steps: u32,
}
