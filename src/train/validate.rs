//! Whether results that were read back can be those of a learner of this experiment, so that nothing goes on from others.

use super::batch::weight_count;
use super::batch_group::{Group, LearnerId};
use super::result::{LearnerResult, TestResult};
use crate::config::plan::{ArmPlan, Plan};
use crate::layout::{MAX_CHILDREN, ROW_WORDS};

/// Whether the plan has such a learner.
pub(super) fn is_known(plan: &Plan, id: LearnerId) -> bool {
    id.arm < plan.arms.len() && plan.seeds.binary_search(&id.seed).is_ok()
}

/// Whether the tests are of an arm's skills, in circumstances and rooms that there are.
pub(super) fn are_tests(plan: &Plan, arm: &ArmPlan, tests: &[TestResult]) -> bool {
    tests.iter().all(|test| {
        let variant = (test.variant as usize).checked_sub(1);
        let alteration = variant.map(|number| plan.alterations.get(number));
        let world = match alteration {
            None => Some(arm.world),
            Some(found) => found.map(|alteration| alteration.world.unwrap_or(arm.world)),
        };
        let rooms = world.map(|world| plan.worlds[world].world.rooms.len() + 1);
        (test.skill as usize) < arm.skills.len() && rooms == Some(test.rooms.len())
    })
}

/// Whether the rows of the trial table are whole and of an arm's skills.
pub(super) fn are_rows(arm: &ArmPlan, rows: &[u32]) -> bool {
    let (whole, rest) = rows.as_chunks::<ROW_WORDS>();
    rest.is_empty() && whole.iter().all(|row| (row[0] as usize) < arm.skills.len())
}

/// Whether this is all that a learner of the plan leaves at its end.
pub(super) fn is_complete(plan: &Plan, group: &Group, result: &LearnerResult) -> bool {
    let arm = &plan.arms[result.id.arm];
    are_tests(plan, arm, &result.tests)
        && are_rows(arm, &result.rows)
        && result.weights.len() == weight_count(&group.shape.skills)
        && result.thresholds.len() == MAX_CHILDREN
}
