//! What a config file says, checked and complete: the [`Plan`].
//!
//! Nothing after the config stage looks at TOML again. Every derived size is computed once, from the
//! plan, by [`crate::layout`].

mod skill;
mod sweep;

pub use crate::layout::{Action, Event, Input, Noise, RegionEvent};
pub use skill::{Child, SkillPlan, Threshold};
pub use sweep::{Axis, AxisValue, Design, Scale, Sweep};

use crate::world::World;
use bytemuck::{Pod, Zeroable};
use serde::{Serialize, Serializer};

/// A whole experiment, ready to run: every default filled in, every name resolved.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The config file's stem, which names the run folder.
    pub name: String,
    /// One line that says what the experiment is for.
    pub title: String,
    /// Key of everything that all learners share: the teacher's bank of lessons and the planner's trials.
    pub run_seed: u32,
    /// One learner per arm and seed. Ascending, without repeats.
    pub seeds: Vec<u32>,
    /// The floor plans that arms and alterations name, each once; the config's own is the first.
    pub worlds: Vec<PlacedWorld>,
    /// The experimental conditions: each arm at each point of the sweep, by arm in the order of the file, then by point.
    pub arms: Vec<ArmPlan>,
    /// What differs between the points of an arm, if anything does.
    pub sweep: Option<Sweep>,
    /// Other circumstances in which the learned roots are tested after their last trial, without training.
    pub alterations: Vec<Alteration>,
    /// When and how learners are tested.
    pub evaluate: Evaluate,
    /// The whole config as resolved TOML: defaults, file and `--set` merged. Reading it gives this plan.
    pub resolved: String,
}

impl Plan {
    /// The config's own floor plan.
    pub fn world(&self) -> &World {
        &self.worlds[0].world
    }

    /// The floor plan in which an arm trains.
    pub fn world_of(&self, arm: &ArmPlan) -> &World {
        &self.worlds[arm.world].world
    }

    /// Whether the arm with this index is an earlier one at its next point.
    pub fn continues(&self, arm: usize) -> bool {
        arm > 0 && self.arms[arm - 1].name == self.arms[arm].name
    }
}

/// A floor plan with the text that it was read from, kept so that a run folder can hold it.
#[derive(Debug, Clone)]
pub struct PlacedWorld {
    /// The floor plan.
    pub world: World,
    /// The file's text.
    pub text: String,
    /// The file's name in a run folder.
    pub file: String,
}

/// One experimental condition: the base config with this arm's changes applied, and over them a point of the sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArmPlan {
    /// Key of the arm in the config, `[a-z0-9-]+`; the same at all points.
    pub name: String,
    /// Index into [`Sweep::points`]; 0 without a sweep.
    pub point: u32,
    /// Index of its floor plan in [`Plan::worlds`].
    pub world: usize,
    /// The skills of the root's tree, children before parents; the last one is the root.
    pub skills: Vec<SkillPlan>,
    /// Sensors and actuators of this arm's robots.
    #[serde(serialize_with = "as_bytes")]
    pub noise: Noise,
    /// The teacher's bank and how it demonstrates.
    #[serde(serialize_with = "as_bytes")]
    pub teacher: TeacherPlan,
}

impl ArmPlan {
    /// Training trials of all skills.
    pub fn trials(&self) -> u64 {
        self.skills.iter().map(|skill| u64::from(skill.params.trials)).sum()
    }

    /// What files call a child of one of the arm's skills.
    pub fn name_of(&self, child: Child) -> &str {
        match child {
            Child::Action(action) => action.name(),
            Child::Skill(below) => &self.skills[below].name,
        }
    }
}

/// Other circumstances for skills that were learned without them (paper, section VII: "could adapt to small
/// unexpected environmental changes without additional training").
#[derive(Debug, Clone, PartialEq)]
pub struct Alteration {
    /// Key in the config.
    pub name: String,
    /// Index of the floor plan in [`Plan::worlds`], or none for each arm's own.
    pub world: Option<usize>,
    /// Noise, or none for each arm's own.
    pub noise: Option<Noise>,
}

/// When and how learners are tested.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluate {
    /// Trials of a skill after which it is tested, unless it names its own; ascending.
    pub at: Vec<u32>,
    /// Greedy test trials each time, the same starts for a learner every time.
    pub episodes: u32,
}

/// The teacher: a privileged planner.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TeacherPlan {
    /// Lessons demonstrated for each skill; learners draw theirs from them.
    pub lessons: u32,
    /// Discount factor of the planner: its own, so that learners with different ones share a teacher.
    pub discount: f32,
    /// Cost, in reward units, that the demonstrator puts on backing up, so that it drives as a person would.
    pub backward_cost: f32,
    /// Cost, in reward units, that it puts on collisions besides what the skill itself pays for them: where nothing is
    /// paid, the planner would else push against walls between which it cannot tell.
    pub collision_cost: f32,
    /// Test trials of the planner itself, which give the bound that reports show.
    pub eval_episodes: u32,
}

/// A record as the bytes that kernels see.
pub(crate) fn as_bytes<S: Serializer>(record: &impl Pod, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(bytemuck::bytes_of(record))
}
