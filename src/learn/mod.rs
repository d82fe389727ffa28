//! LEARN: trials are recorded, then learned from backwards (paper, sections I and V).
//!
//! A lesson is a header (steps, how it ended, reward, collisions) and one record per step, and one more for
//! the observation after the last step. Taught lessons stand in the teacher's bank, experienced ones in the
//! learner's own ring.
//!
//! Twins: `shaders/learn/`.

pub mod lesson;
pub mod td_lambda;
