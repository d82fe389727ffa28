//! What one learner leaves behind.

use super::batch_group::LearnerId;
use super::codec::{json, pod};
use crate::config::plan::Plan;
use crate::layout::TRIAL_WORDS;
use crate::run_folder::{Divergence, Sums};
use crate::world::World;
use glam::Vec2;
use serde::{Deserialize, Serialize};

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
    /// Rows of the trial table, `TRIAL_WORDS` words each.
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

    /// Whether a learner of the plan can have left these tests and rows.
    pub(super) fn fits(&self, plan: &Plan) -> bool {
        is_known(plan, self.id) && are_of_arm(plan, self.id.arm, &self.tests, &self.rows)
    }
}

/// Whether the plan has such a learner.
pub(super) fn is_known(plan: &Plan, id: LearnerId) -> bool {
    id.arm < plan.arms.len() && plan.seeds.binary_search(&id.seed).is_ok()
}

/// Whether tests are of an arm's skills, in circumstances and rooms that there are, and rows whole and of its skills.
pub(super) fn are_of_arm(plan: &Plan, arm: usize, tests: &[TestResult], rows: &[u32]) -> bool {
    let skills = plan.arms[arm].skills.len();
    let test_fits = |test: &TestResult| {
        let rooms = world_of(plan, arm, test.variant).map(|world| world.rooms.len() + 1);
        (test.skill as usize) < skills && rooms == Some(test.rooms.len())
    };
    let (whole, rest) = rows.as_chunks::<TRIAL_WORDS>();
    tests.iter().all(test_fits) && rest.is_empty() && whole.iter().all(|row| (row[0] as usize) < skills)
}

/// The floor plan of an arm's tests of a variant, which is as in [`TestResult::variant`], if there is such a variant.
pub(super) fn world_of(plan: &Plan, arm: usize, variant: u32) -> Option<&World> {
    let own = plan.arms[arm].world;
    let world = match variant.checked_sub(1) {
        None => own,
        Some(number) => plan.alterations.get(number as usize)?.world.unwrap_or(own),
    };
    Some(&plan.worlds[world].world)
}

/// Sums of test trials by the room in which each began: one entry per room of the world, and one for none.
pub(super) fn by_room(world: &World, trials: impl Iterator<Item = (Vec2, Sums)>) -> Vec<Sums> {
    let mut rooms = vec![Sums::default(); world.rooms.len() + 1];
    for (start, trial) in trials {
        rooms[world.room_of(start).unwrap_or(world.rooms.len())] += trial;
    }
    rooms
}
