//! Learners that diverged count as failed: the tests that they did not live to see are filled in.

use super::collect::{Cells, Key, Seeds};
use super::{Diverged, Score};
use crate::run_folder::Names;
use std::collections::BTreeMap;

/// Learners that the warning names.
const MOST_NAMED: usize = 5;

/// Gives every learner that diverged the tests that it lacks: as many test trials as its peers had, none achieved, each
/// as long as the longest mean trial of any test of the skill, without reward.
pub(super) fn complete(
    names: &Names,
    diverged: &[Diverged],
    sums: &mut BTreeMap<Key, Cells>,
    altered: &mut BTreeMap<Key, Cells>,
) {
    let code = |name: &str| names.arms.iter().position(|arm| arm == name).map(|code| code as u32);
    let of_series = |key: Key| {
        let same = move |learner: &&Diverged| code(&learner.arm) == Some(key.1) && learner.point == key.2;
        diverged.iter().filter(same).map(|learner| learner.seed).collect::<Vec<u32>>()
    };
    let mut keys: Vec<Key> = diverged
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
        if let Some(tests) = altered.get_mut(&key) {
            let schedule = tests.clone();
            fill(tests, &schedule, &failed, longest);
        }
    }
}

/// The tests that a series has or, if all of its learners diverged, that its arm has at the point with the most.
fn schedule(key: Key, failed: &[u32], sums: &BTreeMap<Key, Cells>) -> Option<Cells> {
    let own = sums.get(&key).filter(|cells| {
        let mut tested = cells.values().flat_map(BTreeMap::keys);
        tested.any(|seed| !failed.contains(seed))
    });
    let arm = |(other, _): &(&Key, &Cells)| (other.0, other.1) == (key.0, key.1);
    let fullest = || sums.iter().filter(arm).map(|(_, cells)| cells).max_by_key(|cells| cells.len());
    own.or_else(fullest).cloned()
}

/// The longest mean trial of any test of a skill, in steps.
fn longest(skill: u32, sums: &BTreeMap<Key, Cells>) -> f64 {
    let tests = sums.range((skill, 0, 0)..=(skill, u32::MAX, u32::MAX)).flat_map(|(_, cells)| cells.values());
    let scores = tests.flat_map(BTreeMap::values).flatten().filter(|score| score.episodes > 0);
    scores.map(Score::steps_per_trial).fold(0.0, f64::max)
}

fn fill(cells: &mut Cells, schedule: &Cells, failed: &[u32], longest: f64) {
    for (&test, peers) in schedule {
        let Some(peer) = peers.values().next() else { continue };
        for &seed in failed {
            let last = last_actions(cells, seed);
            let seeds: &mut Seeds = cells.entry(test).or_default();
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
fn last_actions(cells: &Cells, seed: u32) -> u32 {
    let scores = cells.values().filter_map(|seeds| seeds.get(&seed)).flatten();
    scores.map(|score| score.actions).max().unwrap_or(0)
}

/// Names the learners that diverged, if there are any.
pub(super) fn warning(diverged: &[Diverged]) -> Option<String> {
    let name = |learner: &Diverged| {
        let Diverged { arm, point, seed, skill, trial } = learner;
        format!("{arm}, point {point}, seed {seed} in trial {trial} of {skill}")
    };
    let named: Vec<String> = diverged.iter().take(MOST_NAMED).map(name).collect();
    let more = diverged.len().saturating_sub(MOST_NAMED);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    let count = if diverged.len() == 1 { "1 learner".to_owned() } else { format!("{} learners", diverged.len()) };
    (!named.is_empty()).then(|| {
        format!(
            "{count} diverged, as a number stopped being finite ({}{more}). All later tests of such a learner count as \
             failed; curves of training hold its trials up to then.",
            named.join("; ")
        )
    })
}
