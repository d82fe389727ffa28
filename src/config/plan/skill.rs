//! What a skill is: its children, its inputs, what pays, what ends it.

use crate::layout::{Action, HyperParams, Input};
use serde::Serialize;

/// A skill as defined in TOML.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SkillPlan {
    /// Key of the skill in the config.
    pub name: String,
    /// The net's inputs, in order.
    pub inputs: Vec<Input>,
    /// What the skill chooses among: actions, or skills that stand before it.
    pub children: Vec<Child>,
    /// For each child, from what value on it is applicable; none for a child that always is.
    pub applicable: Vec<Option<Threshold>>,
    /// Index of the skill whose nets this one uses as their mirror image; it has no trials of its own.
    pub mirror: Option<usize>,
    /// Whether the planner, which knows floor plan and pose, stands in for the nets. Privileged.
    pub oracle: bool,
    /// Where training trials start: regions of the world and the share of trials that start there (shares sum to 1).
    pub starts: Vec<(String, f32)>,
    /// Region in which tests start.
    pub eval_starts: String,
    /// Trials after which the skill is tested, ascending; it also is after its last one.
    pub eval_at: Vec<u32>,
    /// Bits of the events (see [`crate::layout::Event::bit`]) that end a trial as achieved.
    pub goal: u32,
    /// Regions whose events the reward and the goal name; their places are those of [`RegionEvent::number`].
    ///
    /// [`RegionEvent::number`]: crate::layout::RegionEvent::number
    pub regions: Vec<String>,
    /// Every number with which it is learned and carried out; all but the seeds, which each learner has of its own.
    #[serde(serialize_with = "super::as_bytes")]
    pub params: HyperParams,
}

impl SkillPlan {
    /// Whether the children are skills.
    pub fn is_high(&self) -> bool {
        self.children.iter().any(|child| matches!(child, Child::Skill(_)))
    }

    /// Numbers of trials after which it is tested, ascending.
    pub fn test_points(&self) -> impl Iterator<Item = u32> {
        let trials = self.params.trials;
        self.eval_at.iter().copied().filter(move |at| *at < trials).chain([trials])
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Threshold {
    /// Set by hand, in units of Q (reward / `reward_scale`).
    Fixed(f32),
    /// Learned from the skill's own training trials: the value at which success has this probability.
    Learned(f32),
}
