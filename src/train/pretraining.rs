//! Arms that have everything below their roots in common, and so learn it once for each seed; and arms without anything
//! below their roots that can train in one cohort.

use super::batch_group::{BatchGroup, LearnerId, classes, group_of, in_common};
use super::codec::{json, pod, record};
use super::result::{TestResult, are_of_arm, is_known};
use super::thresholds::Fit;
use crate::config::plan::{ArmPlan, Plan};
use crate::layout::LearnerState;
use crate::run_folder::Divergence;
use serde::{Deserialize, Serialize};

/// A learner that has learned everything below the root: every arm that shares it goes on from a copy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pretrained {
    /// Its seed, and the first of the arms that go on from it.
    pub id: LearnerId,
    #[serde(with = "record")]
    pub(super) state: LearnerState,
    #[serde(with = "pod")]
    pub(super) nets: Vec<f32>,
    #[serde(with = "pod")]
    pub(super) rows: Vec<u32>,
    pub(super) tests: Vec<TestResult>,
    /// Of each skill below the root that has trials: how success goes with its value.
    pub(super) fits: Vec<Option<Fit>>,
    #[serde(with = "json")]
    pub(super) divergence: Option<Divergence>,
}

/// The skills that the learners in training share.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pretraining {
    /// Who learns them: an arm, the first one that goes on from them, and seeds. Empty where there is nothing below roots.
    pub learners: Vec<LearnerId>,
    /// The learners, once they have learned them; none where they still do, or where there are none.
    pub done: Option<Vec<Pretrained>>,
}

/// Arms that share all skills below their roots, or that have none there and are of one group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SharedSkills {
    /// Indices of the arms in the plan.
    pub arms: Vec<usize>,
    /// Whether there is anything to learn below the root.
    pub pretrained: bool,
}

/// Sorts the plan's arms by the skills that they share.
pub fn shared_skills(plan: &Plan) -> Vec<SharedSkills> {
    let shared = |arms: Vec<usize>| SharedSkills { pretrained: plan.arms[arms[0]].skills.len() > 1, arms };
    classes(&plan.arms, below_root).into_iter().map(shared).collect()
}

/// An arm as its learners see it until the root begins: all of it but the root.
fn below_root(arm: &ArmPlan) -> ArmPlan {
    match arm.skills.split_last() {
        Some((_, below)) if !below.is_empty() => ArmPlan { skills: below.to_vec(), ..arm.clone() },
        _ => in_common(arm),
    }
}

impl Pretraining {
    /// Whether these are learners of the plan and, if they are there, all of their skills below the root.
    pub(super) fn fits(&self, plan: &Plan, groups: &[BatchGroup]) -> bool {
        let sound = |learner: &Pretrained| {
            let shape = &group_of(groups, learner.id.arm).shape;
            let root = shape.skills.len() - 1;
            learner.nets.len() == shape.skills[root].nets_offset as usize
                && learner.rows.len() <= shape.rows_stride
                && learner.fits.len() == root
                && are_of_arm(plan, learner.id.arm, &learner.tests, &learner.rows)
        };
        let ids = || self.learners.iter().copied();
        ids().all(|id| is_known(plan, id))
            && self
                .done
                .as_ref()
                .is_none_or(|done| done.iter().map(|learner| learner.id).eq(ids()) && done.iter().all(sound))
    }
}

impl SharedSkills {
    /// Most bytes that a learner of any of the arms takes.
    pub fn bytes_per_learner(&self, groups: &[BatchGroup]) -> usize {
        self.arms.iter().map(|arm| group_of(groups, *arm).shape.bytes_per_learner()).max().unwrap_or(1)
    }

    /// The seeds of which some arm still lacks its learner.
    pub fn open_seeds(&self, plan: &Plan, done: impl Fn(&LearnerId) -> bool) -> Vec<u32> {
        let lacks = |seed: &u32| self.arms.iter().any(|arm| !done(&LearnerId { arm: *arm, seed: *seed }));
        plan.seeds.iter().copied().filter(lacks).collect()
    }
}
