//! What one learner leaves behind, and its words in a committed part of a run folder.

use super::group::LearnerId;

/// Sums of test trials that began in one room.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RoomSums {
    /// Trials.
    pub episodes: u32,
    /// Trials that achieved the goal.
    pub successes: u32,
    /// Steps.
    pub steps: u32,
    /// Collisions.
    pub collisions: u32,
    /// Reward.
    pub reward: f64,
    /// Reward, discounted from the start of each trial.
    pub returned: f64,
}

impl RoomSums {
    /// Counts other trials in.
    pub fn add(&mut self, other: &Self) {
        self.episodes += other.episodes;
        self.successes += other.successes;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.returned += other.returned;
    }
}

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
    pub rooms: Vec<RoomSums>,
}

/// All that one learner leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct LearnerResult {
    /// Whose results these are.
    pub id: LearnerId,
    /// Whether a number stopped being finite.
    pub failed: bool,
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

/// A committed part does not hold what it should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a committed part of the run does not hold whole results")]
pub struct PartError;

impl LearnerResult {
    /// A learner that has left nothing yet.
    pub fn new(id: LearnerId) -> Self {
        Self {
            id,
            failed: false,
            updates: 0,
            tests: Vec::new(),
            rows: Vec::new(),
            weights: Vec::new(),
            thresholds: Vec::new(),
        }
    }

    fn write(&self, words: &mut Vec<u32>) {
        words.extend([self.id.arm as u32, self.id.seed, u32::from(self.failed), self.updates]);
        words.push(self.tests.len() as u32);
        for test in &self.tests {
            words.extend([test.skill, test.trials, test.actions, test.variant, test.rooms.len() as u32]);
            for room in &test.rooms {
                words.extend([room.episodes, room.successes, room.steps, room.collisions]);
                for bits in [room.reward.to_bits(), room.returned.to_bits()] {
                    words.extend([bits as u32, (bits >> 32) as u32]);
                }
            }
        }
        words.push(self.rows.len() as u32);
        words.extend(&self.rows);
        for values in [&self.weights, &self.thresholds] {
            words.push(values.len() as u32);
            words.extend(values.iter().map(|value| value.to_bits()));
        }
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, PartError> {
        let [arm, seed, failed, updates] = reader.words()?;
        let mut result = Self::new(LearnerId { arm: arm as usize, seed });
        result.failed = match failed {
            0 | 1 => failed == 1,
            _ => return Err(PartError),
        };
        result.updates = updates;
        let [tests] = reader.words()?;
        for _test in 0..tests {
            let [skill, trials, actions, variant, count] = reader.words()?;
            let mut rooms = Vec::new();
            for _room in 0..count {
                let [episodes, successes, steps, collisions] = reader.words()?;
                let (reward, returned) = (reader.double()?, reader.double()?);
                rooms.push(RoomSums { episodes, successes, steps, collisions, reward, returned });
            }
            result.tests.push(TestResult { skill, trials, actions, variant, rooms });
        }
        let [rows] = reader.words()?;
        result.rows = reader.slice(rows as usize)?.to_vec();
        result.weights = reader.singles()?;
        result.thresholds = reader.singles()?;
        Ok(result)
    }
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
    let (chunks, rest) = bytes.as_chunks::<4>();
    let words: Vec<u32> = chunks.iter().map(|chunk| u32::from_le_bytes(*chunk)).collect();
    let mut reader = Reader { words: &words };
    let [count] = reader.words()?;
    let results = (0..count).map(|_| LearnerResult::read(&mut reader)).collect::<Result<Vec<_>, _>>()?;
    if reader.words.is_empty() && rest.is_empty() { Ok(results) } else { Err(PartError) }
}

struct Reader<'a> {
    words: &'a [u32],
}

impl<'a> Reader<'a> {
    fn slice(&mut self, count: usize) -> Result<&'a [u32], PartError> {
        let (head, tail) = self.words.split_at_checked(count).ok_or(PartError)?;
        self.words = tail;
        Ok(head)
    }

    fn words<const N: usize>(&mut self) -> Result<[u32; N], PartError> {
        self.slice(N)?.try_into().map_err(|_| PartError)
    }

    fn double(&mut self) -> Result<f64, PartError> {
        let [low, high] = self.words()?;
        Ok(f64::from_bits(u64::from(low) | u64::from(high) << 32))
    }

    fn singles(&mut self) -> Result<Vec<f32>, PartError> {
        let [count] = self.words()?;
        Ok(self.slice(count as usize)?.iter().map(|bits| f32::from_bits(*bits)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Vec<LearnerResult> {
        let mut result = LearnerResult::new(LearnerId { arm: 2, seed: 9 });
        let mut rooms = vec![RoomSums::default(); 2];
        rooms[1].add(&RoomSums { episodes: 1, successes: 1, steps: 7, collisions: 3, reward: -0.1, returned: 0.2 });
        result.tests.push(TestResult { skill: 0, trials: 5, actions: 60, variant: 2, rooms });
        result.rows = vec![1, 2, 3];
        result.weights = vec![0.5, -0.0];
        result.thresholds = vec![-2.0, 0.25];
        vec![result, LearnerResult::new(LearnerId { arm: 0, seed: 1 })]
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
