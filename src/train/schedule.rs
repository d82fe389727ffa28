//! Which learners train together, and in what order.
//!
//! No result depends on it. What arms share below their roots is trained once for each seed, and all of these arms go on
//! from there before the next seeds are begun, so that few pretrained learners are in memory. Learners of several arms and
//! points share a cohort if they are of one group: a sweep of thousands of points with few seeds still fills a device.

use super::batch_group::{BatchGroup, LearnerId, group_index};
use super::pretraining::{SharedSkills, shared_skills};
use crate::backend::BackendError;
use crate::config::plan::Plan;
use std::collections::BTreeMap;

/// Cohorts that go on from the same pretrained learners.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wave {
    /// The arm and the seeds that are pretrained first, as one cohort; none where there is nothing below the roots.
    pub pretraining: Option<(usize, Vec<u32>)>,
    /// The cohorts, each of learners of one group.
    pub cohorts: Vec<Vec<LearnerId>>,
}

/// The waves of a run, in order, without the learners that are `done`. `size` gives the most learners of a cohort
/// from the bytes that one takes.
pub fn waves(
    plan: &Plan,
    groups: &[BatchGroup],
    mut size: impl FnMut(usize) -> Result<usize, BackendError>,
    done: impl Fn(&LearnerId) -> bool,
) -> Result<Vec<Wave>, BackendError> {
    let mut waves = Vec::new();
    for shared in shared_skills(plan) {
        let most = size(shared.bytes_per_learner(groups))?;
        let open = shared.open_seeds(plan, &done);
        // Without pretraining, all seeds are in one wave.
        let stretch = if shared.pretrained { most } else { open.len() };
        for seeds in parts(&open, stretch) {
            let pretraining = shared.pretrained.then(|| (shared.arms[0], seeds.to_vec()));
            waves.push(Wave { pretraining, cohorts: cohorts(plan, groups, &shared, seeds, most, &done) });
        }
    }
    Ok(waves)
}

/// The cohorts of the arms that share skills, for some seeds, without the learners that are `done`.
pub(super) fn cohorts(
    plan: &Plan,
    groups: &[BatchGroup],
    shared: &SharedSkills,
    seeds: &[u32],
    most: usize,
    done: &impl Fn(&LearnerId) -> bool,
) -> Vec<Vec<LearnerId>> {
    // Tests under alterations are numbered by the root's trials, all learners of a cohort at once.
    let trials = |arm: usize| match plan.alterations[..] {
        [] => 0,
        _ => plan.arms[arm].skills.last().map_or(0, |root| root.params.trials),
    };
    let mut alike: BTreeMap<(usize, u32), Vec<LearnerId>> = BTreeMap::new();
    for &arm in &shared.arms {
        let own = seeds.iter().map(|&seed| LearnerId { arm, seed }).filter(|id| !done(id));
        alike.entry((group_index(groups, arm), trials(arm))).or_default().extend(own);
    }
    alike.values().flat_map(|learners| parts(learners, most).map(<[LearnerId]>::to_vec)).collect()
}

/// Cuts into as few parts of at most `most` as possible, of about the same size.
fn parts<T>(all: &[T], most: usize) -> impl Iterator<Item = &[T]> {
    let count = all.len().div_ceil(most.max(1));
    (0..count).map(move |part| &all[all.len() * part / count..all.len() * (part + 1) / count])
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn parts_are_few_and_even() {
        let cut = |count: usize, most| parts(&vec![0; count], most).map(<[i32]>::len).collect::<Vec<_>>();
        assert_eq!(cut(35, 32), [17, 18]);
        assert_eq!(cut(32, 32), [32]);
        assert_eq!(cut(5, 2), [1, 2, 2]);
        assert!(cut(0, 3).is_empty());
        let all: Vec<usize> = (0..100).collect();
        assert_eq!(parts(&all, 7).flatten().copied().collect::<Vec<_>>(), all);
    }
}
