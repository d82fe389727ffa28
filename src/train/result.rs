//! What one learner leaves behind, and its words in a committed part of a run folder.

use super::batch_group::LearnerId;
use super::codec::{PartError, Reader, words_of};
use crate::run_folder::{Failure, Sums};

/// One test of one learner.
#[derive(Debug, Clone, PartialEq)]
pub struct TestResult {
    /// Index of the skill.
    pub skill: u32,
    /// Trials of the skill before the test.
    pub trials: u32,
    /// Actions executed before the test.
    pub actions: u32,
    /// 0 for the circumstances of training, else the number of the plan's alteration, counted from 1.
    pub variant: u32,
    /// One entry per room, and one for starts in no room.
    pub rooms: Vec<Sums>,
}

/// All that one learner leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnerResult {
    /// Whose results these are.
    pub id: LearnerId,
    /// Where a number stopped being finite, if one did: the learner was frozen there.
    pub failure: Option<Failure>,
    /// Transitions learned from.
    pub updates: u32,
    /// Tests, in order.
    pub tests: Vec<TestResult>,
    /// Rows of the trial table.
    pub rows: Vec<u32>,
    /// Weights of all nets as they ended.
    pub weights: Vec<f32>,
    /// Thresholds of the root's children.
    pub thresholds: Vec<f32>,
}

impl LearnerResult {
    /// A learner that has left nothing yet.
    pub fn new(id: LearnerId) -> Self {
        Self {
            id,
            failure: None,
            updates: 0,
            tests: Vec::new(),
            rows: Vec::new(),
            weights: Vec::new(),
            thresholds: Vec::new(),
        }
    }

    pub(super) fn write(&self, words: &mut Vec<u32>) {
        words.extend([self.id.arm as u32, self.id.seed, self.updates]);
        write_failure(words, self.failure.as_ref());
        write_tests(words, &self.tests);
        words.push(self.rows.len() as u32);
        words.extend(&self.rows);
        for values in [&self.weights, &self.thresholds] {
            words.push(values.len() as u32);
            words.extend(values.iter().map(|value| value.to_bits()));
        }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Result<Self, PartError> {
        let [arm, seed, updates] = reader.words()?;
        let mut result = Self::new(LearnerId { arm: arm as usize, seed });
        result.updates = updates;
        result.failure = read_failure(reader)?;
        result.tests = read_tests(reader)?;
        let [rows] = reader.words()?;
        result.rows = reader.slice(rows as usize)?.to_vec();
        result.weights = reader.singles()?;
        result.thresholds = reader.singles()?;
        Ok(result)
    }
}

/// A failure is kept as the JSON that `failures.json` will hold: its length in bytes, then words.
pub(super) fn write_failure(words: &mut Vec<u32>, failure: Option<&Failure>) {
    // It holds nothing that has no JSON form; were it so, the learner would be listed without its transition.
    let text = failure.map(|failure| {
        let bare = || serde_json::to_vec(&Failure { transition: None, weight: None, ..failure.clone() });
        serde_json::to_vec(failure).or_else(|_| bare()).unwrap_or_default()
    });
    let text = text.unwrap_or_default();
    words.push(text.len() as u32);
    let word = |bytes: &[u8]| bytes.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
    words.extend(text.chunks(4).map(word));
}

pub(super) fn read_failure(reader: &mut Reader<'_>) -> Result<Option<Failure>, PartError> {
    let [length] = reader.words()?;
    let words = reader.slice(length.div_ceil(4) as usize)?;
    if length == 0 {
        return Ok(None);
    }
    let mut text: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    text.truncate(length as usize);
    let failure: Failure = serde_json::from_slice(&text).map_err(|_| PartError)?;
    // One text for one failure: another was never written.
    let mut again = Vec::new();
    write_failure(&mut again, Some(&failure));
    if again.first() == Some(&length) && again[1..] == *words { Ok(Some(failure)) } else { Err(PartError) }
}

pub(super) fn write_tests(words: &mut Vec<u32>, tests: &[TestResult]) {
    words.push(tests.len() as u32);
    for test in tests {
        words.extend([test.skill, test.trials, test.actions, test.variant, test.rooms.len() as u32]);
        for room in &test.rooms {
            words.extend([room.episodes, room.successes, room.steps, room.collisions]);
            for value in [room.reward, room.returned] {
                write_double(words, value);
            }
        }
    }
}

pub(super) fn read_tests(reader: &mut Reader<'_>) -> Result<Vec<TestResult>, PartError> {
    let [tests] = reader.words()?;
    let mut found = Vec::new();
    for _test in 0..tests {
        let [skill, trials, actions, variant, count] = reader.words()?;
        let mut rooms = Vec::new();
        for _room in 0..count {
            let [episodes, successes, steps, collisions] = reader.words()?;
            let (reward, returned) = (reader.double()?, reader.double()?);
            rooms.push(Sums { episodes, successes, steps, collisions, reward, returned });
        }
        found.push(TestResult { skill, trials, actions, variant, rooms });
    }
    Ok(found)
}

pub(super) fn write_double(words: &mut Vec<u32>, value: f64) {
    let bits = value.to_bits();
    words.extend([bits as u32, (bits >> 32) as u32]);
}

/// Bytes of a part: little-endian words, the number of learners first.
pub fn encode(results: &[LearnerResult]) -> Vec<u8> {
    let mut words = vec![results.len() as u32];
    for result in results {
        result.write(&mut words);
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Reads a part back.
///
/// # Errors
/// Where the bytes end early or go on.
pub fn decode(bytes: &[u8]) -> Result<Vec<LearnerResult>, PartError> {
    let words = words_of(bytes)?;
    let mut reader = Reader::new(&words);
    let [count] = reader.words()?;
    let results = (0..count).map(|_| LearnerResult::read(&mut reader)).collect::<Result<Vec<_>, _>>()?;
    reader.end().map(|()| results)
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
        let mut failed = LearnerResult::new(LearnerId { arm: 0, seed: 1 });
        failed.failure = Some(Failure {
            arm: "a".to_owned(),
            point: 3,
            seed: 1,
            skill: "dock".to_owned(),
            trial: 7,
            what: "a weight is not finite".to_owned(),
            transition: None,
            weight: Some(Weight { tensor: "t".to_owned(), index: vec![1, 2], value: Number(f32::NEG_INFINITY) }),
        });
        vec![result, failed, LearnerResult::new(LearnerId { arm: 0, seed: 2 })]
    }

    #[test]
    fn results_survive_a_round_trip() {
        assert_eq!(decode(&encode(&example())), Ok(example()));
    }

    #[test]
    fn every_truncation_is_seen() {
        let bytes = encode(&example());
        for length in 0..bytes.len() {
            assert_eq!(decode(&bytes[..length]), Err(PartError), "{length} bytes");
        }
        assert_eq!(decode(&[bytes, vec![0]].concat()), Err(PartError));
    }
}
