//! Learners that diverged count as failed: the tests that they did not live to see are filled in.

use super::scores::{DivergedLearner, Score, ScoresBySeed, ScoresByTest, SeriesKey};
use crate::run_folder::Names;
use std::collections::BTreeMap;

/// Gives every learner that diverged the tests that it lacks: as many test trials as its peers had, none achieved, each
/// as long as the longest mean trial of any test of the skill, without reward.
pub(super) fn fill_in(
    names: &Names,
    diverged: &[DivergedLearner],
    sums: &mut BTreeMap<SeriesKey, ScoresByTest>,
    transfer: &mut BTreeMap<SeriesKey, ScoresByTest>,
) {
    let code = |name: &str| names.arms.iter().position(|arm| arm == name).map(|code| code as u32);
    let of_series = |key: SeriesKey| {
        let same = move |learner: &&DivergedLearner| code(&learner.arm) == Some(key.1) && learner.point == key.2;
        diverged.iter().filter(same).map(|learner| learner.seed).collect::<Vec<u32>>()
    };
    let mut keys: Vec<SeriesKey> = diverged
        .iter()
        .filter_map(|learner| Some((code(&learner.arm)?, learner.point)))
        .flat_map(|(arm, point)| (0..names.skills.len() as u32).map(move |skill| (skill, arm, point)))
        .collect();
    keys.sort_unstable();
    keys.dedup();
    for key in keys {
        let failed = of_series(key);
        let Some(schedule) = schedule(key, &failed, sums) else { continue };
        let longest = longest(key.0, sums);
        fill(sums.entry(key).or_default(), &schedule, &failed, longest);
        if let Some(tests) = transfer.get_mut(&key) {
            let schedule = tests.clone();
            fill(tests, &schedule, &failed, longest);
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
            let last = last_actions(tests, seed);
            let seeds: &mut ScoresBySeed = tests.entry(test).or_default();
            seeds.entry(seed).or_insert_with(|| {
                let fail = |of: &Score| Score {
                    seed,
                    actions: last,
                    episodes: of.episodes,
                    steps: (of.episodes as f64 * longest).round() as u64,
                    ..Score::default()
                };
                peer.iter().map(fail).collect()
            });
        }
    }
}

/// Actions that a learner had executed at its last test; 0 if it had none.
fn last_actions(tests: &ScoresByTest, seed: u32) -> u32 {
    let scores = tests.values().filter_map(|seeds| seeds.get(&seed)).flatten();
    scores.map(|score| score.actions).max().unwrap_or(0)
}
