//! A number for what arms may have in common, so that thousands of them are sorted without comparing each with each.
//!
//! Different arms may have the same number: equality is always checked. What is left out here only costs time.

use crate::config::plan::{ArmPlan, SkillPlan};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Sorts things into classes of equals, in the order in which each class shows up first. Equal things have equal
/// fingerprints; `alike` decides.
pub(super) fn classes(
    count: usize,
    fingerprint: impl Fn(usize) -> u64,
    alike: impl Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    let mut known: HashMap<u64, Vec<usize>> = HashMap::new();
    for index in 0..count {
        let like = known.entry(fingerprint(index)).or_default();
        match like.iter().find(|class| alike(classes[**class][0], index)) {
            Some(class) => classes[*class].push(index),
            None => {
                like.push(classes.len());
                classes.push(vec![index]);
            }
        }
    }
    classes
}

/// Of the tasks of an arm's skills, whatever they are learned with.
pub(super) fn of_tasks(arm: &ArmPlan) -> u64 {
    let mut hasher = circumstances(arm);
    for skill in &arm.skills {
        task(skill, &mut hasher);
    }
    hasher.finish()
}

/// Of everything below an arm's root.
pub(super) fn of_stem(arm: &ArmPlan) -> u64 {
    let mut hasher = circumstances(arm);
    for skill in &arm.skills[..arm.skills.len() - 1] {
        task(skill, &mut hasher);
        numbers(skill, &mut hasher);
    }
    hasher.finish()
}

fn circumstances(arm: &ArmPlan) -> DefaultHasher {
    let mut hasher = DefaultHasher::new();
    let (noise, teacher) = (arm.noise, arm.teacher);
    (arm.world, arm.skills.len(), noise.kind, teacher.lessons, teacher.eval_episodes).hash(&mut hasher);
    singles(&[noise.actuator, noise.sonar, noise.light, noise.compass], &mut hasher);
    singles(&[teacher.discount, teacher.backward_cost, teacher.collision_cost], &mut hasher);
    hasher
}

fn task(skill: &SkillPlan, hasher: &mut DefaultHasher) {
    (&skill.name, skill.goal, skill.params.max_steps, skill.params.shared_net).hash(hasher);
    singles(&skill.params.reward, hasher);
    for (region, share) in &skill.starts {
        region.hash(hasher);
        singles(&[*share], hasher);
    }
}

fn numbers(skill: &SkillPlan, hasher: &mut DefaultHasher) {
    bytemuck::bytes_of(&skill.params).hash(hasher);
}

/// Equal numbers are one: -0 counts as 0.
fn singles(values: &[f32], hasher: &mut DefaultHasher) {
    for value in values {
        (value + 0.0).to_bits().hash(hasher);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equals_meet_and_strangers_with_one_fingerprint_do_not() {
        let words = ["a", "b", "a", "c", "b", "a"];
        let alike = |a: usize, b: usize| words[a] == words[b];
        let expected = [vec![0, 2, 5], vec![1, 4], vec![3]];
        assert_eq!(classes(6, |index| u64::from(words[index].as_bytes()[0]), alike), expected);
        assert_eq!(classes(6, |_| 7, alike), expected);
    }
}
