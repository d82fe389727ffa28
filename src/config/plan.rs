//! What a config file says, checked and complete: the [`Plan`].
//!
//! Nothing after the config stage looks at TOML again. Every derived size is computed once, from the
//! plan, by [`crate::layout`].

mod skill;
mod sweep;

pub use crate::layout::{Action, Event, Input};
pub use skill::{Child, Choice, Persistence, Skill, Threshold};
pub use sweep::{Axis, AxisValue, Design, Scale, Sweep};

use crate::world::World;
use std::path::PathBuf;

/// A whole experiment, ready to run: every default filled in, every name resolved.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The config file's stem, which names the run folder.
    pub name: String,
    /// Where the config file lies.
    pub source: PathBuf,
    /// One line that says what the experiment is for.
    pub title: String,
    /// Key of everything that all learners share: the teacher's bank of lessons and the planner's trials.
    pub run_seed: u32,
    /// One learner per arm and seed. Ascending, without repeats.
    pub seeds: Vec<u32>,
    /// The floor plans that arms and alterations name, each once; the config's own is the first.
    pub worlds: Vec<PlacedWorld>,
    /// The experimental conditions: each arm at each point of the sweep, by arm in the order of the file, then by point.
    pub arms: Vec<Arm>,
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
    pub fn world_of(&self, arm: &Arm) -> &World {
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
#[derive(Debug, Clone, PartialEq)]
pub struct Arm {
    /// Key of the arm in the config, `[a-z0-9-]+`; the same at all points.
    pub name: String,
    /// Index into [`Sweep::points`]; 0 without a sweep.
    pub point: u32,
    /// Index of its floor plan in [`Plan::worlds`].
    pub world: usize,
    /// The skills of the root's tree, children before parents; the last one is the root.
    pub skills: Vec<Skill>,
    /// Sensors and actuators of this arm's robots.
    pub noise: Noise,
    /// What its robots remember within a trial, and the band beside a wall.
    pub robot: Robot,
    /// The teacher's bank and how it demonstrates.
    pub teacher: Teacher,
}

impl Arm {
    /// What files call a child of one of the arm's skills.
    pub fn name_of(&self, child: Child) -> &str {
        match child {
            Child::Action(action) => action.name(),
            Child::Skill(below) => &self.skills[below].name,
        }
    }
}

/// What the robots of an arm remember within a trial, and what counts as beside a wall. All ours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot {
    /// What is left, after each step, of the trace of having seen the light.
    pub light_trace: f32,
    /// The same of having passed a door.
    pub door_trace: f32,
    /// Weight of the past in the running means of ranges, 0 to below 1.
    pub range_mean: f32,
    /// Least reading, inches, at which the nearest thing on one side counts as a wall followed.
    pub beside_near: f32,
    /// Greatest such reading, inches.
    pub beside_far: f32,
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

/// How a skill is learned. All numbers are per-learner data: arms and sweep points differ in them at no cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Learning {
    /// Hidden units of each net, 1 to 32.
    pub hidden: u32,
    /// Initial weights are uniform in plus or minus this.
    pub init: f32,
    /// Discount factor.
    pub gamma: f32,
    /// Mixing of the replayed return: 0 is TD(0), 1 the observed return.
    pub lambda: f32,
    /// The optimiser and its rates.
    pub optimiser: Optimiser,
    /// Share of the learning rate that is left at the end of its schedule, 1 for a constant rate.
    pub rate_end_share: f32,
    /// Trials over which the rate falls linearly to that share.
    pub rate_trials: u32,
    /// Reward of this size is learned as Q = 1.
    pub reward_scale: f32,
    /// Targets are clipped to plus or minus this, inside the bounded output's range.
    pub target_limit: f32,
    /// Inverse temperature at the first trial, in units of 1 / (Q / reward_scale).
    pub inverse_temperature_start: f32,
    /// Inverse temperature at the end of the schedule.
    pub inverse_temperature_end: f32,
    /// Trials over which it rises linearly.
    pub inverse_temperature_trials: u32,
    /// A replayed step is learned only if its action's current probability exceeds this.
    pub policy_threshold: f32,
    /// Lessons replayed after each trial.
    pub replays: u32,
    /// Latest lessons that are kept.
    pub memory: u32,
    /// Mean age, in lessons, of the replayed ones (exponential recency).
    pub mean_age: f32,
    /// Passes over each taught lesson before the first trial.
    pub taught_passes: u32,
    /// Taught lessons replayed after each trial.
    pub taught_replays: u32,
    /// Taught steps count as policy actions whatever their probability.
    pub taught_always: bool,
    /// A trial cut at the step limit ends with value 0 (true), or with the value of its last observation (false).
    pub timeout_terminal: bool,
    /// Half of the replayed lessons are seen in a mirror: what is right of the robot on its left, turns reversed.
    pub mirror_replays: bool,
    /// An action that was just blocked is not available on the next step.
    pub mask_blocked: bool,
    /// One net with an output per child, instead of a net per child.
    pub shared_net: bool,
    /// Which steps are learned from, and over which children the best next value is taken.
    pub backup: Backup,
    /// Targets are moved this many times as far from the greatest Q-value; 1 leaves them.
    pub advantage_scale: f32,
    /// Share of the steps between decisions that [`Backup::Decisions`] learns from too.
    pub inner_share: f32,
    /// Inverse temperature at which the children, and theirs, choose while this skill is being learned or tested.
    pub child_inverse_temperature: f32,
}

/// How a skill over skills is learned from a recorded trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Backup {
    /// From every primitive step, the best next value over all applicable children: the literal reading of the paper.
    Steps = 0,
    /// From every primitive step, the best next value over the children that persistence would allow.
    Persistent = 1,
    /// At decisions only, semi-Markov; lambda mixes there.
    Decisions = 2,
}

/// Weight update rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Optimiser {
    /// Stochastic gradient descent with momentum.
    Sgd {
        /// Learning rate.
        rate: f32,
        /// Momentum, 0 for none.
        momentum: f32,
    },
    /// Adam with bias correction.
    Adam {
        /// Whether the weights of one input share one second moment (after Adam-mini) instead of having one each.
        rows: bool,
        /// Learning rate.
        rate: f32,
        /// Decay of the mean gradient.
        beta1: f32,
        /// Decay of the mean squared gradient.
        beta2: f32,
        /// Added to the root of the mean squared gradient.
        epsilon: f32,
    },
}

/// Distribution of a noise term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum NoiseKind {
    /// The amount is a standard deviation (four 16-bit uniforms summed; nothing beyond 3.46 deviations).
    Gaussian = 0,
    /// The amount is the half-width.
    Uniform = 1,
}

/// Noise of one arm's robots. Amounts of 0 switch a term off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Shape of every term.
    pub kind: NoiseKind,
    /// Relative, on each turn and travel.
    pub actuator: f32,
    /// Relative, on each sonar range.
    pub sonar: f32,
    /// Relative, on each light intensity before the threshold.
    pub light: f32,
    /// In degrees, on the compass.
    pub compass: f32,
}

impl From<Noise> for crate::layout::Noise {
    fn from(noise: Noise) -> Self {
        let Noise { kind, actuator, sonar, light, compass } = noise;
        Self { kind: kind as u32, actuator, sonar, light, compass }
    }
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Teacher {
    /// Lessons in the bank of each skill; learners draw theirs from it.
    pub bank: u32,
    /// Discount factor of the planner: its own, so that learners with different ones share a teacher.
    pub discount: f32,
    /// Cost, in reward units, that the demonstrator puts on backing up, so that it drives as a person would.
    pub backward_cost: f32,
    /// Cost, in reward units, that it puts on collisions besides what the skill itself pays for them: where nothing is
    /// paid, the planner would else push against walls between which it cannot tell.
    pub collision_cost: f32,
    /// Test trials of the planner itself, which give the bound that reports show.
    pub episodes: u32,
}
