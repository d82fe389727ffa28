//! Sums the rows of the table of tests.

use super::diverged;
use super::scores::{
    ArmSummary, PlannerBound, Score, ScoresByTest, SeedScores, Series, SeriesKey, SkillSummary, Summary, TransferTest,
};
use crate::report::format::seeds as seed_count;
use crate::run_folder::tables::{PLANNER, TRAINED};
use crate::run_folder::{Divergence, EvaluationRow, Names};
use std::collections::{BTreeMap, BTreeSet};

impl From<&EvaluationRow> for Score {
    fn from(row: &EvaluationRow) -> Self {
        let sums = row.sums();
        Self {
            seed: row.seed,
            actions: row.actions,
            episodes: u64::from(sums.episodes),
            successes: u64::from(sums.successes),
            steps: u64::from(sums.steps),
            collisions: u64::from(sums.collisions),
            reward: sums.reward,
            returned: sums.returned,
            ..Self::default()
        }
    }
}

/// Sums the rows and sorts them by skill, arm, sweep point, trials and seed. A test that some seeds of its series lack
/// is left out, with a warning: an average over the seeds that happen to be there would mislead. Learners that diverged
/// lack no test: those that they did not live to see count as failed.
pub fn summarise(names: &Names, rows: &[EvaluationRow], seeds: &[u32], learners: &[Divergence]) -> Summary {
    let rooms = names.rooms.len();
    let mut sums: BTreeMap<SeriesKey, ScoresByTest> = BTreeMap::new();
    let mut transfer: BTreeMap<SeriesKey, ScoresByTest> = BTreeMap::new();
    let mut bounds: BTreeMap<(u32, u32), Vec<Score>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.episodes > 0) {
        let (arm, skill) = (Names::number(&names.arms, &row.arm), Names::number(&names.skills, &row.skill));
        let key = (skill, arm, row.point);
        let scores = if of_planner(names, arm).is_some() {
            bounds.entry((skill, arm)).or_default()
        } else if row.variant == TRAINED {
            sums.entry(key).or_default().entry(row.trials).or_default().entry(row.seed).or_default()
        } else {
            let variant = Names::number(&names.variants, &row.variant);
            transfer.entry(key).or_default().entry(variant).or_default().entry(row.seed).or_default()
        };
        scores.resize(rooms, Score::default());
        scores[Names::number(&names.rooms, &row.room) as usize].add(&row.into());
    }
    diverged::fill_in(names, learners, &mut sums, &mut transfer);
    let swept = sums.keys().any(|&(_, _, point)| point > 0);
    let mut summary = Summary {
        rooms: names.rooms.clone(),
        arms: arms(names, rows),
        diverged: learners.to_vec(),
        ..Summary::default()
    };
    for (code, name) in names.skills.iter().enumerate() {
        let code = code as u32;
        let mut skill = SkillSummary { name: name.clone(), series: Vec::new(), bounds: Vec::new() };
        for (&(_, arm), rooms) in bounds.range((code, 0)..=(code, u32::MAX)) {
            let arm = of_planner(names, arm).flatten().map(str::to_owned);
            skill.bounds.push(PlannerBound { arm, score: total(rooms), rooms: rooms.clone() });
        }
        for (key, tests) in sums.range((code, 0, 0)..=(code, u32::MAX, u32::MAX)) {
            let arm = &names.arms[key.1 as usize];
            let label = if swept { format!("{arm}, point {}", key.2) } else { arm.clone() };
            let tests = complete(&format!("{name}, {label}"), tests, seeds, &mut summary.warnings);
            let elsewhere = transfer.get(key).into_iter().flatten().map(|(variant, seeds)| TransferTest {
                variant: names.variants[*variant as usize].clone(),
                scores: seeds.values().map(|rooms| total(rooms)).collect(),
            });
            if !tests.is_empty() {
                let transfer = elsewhere.collect();
                skill.series.push(Series { arm: arm.clone(), point: key.2, label, tests, transfer });
            }
        }
        if !skill.series.is_empty() || !skill.bounds.is_empty() {
            summary.skills.push(skill);
        }
    }
    summary
}

/// Whether an arm's rows are the planner's own tests, and if so, of which arm's task if not of the first.
fn of_planner(names: &Names, arm: u32) -> Option<Option<&str>> {
    let rest = names.arms[arm as usize].strip_prefix(PLANNER)?;
    let task = rest.strip_prefix('-').filter(|task| names.arms.iter().any(|name| name == task));
    (rest.is_empty() || task.is_some()).then_some(task)
}

/// An arm's rows come in the order of its tests, so the root's come last.
fn arms(names: &Names, rows: &[EvaluationRow]) -> Vec<ArmSummary> {
    let mut skills: BTreeMap<u32, (u32, BTreeSet<u32>)> = BTreeMap::new();
    for row in rows {
        let (arm, skill) = (Names::number(&names.arms, &row.arm), Names::number(&names.skills, &row.skill));
        if of_planner(names, arm).is_none() {
            let (root, all) = skills.entry(arm).or_default();
            *root = skill;
            all.insert(skill);
        }
    }
    let arm = |(arm, (root, all)): (u32, (u32, BTreeSet<u32>))| ArmSummary {
        name: names.arms[arm as usize].clone(),
        root: names.skills[root as usize].clone(),
        hierarchical: all.len() > 1,
    };
    skills.into_iter().map(arm).collect()
}

fn complete(what: &str, tests: &ScoresByTest, seeds: &[u32], warnings: &mut Vec<String>) -> Vec<SeedScores> {
    let all: BTreeSet<u32> = tests.values().flat_map(BTreeMap::keys).copied().collect();
    let absent = seeds.iter().filter(|seed| !all.contains(seed)).count();
    if absent > 0 {
        warnings.push(format!("{what}: {absent} of {} have no tests at all.", seed_count(seeds.len())));
    }
    let mut kept = Vec::new();
    for (&trials, seeds) in tests {
        if seeds.len() == all.len() {
            let rooms = seeds.values().next().map_or(0, Vec::len);
            let room = |room: usize| {
                let scores = seeds.values().map(move |rooms| rooms[room]);
                scores.filter(|score| score.episodes > 0).collect()
            };
            let scores = seeds.values().map(|rooms| total(rooms)).collect();
            kept.push(SeedScores { trials, scores, rooms: (0..rooms).map(room).collect() });
        } else {
            let (has, of) = (seeds.len(), all.len());
            warnings.push(format!("{what}: left out after {trials} trials, where {has} of {of} seeds were tested."));
        }
    }
    kept
}

fn total(rooms: &[Score]) -> Score {
    let mut sum = Score::default();
    for room in rooms.iter().filter(|room| room.episodes > 0) {
        sum.add(room);
    }
    sum
}
