//! What is recorded of trials. In a learner's lessons these records stand word by word, so that elementary skills can
//! leave out the second half of a step; the shaders are given the words' numbers, such as `STEP_REWARD`.

use super::sizes::{MAX_CHILDREN, SONAR_WORDS};
use bytemuck::{Pod, Zeroable};

shared! {
    /// One reading of all sensors.
    struct Observation {
        /// Sonar readings, whole inches, a byte each: bearing 0 straight ahead, then counter-clockwise.
        sonar: [u32; SONAR_WORDS],
        /// Bits of the bearings that are lit, and from bit `BUMPERS_FROM` on of the bumpers that touch something.
        light_bumpers: u32,
        /// Degrees.
        compass: f32,
    }

    /// One step of a trial: what was sensed, what was chosen, what that earned. Skills over skills, and those whose
    /// inputs stand there, record all of it; others what stands before `high_level`.
    struct Step {
        /// What was sensed before the action.
        observation: Observation,
        /// Child, masks and events, packed (see `learn/lesson`).
        choice: u32,
        /// Reward of the action.
        reward: f32,
        /// Running child, applicable children and room, packed (see `policy/applicability`).
        high_level: u32,
        /// Running mean of the ranges east and west, -1 to 1.
        east_west: f32,
        /// Running mean of the ranges north and south, -1 to 1.
        north_south: f32,
        /// Trace of having seen the light, 0 to 1.
        light_trace: f32,
        /// Trace of having passed a door, 0 to 1.
        door_trace: f32,
        /// The same times the cosine of the compass at the door.
        door_cosine: f32,
        /// The same times its sine.
        door_sine: f32,
        /// Q-value of the best grandchild below each child that has a threshold, 0 for the others.
        value: [f32; MAX_CHILDREN],
    }

    /// What opens a lesson.
    struct LessonHeader {
        /// Steps of the trial.
        steps: u32,
        /// How it ended: `TERMINATED` or `TRUNCATED`.
        end: u32,
        /// Sum of its rewards.
        reward: f32,
        /// Moves that were blocked.
        collisions: u32,
    }

    /// A row of the trial table.
    struct TrialRecord {
        /// Number of the skill.
        skill: u32,
        /// Number of the trial, or of the taught lesson.
        trial: u32,
        /// Primitive actions that the learner had executed when it ended.
        actions: u32,
        /// Steps of the trial.
        steps: u32,
        /// Sum of its rewards.
        reward: f32,
        /// 1 where the goal was achieved.
        success: u32,
        /// Moves that were blocked.
        collisions: u32,
        /// 1 for a taught lesson.
        taught: u32,
    }
}

constants! {
    /// Words of a recorded step of a skill over actions.
    ELEMENTARY_STEP_WORDS = std::mem::offset_of!(Step, high_level) / 4;
    /// Words of a recorded step of a skill over skills.
    STEP_WORDS = size_of::<Step>() / 4;
    /// Words that open a lesson.
    LESSON_HEADER_WORDS = size_of::<LessonHeader>() / 4;
    /// Words of a row of the trial table.
    TRIAL_WORDS = size_of::<TrialRecord>() / 4;
}

/// Structs whose words the shaders reach by number, and what opens those words' names.
pub(super) const WORDS: [(&str, &str); 3] =
    [("Observation", "OBSERVATION"), ("Step", "STEP"), ("LessonHeader", "LESSON")];
