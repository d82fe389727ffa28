//! Every number that an arm or a sweep can vary: a row each.
//!
//! A row makes the field of the learner's record in Rust and in WGSL, the key of the config that sets it, what its reader
//! accepts, its default, and its page of the reference. A field without a key is set by the config stage otherwise, or
//! computed from the others by [`HyperParams::derive`].

use super::choices::{BACKUPS, NOISE_KINDS, OPTIMISER_SGD, OPTIMISERS, POLICIES};
use super::events::SKILL_EVENTS;
use super::schema::Allowed::{self, Choice, Flag, Number, Whole};
use super::schema::{Bounds, DefaultSource, KeyRow};
use super::sizes::MAX_CHILDREN;
use bytemuck::{Pod, Zeroable};

/// Most trials of a skill and most lessons of a teacher: keeps a learner's tables small.
pub const MAX_TRIALS: u32 = 100_000;
/// Threshold of a child that is always applicable.
pub const ALWAYS: f32 = -2.0;

const SHARE: Allowed = Number(Bounds::between(0.0, 1.0));
const RELATIVE: Allowed = Number(Bounds::between(0.0, 0.5));
const DECAY: Allowed = Number(Bounds::below(0.0, 1.0));
const POSITIVE: Allowed = Number(Bounds::above(0.0, 10.0));
const INVERSE_TEMPERATURE: Allowed = Number(Bounds::between(0.0, 10_000.0));
/// Sonar readings are whole inches up to this.
const READING: Allowed = Whole(0, 127);

/// A field that a key of the config sets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParamRow {
    /// The key.
    pub key: KeyRow,
    /// Word of its struct at which the field stands. A number is stored as f32, anything else as u32: a whole number,
    /// 0 or 1, the place of a word among its choices.
    pub word: usize,
}

macro_rules! params {
    ($($(#[$doc:meta])* struct $name:ident { $(
        $(#[doc = $field_doc:literal])+
        $field:ident: $kind:tt $(= $path:literal, $default:literal, $allowed:expr, $source:ident)?;
    )* })*) => {
        shared! { $($(#[$doc])* struct $name { $($(#[doc = $field_doc])+ $field: $kind,)* })* }
        $(impl $name {
            const FIELDS: &[Option<ParamRow>] = &[$(
                params!(@row $name $field ($($field_doc)+) $($path, $default, $allowed, $source)?)
            ),*];

            /// The fields that keys of the config set.
            pub fn rows() -> impl Iterator<Item = &'static ParamRow> {
                Self::FIELDS.iter().flatten()
            }
        })*
    };
    (@row $name:ident $field:ident ($($doc:literal)+)) => { None };
    (@row $name:ident $field:ident ($($doc:literal)+)
        $path:literal, $default:literal, $allowed:expr, $source:ident) => {
        Some(ParamRow {
            key: KeyRow {
                path: $path,
                default: Some($default),
                allowed: $allowed,
                source: DefaultSource::$source,
                doc: concat!($($doc),+),
            },
            word: std::mem::offset_of!($name, $field) / 4,
        })
    };
}

params! {
    /// Noise of a robot's actuators and sensors. Amounts of 0 switch a term off.
    struct Noise {
        /// Whether amounts are standard deviations or half-widths.
        kind: u32 = "robot.noise.kind", "'gaussian'", Choice(NOISE_KINDS), Ours;
        /// Share of each turn and travel.
        actuator: f32 = "robot.noise.actuator", "0.08", RELATIVE, Paper;
        /// Share of each sonar range.
        sonar: f32 = "robot.noise.sonar", "0.10", RELATIVE, Paper;
        /// Share of each light intensity, before the threshold.
        light: f32 = "robot.noise.light", "0.10", RELATIVE, Paper;
        /// Degrees on the compass; the default is 0.05 rad.
        compass: f32 = "robot.noise.compass", "2.865", Number(Bounds::between(0.0, 180.0)), Ours;
    }

    /// How one learner learns one skill: every number that an arm or a sweep can vary.
    struct HyperParams {
        /// Key shared by the run.
        run_seed: u32;
        /// Key of the learner.
        learner_seed: u32;
        /// Noise of the robot.
        noise: Noise;
        /// What is left, after each step, of the trace of having seen the light.
        light_decay: f32 = "robot.memory.light_decay", "0.97", DECAY, Ours;
        /// What is left, after each step, of the trace of having passed a door.
        door_decay: f32 = "robot.memory.door_decay", "0.97", DECAY, Ours;
        /// Weight of the past in the running means of ranges.
        range_decay: f32 = "robot.memory.range_decay", "0.9", DECAY, Ours;
        /// Least sonar reading, in whole inches, at which the nearest thing on one side counts as a wall followed.
        beside_near: u32 = "robot.beside.near", "15", READING, Ours;
        /// Greatest such reading, in whole inches; more than near.
        beside_far: u32 = "robot.beside.far", "30", READING, Ours;
        /// Hidden units of each net; one net per child.
        hidden: u32 = "learning.hidden", "32", Whole(1, 32), Ours;
        /// 1 / `hidden`.
        unit_share: f32;
        /// Initial weights are uniform in plus or minus this.
        init_range: f32 = "learning.init_range", "0.2", POSITIVE, Ours;
        /// Discount factor.
        gamma: f32 = "learning.gamma", "0.9", SHARE, Ours;
        /// 0 learns from the next value alone (TD(0)), 1 from the observed return.
        lambda: f32 = "learning.lambda", "0.95", SHARE, Ours;
        /// Weight update rule; adam-rows keeps one second moment for all weights of an input (after Adam-mini).
        optimiser: u32 = "learning.optimiser", "'adam'", Choice(OPTIMISERS), Ours;
        /// Learning rate at the first trial; the default is for adam, sgd has none.
        learning_rate: f32 = "learning.learning_rate", "0.0015", POSITIVE, Ours;
        /// Share of the learning rate that is left at the end of its schedule, 1 for a constant rate.
        learning_rate_end_share: f32 = "learning.learning_rate_end_share", "0.1", SHARE, Ours;
        /// Trials over which the learning rate falls linearly to that share.
        learning_rate_trials: u32 = "learning.learning_rate_trials", "300", Whole(1, MAX_TRIALS), Ours;
        /// Share of the learning rate that each of these trials takes away.
        learning_rate_fall: f32;
        /// Momentum of sgd, 0 for none.
        momentum: f32 = "learning.momentum", "0.0", DECAY, Ours;
        /// Decay of adam's mean gradient. Of sgd it is the momentum.
        beta1: f32 = "learning.beta1", "0.9", DECAY, Ours;
        /// Decay of adam's mean squared gradient.
        beta2: f32 = "learning.beta2", "0.999", DECAY, Ours;
        /// Added to the root of adam's mean squared gradient.
        epsilon: f32 = "learning.epsilon", "1e-3", Number(Bounds::between(1e-12, 1.0)), Ours;
        /// Square of `epsilon`, added under the root.
        epsilon2: f32;
        /// A reward of this size is learned as Q = 1.
        reward_scale: f32 = "learning.reward_scale", "100.0", Number(Bounds::between(1e-3, 1e6)), Ours;
        /// 1 / `reward_scale`.
        value_scale: f32;
        /// Targets are clipped to plus or minus this, inside the net's output range.
        target_clip: f32 = "learning.target_clip", "0.99", Number(Bounds::inside(0.0, 1.0)), Ours;
        /// 1/T of action choice at the first trial, per Q / reward_scale.
        inverse_temperature_start: f32 = "learning.inverse_temperature_start", "20.0", INVERSE_TEMPERATURE, Ours;
        /// 1/T at the end of the schedule.
        inverse_temperature_end: f32 = "learning.inverse_temperature_end", "120.0", INVERSE_TEMPERATURE, Ours;
        /// Trials over which 1/T rises linearly.
        inverse_temperature_trials: u32 = "learning.inverse_temperature_trials", "150", Whole(0, MAX_TRIALS), Ours;
        /// Rise of 1/T per trial.
        inverse_temperature_slope: f32;
        /// A replayed step is learned only if its action's current probability exceeds this.
        policy_threshold: f32 = "learning.policy_threshold", "0.05", DECAY, Ours;
        /// Lessons replayed after each trial.
        replays: u32 = "learning.replays", "60", Whole(0, 10_000), Ours;
        /// Latest lessons that are kept for replay.
        replay_capacity: u32 = "learning.replay_capacity", "300", Whole(1, 10_000), Ours;
        /// Mean age, in lessons, of the replayed ones (exponential recency).
        replay_mean_age: f32 = "learning.replay_mean_age", "100.0", Number(Bounds::between(0.1, 1e6)), Ours;
        /// -1 / `replay_mean_age`.
        replay_age_decay: f32;
        /// Passes over each taught lesson before the first trial.
        pretrain_epochs: u32 = "learning.pretrain_epochs", "20", Whole(0, 1000), Ours;
        /// Taught lessons replayed after each trial.
        taught_replays: u32 = "learning.taught_replays", "3", Whole(0, 1000), Ours;
        /// Taught steps count as policy actions: they are learned whatever their action's probability.
        taught_as_policy: u32 = "learning.taught_as_policy", "true", Flag, Ours;
        /// A trial cut at the step limit ends with value 0 (true), or with its last observation's value (false).
        timeout_terminal: u32 = "learning.timeout_terminal", "true", Flag, Ours;
        /// Half of the replayed lessons are seen in a mirror: left and right exchanged.
        mirror_replays: u32 = "learning.mirror_replays", "false", Flag, Ours;
        /// An action that was just blocked is not available on the next step.
        mask_blocked: u32 = "learning.mask_blocked", "true", Flag, Ours;
        /// One net with an output per child, instead of a net per child.
        shared_net: u32 = "learning.shared_net", "false", Flag, Ours;
        /// How a skill over skills learns from a trial: from every step, over all applicable children (the paper read
        /// literally); from every step, over those that persistence would allow; or at decisions only (semi-Markov).
        backup: u32 = "learning.backup", "'decisions'", Choice(BACKUPS), Ours;
        /// Targets are moved this many times as far from the greatest Q-value; 1 leaves them.
        advantage_scale: f32 = "learning.advantage_scale", "1.0", Number(Bounds::between(1.0, 1000.0)), Ours;
        /// Share of the steps between decisions that the backup `decisions` learns from too.
        intra_skill_share: f32 = "learning.intra_skill_share", "0.1", SHARE, Ours;
        /// 1/T at which the children, and theirs, choose while this skill is being learned or tested.
        child_inverse_temperature: f32 = "learning.child_inverse_temperature", "60.0", INVERSE_TEMPERATURE, Ours;
        /// A child is chosen by the learned Q-values, at random, or as the first one allowed.
        policy: u32 = "skill.*.policy", "'learned'", Choice(POLICIES), Paper;
        /// 1 where the chosen child is kept to in training.
        persist_training: u32;
        /// 1 where it is kept to in tests.
        persist_tests: u32;
        /// Only applicable children are chosen.
        applicability: u32 = "skill.*.applicability", "true", Flag, Paper;
        /// A running child that stops being applicable may be left.
        interrupt: u32 = "skill.*.interrupt", "true", Flag, Ours;
        /// Steps after which a running child may be left though nothing has ended it, 0 for never.
        child_timeout: u32 = "skill.*.child_timeout", "30", Whole(0, 255), Ours;
        /// Primitive steps after which a trial is cut; 30 is the paper's for docking.
        max_steps: u32 = "skill.*.max_steps", "30", Whole(1, 255), Paper;
        /// Taught lessons before the first trial; skills over skills have none.
        lessons: u32 = "skill.*.lessons", "0", Whole(0, 10_000), Ours;
        /// Training trials; 300 is the paper's for docking.
        trials: u32 = "skill.*.trials", "300", Whole(0, MAX_TRIALS), Paper;
        /// Value above which each child is applicable; `ALWAYS` where it always is.
        threshold: [f32; MAX_CHILDREN];
        /// Amount paid for each event.
        reward: [f32; SKILL_EVENTS];
    }
}

impl HyperParams {
    /// Computes the numbers that follow from those that keys set. Of two learners that learn alike, all are equal.
    pub fn derive(&mut self) {
        if self.optimiser == OPTIMISER_SGD {
            (self.beta1, self.beta2, self.epsilon) = (self.momentum, 0.0, 1.0);
        }
        self.momentum = 0.0;
        self.unit_share = 1.0 / self.hidden as f32;
        self.learning_rate_fall = (1.0 - self.learning_rate_end_share) / self.learning_rate_trials as f32;
        self.epsilon2 = self.epsilon * self.epsilon;
        self.value_scale = 1.0 / self.reward_scale;
        let rise = self.inverse_temperature_end - self.inverse_temperature_start;
        self.inverse_temperature_slope = rise / self.inverse_temperature_trials.max(1) as f32;
        self.replay_age_decay = -1.0 / self.replay_mean_age;
    }
}
