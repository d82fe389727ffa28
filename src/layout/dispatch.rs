//! What the host asks for.

use bytemuck::{Pod, Zeroable};

shared! {
    /// What the host tells one dispatch.
    struct Dispatch {
        /// Most iterations of each learner, episode or robot.
        iterations: u32,
        /// Learners stop before the first trial beyond this skill and trial.
        stop_skill: u32,
        /// See `stop_skill`.
        stop_trial: u32,
        /// Skills of each learner.
        skills: u32,
        /// Words of one learner's nets.
        nets_stride: u32,
        /// Words of one learner's lessons.
        lessons_stride: u32,
        /// Rows of one learner's trial table.
        rows_stride: u32,
        /// Learners, or robots, in the buffers.
        learners: u32,
        /// Episodes of each learner.
        episodes: u32,
        /// Skill under test.
        test_skill: u32,
        /// Test trials: the counter that keeps the tests' random numbers apart.
        test_number: u32,
        /// First learner of this dispatch.
        first: u32,
    }
}
