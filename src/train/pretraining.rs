//! Arms that have everything below their roots in common, and so learn it once for each seed; and arms without anything
//! below their roots that can train in one cohort.

use super::batch_group::{Group, LearnerId, alike};
use super::fingerprint::{classes, of_stem, of_tasks};
use crate::config::plan::{ArmPlan, Plan};

/// Arms whose learners branch from one stem, or that have none and are of one group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Family {
    /// Indices of the arms in the plan.
    pub arms: Vec<usize>,
    /// Whether there is anything to learn below the root.
    pub stem: bool,
}

/// Sorts the plan's arms into families.
pub fn families(plan: &Plan) -> Vec<Family> {
    let arm = |index: usize| &plan.arms[index];
    let stem = |index: usize| arm(index).skills.len() > 1;
    let related = |a: usize, b: usize| match (stem(a), stem(b)) {
        (true, true) => related(arm(a), arm(b)),
        (false, false) => alike(arm(a), arm(b)),
        _ => false,
    };
    let print = |index: usize| if stem(index) { of_stem(arm(index)) } else { of_tasks(arm(index)) };
    let families = classes(plan.arms.len(), print, related);
    families.into_iter().map(|arms| Family { stem: stem(arms[0]), arms }).collect()
}

fn related(a: &ArmPlan, b: &ArmPlan) -> bool {
    let below = |arm: &ArmPlan| arm.skills.len() - 1;
    (a.world, a.noise, a.teacher) == (b.world, b.noise, b.teacher) && a.skills[..below(a)] == b.skills[..below(b)]
}

impl Family {
    /// Most bytes that a learner of any of the arms takes.
    pub fn bytes_per_learner(&self, groups: &[Group]) -> usize {
        self.arms.iter().map(|arm| group_of(groups, *arm).shape.bytes_per_learner()).max().unwrap_or(1)
    }

    /// The seeds of which some arm still lacks its learner.
    pub fn open_seeds(&self, plan: &Plan, done: impl Fn(&LearnerId) -> bool) -> Vec<u32> {
        let lacks = |seed: &u32| self.arms.iter().any(|arm| !done(&LearnerId { arm: *arm, seed: *seed }));
        plan.seeds.iter().copied().filter(lacks).collect()
    }
}

/// The group that an arm belongs to.
pub fn group_of(groups: &[Group], arm: usize) -> &Group {
    &groups[group_index(groups, arm)]
}

/// Index of the group that an arm belongs to.
pub fn group_index(groups: &[Group], arm: usize) -> usize {
    groups.iter().position(|group| group.arms.binary_search(&arm).is_ok()).unwrap_or(0)
}
