//! What one learner leaves behind, and its bytes in a committed part of a run folder.

use super::batch_group::LearnerId;
use super::codec::{self, PartError, json, pod};
use crate::run_folder::{Divergence, Sums};
use serde::{Deserialize, Serialize};
use std::io;

/// One test of one learner.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TestResult {
    /// Index of the skill.
    pub skill: u32,
    /// Trials of the skill before the test.
    pub trials: u32,
    /// Actions executed before the test.
    pub actions: u32,
    /// 0 for the circumstances of training, else the number of the plan's alteration, counted from 1.
    pub variant: u32,
    /// Test trials that began in each room, and at the end those that began in none.
    #[serde(with = "pod")]
    pub rooms: Vec<Sums>,
}

/// All that one learner leaves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearnerResult {
    /// Whose results these are.
    pub id: LearnerId,
    /// Where a number stopped being finite, if one did: the learner was frozen there.
    #[serde(with = "json")]
    pub divergence: Option<Divergence>,
    /// Transitions learned from.
    pub updates: u32,
    /// Tests, in order.
    pub tests: Vec<TestResult>,
    /// Rows of the trial table, `ROW_WORDS` words each.
    #[serde(with = "pod")]
    pub rows: Vec<u32>,
    /// Weights of all nets as they ended.
    #[serde(with = "pod")]
    pub weights: Vec<f32>,
    /// Thresholds of the root's children.
    #[serde(with = "pod")]
    pub thresholds: Vec<f32>,
}

impl LearnerResult {
    /// A learner that has left nothing yet.
    pub fn new(id: LearnerId) -> Self {
        Self {
            id,
            divergence: None,
            updates: 0,
            tests: Vec::new(),
            rows: Vec::new(),
            weights: Vec::new(),
            thresholds: Vec::new(),
        }
    }
}

/// Bytes of a part.
///
/// # Errors
/// Where a result has no bytes: a bug.
pub fn encode(results: &[LearnerResult]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    codec::write(&results, &mut bytes)?;
    Ok(bytes)
}

/// Reads a part back.
///
/// # Errors
/// Where the bytes end early, go on, or are not those of results.
pub fn decode(bytes: &[u8]) -> Result<Vec<LearnerResult>, PartError> {
    codec::read(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run_folder::failures::{Number, Weight};

    fn example() -> Vec<LearnerResult> {
        let mut result = LearnerResult::new(LearnerId { arm: 2, seed: 9 });
        let mut rooms = vec![Sums::default(); 2];
        rooms[1] = Sums { episodes: 1, successes: 1, steps: 7, collisions: 3, reward: -0.1, returned: 0.2 };
        result.tests.push(TestResult { skill: 0, trials: 5, actions: 60, variant: 2, rooms });
        result.rows = vec![1, 2, 3];
        result.weights = vec![0.5, -0.0];
        result.thresholds = vec![-2.0, 0.25];
        let mut diverged = LearnerResult::new(LearnerId { arm: 0, seed: 1 });
        diverged.divergence = Some(Divergence {
            arm: "a".to_owned(),
            point: 3,
            seed: 1,
            skill: "dock".to_owned(),
            trial: 7,
            what: "a weight is not finite".to_owned(),
            transition: None,
            weight: Some(Weight { tensor: "t".to_owned(), index: vec![1, 2], value: Number(f32::NEG_INFINITY) }),
        });
        vec![result, diverged, LearnerResult::new(LearnerId { arm: 0, seed: 2 })]
    }

    #[test]
    fn results_survive_a_round_trip() {
        assert_eq!(decode(&encode(&example()).unwrap()), Ok(example()));
    }

    #[test]
    fn every_truncation_is_seen() {
        let bytes = encode(&example()).unwrap();
        for length in 0..bytes.len() {
            assert_eq!(decode(&bytes[..length]), Err(PartError), "{length} bytes");
        }
        assert_eq!(decode(&[bytes, vec![0]].concat()), Err(PartError));
    }
}
