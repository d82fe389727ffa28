//! Every number that an arm or a sweep can vary.

use super::events::EVENTS;
use super::sizes::MAX_CHILDREN;
use bytemuck::{Pod, Zeroable};

shared! {
    /// Noise of a robot.
    struct Noise {
        /// Distribution of every term: 0 bell, 1 flat.
        kind: u32,
        /// Relative, turns and travel.
        actuator: f32,
        /// Relative, sonar ranges.
        sonar: f32,
        /// Relative, brightness.
        light: f32,
        /// Degrees, compass.
        compass: f32,
    }

    /// How one learner learns one skill: every number that an arm or a sweep can vary.
    struct HyperParams {
        /// Key shared by the run.
        run_seed: u32,
        /// Key of the learner.
        learner_seed: u32,
        /// Noise of the robot.
        noise: Noise,
        /// Hidden units in use.
        hidden: u32,
        /// 1 / `hidden`.
        unit_share: f32,
        /// Initial weights lie in plus or minus this.
        init: f32,
        /// Discount factor.
        gamma: f32,
        /// Share of the observed return in the target.
        lambda: f32,
        /// 0 gradient descent with momentum, 1 Adam, 2 Adam with one second moment for each row of weights.
        optimiser: u32,
        /// Learning rate at the first trial.
        rate: f32,
        /// Share of it that each trial takes away.
        rate_fall: f32,
        /// Trials over which it falls.
        rate_trials: u32,
        /// Momentum, or Adam's decay of the mean gradient.
        beta1: f32,
        /// Adam's decay of the mean squared gradient.
        beta2: f32,
        /// Square of Adam's epsilon, added under the root.
        epsilon2: f32,
        /// 1 / the reward that is learned as Q = 1.
        value_scale: f32,
        /// Targets are clipped to plus or minus this.
        target_limit: f32,
        /// Inverse temperature at the first trial.
        inverse_temperature_start: f32,
        /// Its rise per trial.
        inverse_temperature_slope: f32,
        /// Trials over which it rises.
        inverse_temperature_trials: u32,
        /// Least probability of a policy action.
        policy_threshold: f32,
        /// Remembered lessons replayed after each trial.
        replays: u32,
        /// Lessons remembered.
        memory: u32,
        /// Mean age of replayed lessons.
        mean_age: f32,
        /// -1 / `mean_age`.
        age_decay: f32,
        /// Passes over each taught lesson before the first trial.
        taught_passes: u32,
        /// Taught lessons replayed after each trial.
        taught_replays: u32,
        /// 1 where taught steps are policy actions whatever their probability.
        taught_always: u32,
        /// 1 where the step limit ends a trial with value 0.
        timeout_terminal: u32,
        /// 1 where a blocked action is not available on the next step.
        mask_blocked: u32,
        /// 1 where half of the replayed lessons are seen in a mirror.
        mirror_replays: u32,
        /// Taught lessons given.
        lessons: u32,
        /// Training trials.
        trials: u32,
        /// Step limit of a trial.
        max_steps: u32,
        /// 0 by the learned values, 1 at random, 2 the first allowed.
        choice: u32,
        /// 1 where the chosen child is kept in training.
        persist_training: u32,
        /// 1 where it is kept in tests.
        persist_tests: u32,
        /// 1 where only applicable children are chosen.
        applicability: u32,
        /// 1 where a running child that is no longer applicable may be left.
        interrupt: u32,
        /// Steps after which the choice is open again, 0 for never.
        decision_steps: u32,
        /// Inverse temperature of the skills below this one.
        child_inverse_temperature: f32,
        /// What is learned from: 0 all steps, 1 all steps as persistence allows, 2 decisions.
        backup: u32,
        /// Factor on the distance of targets from the greatest value.
        advantage_scale: f32,
        /// Share of the steps between decisions that are learned from too.
        inner_share: f32,
        /// What each step leaves of the trace of light.
        light_trace: f32,
        /// What each step leaves of the trace of a door.
        door_trace: f32,
        /// Weight of the past in the means of ranges.
        range_mean: f32,
        /// Least reading beside a wall, inches.
        beside_near: u32,
        /// Greatest reading beside a wall, inches.
        beside_far: u32,
        /// Value above which each child is applicable; `ALWAYS` where it always is.
        threshold: [f32; MAX_CHILDREN],
        /// Amount paid for each event.
        reward: [f32; EVENTS],
    }
}
