//! Arms that have everything below their roots in common, and so learn it once for each seed.

use super::fingerprint::{classes, of_stem};
use super::group::{Group, LearnerId};
use crate::config::plan::{Arm, Plan};

/// Arms whose learners branch from one stem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Family {
    /// Indices of the arms in the plan.
    pub arms: Vec<usize>,
    /// Whether there is anything to learn below the root.
    pub stem: bool,
}

/// Sorts the plan's arms into families.
pub fn families(plan: &Plan) -> Vec<Family> {
    let stem = |arm: usize| plan.arms[arm].skills.len() > 1;
    let related = |a: usize, b: usize| stem(a) && stem(b) && related(&plan.arms[a], &plan.arms[b]);
    // Nothing is common to arms without a stem, so that each has a number of its own.
    let print = |arm: usize| if stem(arm) { of_stem(&plan.arms[arm]) } else { arm as u64 };
    let families = classes(plan.arms.len(), print, related);
    families.into_iter().map(|arms| Family { stem: stem(arms[0]), arms }).collect()
}

fn related(a: &Arm, b: &Arm) -> bool {
    let below = |arm: &Arm| arm.skills.len() - 1;
    (a.world, a.noise, a.robot, a.teacher) == (b.world, b.noise, b.robot, b.teacher)
        && a.skills[..below(a)] == b.skills[..below(b)]
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
    groups.iter().find(|group| group.arms.binary_search(&arm).is_ok()).unwrap_or(&groups[0])
}
