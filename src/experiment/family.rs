//! Arms that have everything below their roots in common, and so learn it once for each seed.

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
    let mut families: Vec<Family> = Vec::new();
    for (index, arm) in plan.arms.iter().enumerate() {
        let stem = arm.skills.len() > 1;
        match families.iter_mut().find(|family| family.stem && stem && related(&plan.arms[family.arms[0]], arm)) {
            Some(family) => family.arms.push(index),
            None => families.push(Family { arms: vec![index], stem }),
        }
    }
    families
}

fn related(a: &Arm, b: &Arm) -> bool {
    let below = |arm: &Arm| arm.skills.len() - 1;
    (a.world, a.noise, a.robot) == (b.world, b.noise, b.robot) && a.skills[..below(a)] == b.skills[..below(b)]
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
    groups.iter().find(|group| group.arms.contains(&arm)).unwrap_or(&groups[0])
}
