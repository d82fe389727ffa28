//! Whether what was read back can be of this experiment, so that nothing goes on from anything else.

use super::batch::weight_count;
use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::checkpoint::CohortState;
use super::pretraining::{Pretrained, Pretraining};
use super::result::{LearnerResult, TestResult};
use crate::config::plan::{ArmPlan, Plan};
use crate::layout::{MAX_CHILDREN, TRIAL_WORDS};

/// Whether the plan has such a learner.
pub(super) fn is_known(plan: &Plan, id: LearnerId) -> bool {
    id.arm < plan.arms.len() && plan.seeds.binary_search(&id.seed).is_ok()
}

/// Whether this is all that a learner of the plan leaves at its end.
pub(super) fn is_complete(plan: &Plan, groups: &[BatchGroup], result: &LearnerResult) -> bool {
    let arm = &plan.arms[result.id.arm];
    are_tests(plan, arm, &result.tests)
        && are_rows(arm, &result.rows)
        && result.weights.len() == weight_count(&group_of(groups, result.id.arm).shape.skills)
        && result.thresholds.len() == MAX_CHILDREN
}

/// Whether these are learners of one group, and their memory is of its sizes.
pub(super) fn is_cohort(plan: &Plan, groups: &[BatchGroup], cohort: &CohortState<'_>) -> bool {
    let Some(first) = cohort.results.first().filter(|first| is_known(plan, first.id)) else { return false };
    let group = group_of(groups, first.id.arm);
    let of_group = |result: &LearnerResult| {
        is_known(plan, result.id)
            && group.arms.contains(&result.id.arm)
            && are_tests(plan, &plan.arms[result.id.arm], &result.tests)
            && are_rows(&plan.arms[result.id.arm], &result.rows)
    };
    let (learners, shape) = (cohort.results.len(), &group.shape);
    // After training, lessons and rows are not kept.
    let still = usize::from(!cohort.trained) * learners;
    cohort.results.iter().all(of_group)
        && cohort.states.len() == learners
        && cohort.nets.len() == learners * shape.nets_stride
        && cohort.lessons.len() == still * shape.lessons_stride
        && cohort.rows.len() == still * shape.rows_stride
}

/// Whether these are learners of the plan and, if they are there, all of their skills below the root.
pub(super) fn is_pretraining(plan: &Plan, groups: &[BatchGroup], pretraining: &Pretraining) -> bool {
    let sound = |learner: &Pretrained| {
        let (arm, shape) = (&plan.arms[learner.id.arm], &group_of(groups, learner.id.arm).shape);
        let root = shape.skills.len() - 1;
        learner.nets.len() == shape.skills[root].nets_offset as usize
            && learner.rows.len() <= shape.rows_stride
            && learner.fits.len() == root
            && are_tests(plan, arm, &learner.tests)
            && are_rows(arm, &learner.rows)
    };
    let ids = || pretraining.learners.iter().copied();
    let done = pretraining.done.as_ref();
    ids().all(|id| is_known(plan, id))
        && done.is_none_or(|done| done.iter().map(|learner| learner.id).eq(ids()) && done.iter().all(sound))
}

/// Whether the tests are of an arm's skills, in circumstances and rooms that there are.
fn are_tests(plan: &Plan, arm: &ArmPlan, tests: &[TestResult]) -> bool {
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
fn are_rows(arm: &ArmPlan, rows: &[u32]) -> bool {
    let (whole, rest) = rows.as_chunks::<TRIAL_WORDS>();
    rest.is_empty() && whole.iter().all(|row| (row[0] as usize) < arm.skills.len())
}
