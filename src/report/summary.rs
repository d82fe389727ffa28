//! From rows of sums to one number per seed.

use crate::record::tables::PLANNER;
use crate::record::{EvaluationRow, Names};
use std::collections::{BTreeMap, BTreeSet};

/// Tests of one learner at one moment, summed over starting rooms.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Score {
    /// Seed of the learner.
    pub seed: u32,
    /// Primitive actions executed so far.
    pub actions: u32,
    /// Test trials.
    pub episodes: u64,
    /// Test trials that ended as achieved.
    pub successes: u64,
    /// Primitive steps of all test trials.
    pub steps: u64,
    /// Steps with contact.
    pub collisions: u64,
}

impl Score {
    /// Share of test trials that ended as achieved. Episodes are never 0 in a summary.
    pub fn success(&self) -> f64 {
        self.successes as f64 / self.episodes as f64
    }

    /// Mean steps of a test trial, failed ones counted with their step limit.
    pub fn steps_per_trial(&self) -> f64 {
        self.steps as f64 / self.episodes as f64
    }

    /// Collisions per primitive step, 0 if there was no step.
    pub fn collisions_per_step(&self) -> f64 {
        self.collisions as f64 / self.steps.max(1) as f64
    }

    fn add(&mut self, row: &EvaluationRow) {
        self.seed = row.seed;
        self.actions = self.actions.max(row.actions);
        self.episodes += u64::from(row.episodes);
        self.successes += u64::from(row.successes);
        self.steps += u64::from(row.steps);
        self.collisions += u64::from(row.collisions);
    }
}

/// All seeds of one series after the same number of training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Training trials of the skill.
    pub trials: u32,
    /// One score per seed, by ascending seed.
    pub scores: Vec<Score>,
}

impl Cell {
    /// One number per seed.
    pub fn values(&self, of: fn(&Score) -> f64) -> Vec<f64> {
        self.scores.iter().map(of).collect()
    }
}

/// One skill of one arm at one sweep point, through training.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The arm's name, with the sweep point if there are several.
    pub label: String,
    /// Cells with all of the series' seeds, by ascending trials. At least one.
    pub cells: Vec<Cell>,
}

impl Series {
    /// The last cell: the finished skill.
    pub fn last(&self) -> &Cell {
        &self.cells[self.cells.len() - 1]
    }

    /// The cell nearest to a number of trials; the earlier one of two.
    pub fn nearest(&self, trials: u32) -> &Cell {
        self.cells.iter().min_by_key(|cell| cell.trials.abs_diff(trials)).unwrap_or_else(|| self.last())
    }

    /// Per seed, the training trials at the first test with at least this success; none if no test reached it. A seed
    /// without a number is censored, not dropped: it would have needed more than the last test's trials.
    pub fn trials_to(&self, success: f64) -> Vec<Option<u32>> {
        let seeds = 0..self.last().scores.len();
        let first = |seed: usize| self.cells.iter().find(|cell| cell.scores[seed].success() >= success);
        seeds.map(|seed| first(seed).map(|cell| cell.trials)).collect()
    }
}

/// All tests of one skill.
#[derive(Debug, Clone, PartialEq)]
pub struct Skill {
    /// The skill's name.
    pub name: String,
    /// One series per arm and sweep point, in the order of the rows.
    pub series: Vec<Series>,
    /// The planner's own tests, if the run holds them.
    pub planner: Option<Score>,
}

/// Everything that the report computes from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// In the order of the rows.
    pub skills: Vec<Skill>,
    /// What the reader must know about gaps in the data.
    pub warnings: Vec<String>,
}

/// Scores by seed, by training trials.
type Cells = BTreeMap<u32, BTreeMap<u32, Score>>;

/// Sums the rows over rooms and sorts them by skill, arm, sweep point, trials and seed. A test that some seeds of its
/// series lack is left out, with a warning: an average over the seeds that happen to be there would mislead.
pub fn summarise(names: &Names, rows: &[EvaluationRow], seeds: &[u32]) -> Summary {
    let mut sums: BTreeMap<(u32, u32, u32), Cells> = BTreeMap::new();
    let mut planner: BTreeMap<u32, Score> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.episodes > 0) {
        if names.arms[row.arm as usize] == PLANNER {
            planner.entry(row.skill).or_default().add(row);
        } else {
            let series = sums.entry((row.skill, row.arm, row.point)).or_default();
            series.entry(row.trials).or_default().entry(row.seed).or_default().add(row);
        }
    }
    let swept = sums.keys().any(|&(_, _, point)| point > 0);
    let mut summary = Summary::default();
    for (code, name) in names.skills.iter().enumerate() {
        let mut skill = Skill { name: name.clone(), series: Vec::new(), planner: None };
        skill.planner = planner.get(&(code as u32)).copied();
        for (&(_, arm, point), cells) in sums.range((code as u32, 0, 0)..=(code as u32, u32::MAX, u32::MAX)) {
            let arm = &names.arms[arm as usize];
            let label = if swept { format!("{arm}, point {point}") } else { arm.clone() };
            let series = complete(name, label, cells, seeds, &mut summary.warnings);
            skill.series.extend(series);
        }
        if !skill.series.is_empty() || skill.planner.is_some() {
            summary.skills.push(skill);
        }
    }
    summary
}

fn complete(skill: &str, label: String, cells: &Cells, seeds: &[u32], warnings: &mut Vec<String>) -> Option<Series> {
    let all: BTreeSet<u32> = cells.values().flat_map(BTreeMap::keys).copied().collect();
    let absent = seeds.iter().filter(|seed| !all.contains(seed)).count();
    if absent > 0 {
        warnings.push(format!("{skill}, {label}: {absent} of {} seeds have no tests at all.", seeds.len()));
    }
    let mut kept = Vec::new();
    for (&trials, scores) in cells {
        if scores.len() == all.len() {
            kept.push(Cell { trials, scores: scores.values().copied().collect() });
        } else {
            let (has, of) = (scores.len(), all.len());
            warnings.push(format!(
                "{skill}, {label}: left out after {trials} trials, where {has} of {of} seeds were tested."
            ));
        }
    }
    (!kept.is_empty()).then_some(Series { label, cells: kept })
}
