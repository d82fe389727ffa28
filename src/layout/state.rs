//! What changes while robots act and learn.

use super::params::Noise;
use super::records::Observation;
use super::sizes::MAX_SKILLS;
use bytemuck::{Pod, Zeroable};

shared! {
    /// A body after an action.
    struct Moved {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers: 1 front, 2 left, 4 back, 8 right.
        bumpers: u32,
        /// What happened: `DOCKED`, `COLLISION`.
        events: u32,
    }

    /// What the Q-values say about the allowed children.
    struct Boltzmann {
        /// Greatest Q-value.
        best: f32,
        /// The child that has it; the first of several.
        greedy: u32,
        /// Sum of the workgroup's `weights`.
        total: f32,
    }

    /// A robot in a trial: its body, what it remembers, and what it is doing.
    struct Agent {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Before the last action, inches.
        before_x: f32,
        /// Before the last action, inches.
        before_y: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Steps of the trial taken.
        step: u32,
        /// Room that it was in when the trial began or a door was last passed.
        origin: u32,
        /// Action not available on the next step, or `NO_ACTION`.
        blocked: u32,
        /// 1 where the skill that acts does not repeat what was blocked.
        masks: u32,
        /// Last action, or `NO_ACTION`.
        action: u32,
        /// Events of the last action, without those of regions: which these are depends on the skill.
        events: u32,
        /// Reward of the last action.
        earned: f32,
        /// Reward of the trial so far.
        reward: f32,
        /// Discounted reward of the trial so far.
        returned: f32,
        /// Discount of the next reward.
        discount: f32,
        /// Collisions of the trial so far.
        collisions: u32,
        /// Running mean of the ranges east and west, -1 to 1.
        east_west: f32,
        /// Running mean of the ranges north and south, -1 to 1.
        north_south: f32,
        /// Trace of having seen the light.
        light: f32,
        /// Trace of having passed a door.
        door: f32,
        /// The same times the cosine of the compass at the door.
        door_cosine: f32,
        /// The same times its sine.
        door_sine: f32,
        /// Of each skill: the child that runs (`NO_CHILD` where none does), from bit 8 the steps since it was
        /// chosen, from bit 16 the children that were applicable.
        run: [u32; MAX_SKILLS],
    }

    /// Where a learner stands: all that changes from one iteration to the next, but nets and lessons.
    struct LearnerState {
        /// One of the `PHASE` codes.
        phase: u32,
        /// Skill in training.
        skill: u32,
        /// Trials of it finished.
        trial: u32,
        /// Primitive actions executed so far, taught ones included.
        actions: u32,
        /// Lessons remembered so far, forgotten ones included.
        remembered: u32,
        /// Replays of this phase begun so far.
        replay: u32,
        /// 1 where the lesson in replay is a taught one.
        replay_taught: u32,
        /// 1 where it is seen in a mirror.
        replay_mirrored: u32,
        /// Word of the bank or of the memory at which the lesson in replay stands.
        replay_lesson: u32,
        /// Steps of the lesson in replay that are still to be learned; 0 where none is.
        replay_left: u32,
        /// Greatest Q-value after the step to be learned.
        next_best: f32,
        /// Return after the step to be learned.
        next_return: f32,
        /// Rows of the trial table written.
        rows: u32,
        /// Transitions learned from so far.
        updates: u32,
        /// 1 where the observation that ends the lesson in replay is still to be valued.
        replay_open: u32,
        /// The robot in its trial.
        agent: Agent,
    }

    /// A test trial.
    struct Episode {
        /// 0 not begun, 1 running, 2 achieved, 3 cut.
        state: u32,
        /// Where it began, inches.
        start_x: f32,
        /// Where it began, inches.
        start_y: f32,
        /// The robot.
        agent: Agent,
    }

    /// A robot under given actions.
    struct Robot {
        /// Inches.
        x: f32,
        /// Inches.
        y: f32,
        /// Degrees.
        heading: f32,
        /// Touching bumpers.
        bumpers: u32,
        /// Action to carry out, or `NO_ACTION` to sense only.
        action: u32,
        /// Events of the action.
        events: u32,
        /// Steps taken, which picks the random numbers.
        step: u32,
        /// Key shared by the run.
        run_seed: u32,
        /// Key of the robot.
        robot_seed: u32,
        /// Noise of its actuators and sensors.
        noise: Noise,
        /// What it senses after the action.
        sensed: Observation,
    }
}
