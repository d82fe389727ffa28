//! Learners that diverged count as failed: the tests that they did not live to see are filled in.

use super::scores::{Score, ScoresByTest, SeriesKey};
use crate::run_folder::{Divergence, Names};
use std::collections::BTreeMap;

/// Gives every learner that diverged the tests that it lacks: as many test trials as its peers had, none achieved, each
/// as long as the longest mean trial of any test of the skill, without reward.
pub(super) fn fill_in(
    names: &Names,
    diverged: &[Divergence],
    sums: &mut BTreeMap<SeriesKey, ScoresByTest>,
    transfer: &mut BTreeMap<SeriesKey, ScoresByTest>,
) {
    let mut failed: BTreeMap<(u32, u32), Vec<u32>> = BTreeMap::new();
    for learner in diverged {
        if let Some(arm) = names.arms.iter().position(|arm| *arm == learner.arm) {
            failed.entry((arm as u32, learner.point)).or_default().push(learner.seed);
        }
    }
    for skill in 0..names.skills.len() as u32 {
        for (&(arm, point), seeds) in &failed {
            let key = (skill, arm, point);
            let Some(schedule) = schedule(key, seeds, sums) else { continue };
            let longest = longest(skill, sums);
            fill(sums.entry(key).or_default(), &schedule, seeds, longest);
            if let Some(tests) = transfer.get_mut(&key) {
                let schedule = tests.clone();
                fill(tests, &schedule, seeds, longest);
            }
        }
    }
}

/// The tests that a series has or, if all of its learners diverged, that its arm has at the point with the most.
fn schedule(key: SeriesKey, failed: &[u32], sums: &BTreeMap<SeriesKey, ScoresByTest>) -> Option<ScoresByTest> {
    let own = sums.get(&key).filter(|tests| {
        let mut tested = tests.values().flat_map(BTreeMap::keys);
        tested.any(|seed| !failed.contains(seed))
    });
    let arm = |(other, _): &(&SeriesKey, &ScoresByTest)| (other.0, other.1) == (key.0, key.1);
    let fullest = || sums.iter().filter(arm).map(|(_, tests)| tests).max_by_key(|tests| tests.len());
    own.or_else(fullest).cloned()
}

/// The longest mean trial of any test of a skill, in steps.
fn longest(skill: u32, sums: &BTreeMap<SeriesKey, ScoresByTest>) -> f64 {
    let tests = sums.range((skill, 0, 0)..=(skill, u32::MAX, u32::MAX)).flat_map(|(_, tests)| tests.values());
    let scores = tests.flat_map(BTreeMap::values).flatten().filter(|score| score.episodes > 0);
    scores.map(Score::steps_per_trial).fold(0.0, f64::max)
}

fn fill(tests: &mut ScoresByTest, schedule: &ScoresByTest, failed: &[u32], longest: f64) {
    for (&test, peers) in schedule {
        let Some(peer) = peers.values().next() else { continue };
        for &seed in failed {
            let own = tests.values().filter_map(|seeds| seeds.get(&seed)).flatten();
            let actions = own.map(|score| score.actions).max().unwrap_or(0);
            tests.entry(test).or_default().entry(seed).or_insert_with(|| {
                let fail = |of: &Score| Score {
                    seed,
                    actions,
                    episodes: of.episodes,
                    steps: (of.episodes as f64 * longest).round() as u64,
                    ..Score::default()
                };
                peer.iter().map(fail).collect()
            });
        }
    }
}
