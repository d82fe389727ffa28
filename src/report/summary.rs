//! From rows of sums to one number per seed.

use super::numbers::seeds as seed_count;
use crate::record::tables::{PLANNER, TRAINED};
use crate::record::{EvaluationRow, Names};
use std::collections::{BTreeMap, BTreeSet};

/// Tests of one learner at one moment, summed.
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
    /// Sum of rewards.
    pub reward: f64,
    /// Sum of rewards, discounted from the start of each trial.
    pub returned: f64,
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

    /// Reward per primitive step: the y axis of the paper's Figure 2.
    pub fn reward_per_step(&self) -> f64 {
        self.reward / self.steps.max(1) as f64
    }

    /// Mean discounted return of a test trial.
    pub fn return_per_trial(&self) -> f64 {
        self.returned / self.episodes as f64
    }

    fn add(&mut self, other: &Self) {
        self.seed = other.seed;
        self.actions = self.actions.max(other.actions);
        self.episodes += other.episodes;
        self.successes += other.successes;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.returned += other.returned;
    }
}

impl From<&EvaluationRow> for Score {
    fn from(row: &EvaluationRow) -> Self {
        Self {
            seed: row.seed,
            actions: row.actions,
            episodes: u64::from(row.episodes),
            successes: u64::from(row.successes),
            steps: u64::from(row.steps),
            collisions: u64::from(row.collisions),
            reward: row.reward,
            returned: row.returned,
        }
    }
}

/// All seeds of one series after the same number of training trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Training trials of the skill.
    pub trials: u32,
    /// One score per seed over all starting rooms, by ascending seed.
    pub scores: Vec<Score>,
    /// The same for each of the summary's rooms; seeds without a test from there are left out.
    pub rooms: Vec<Vec<Score>>,
}

impl Cell {
    /// One number per seed.
    pub fn values(&self, of: fn(&Score) -> f64) -> Vec<f64> {
        self.scores.iter().map(of).collect()
    }
}

/// Tests of one series after its last trial, in an altered world or with other noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Altered {
    /// The alteration's name.
    pub variant: String,
    /// One score per seed, by ascending seed.
    pub scores: Vec<Score>,
}

/// One skill of one arm at one sweep point, through training.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The arm.
    pub arm: String,
    /// The sweep point.
    pub point: u32,
    /// The arm's name, with the sweep point if there are several.
    pub label: String,
    /// Cells with all of the series' seeds, by ascending trials. At least one.
    pub cells: Vec<Cell>,
    /// Tests under alterations, in the order of the rows.
    pub altered: Vec<Altered>,
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

    /// The cell nearest to a number of trials, if it is within a quarter of it.
    pub fn near(&self, trials: u32) -> Option<&Cell> {
        Some(self.nearest(trials)).filter(|cell| 4 * cell.trials.abs_diff(trials) <= trials)
    }

    /// Per seed, the training trials at the first test with at least this success; none if no test reached it. A seed
    /// without a number is censored, not dropped: it would have needed more than the last test's trials.
    pub fn trials_to(&self, success: f64) -> Vec<Option<u32>> {
        let seeds = 0..self.last().scores.len();
        let first = |seed: usize| self.cells.iter().find(|cell| cell.scores[seed].success() >= success);
        seeds.map(|seed| first(seed).map(|cell| cell.trials)).collect()
    }
}

/// The planner's own tests of a skill.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// The arm whose task it is; none for the first task of the run.
    pub arm: Option<String>,
    /// Over all starting rooms.
    pub score: Score,
    /// For each of the summary's rooms; no episodes where no test started.
    pub rooms: Vec<Score>,
}

/// All tests of one skill.
#[derive(Debug, Clone, PartialEq)]
pub struct Skill {
    /// The skill's name.
    pub name: String,
    /// One series per arm and sweep point, in the order of the rows.
    pub series: Vec<Series>,
    /// The planner's own tests, if the run holds them: more than one where arms differ in the task.
    pub bounds: Vec<Bound>,
}

impl Skill {
    /// The series that differ from all earlier ones, each with the labels of those that do not: arms that have a skill
    /// in common learned it once.
    pub fn distinct(&self) -> Vec<(&Series, Vec<&str>)> {
        let mut distinct: Vec<(&Series, Vec<&str>)> = Vec::new();
        for series in &self.series {
            match distinct.iter_mut().find(|(earlier, _)| earlier.cells == series.cells) {
                Some((_, copies)) => copies.push(&series.label),
                None => distinct.push((series, Vec::new())),
            }
        }
        distinct
    }

    /// The planner's tests of an arm's task.
    pub fn bound(&self, arm: &str) -> Option<&Bound> {
        let own = self.bounds.iter().find(|bound| bound.arm.as_deref() == Some(arm));
        own.or_else(|| self.bounds.iter().find(|bound| bound.arm.is_none())).or(self.bounds.first())
    }

    /// Whether no test ever ended as achieved, not even the planner's: then the return says how good the skill is.
    pub fn never_ends(&self) -> bool {
        let scores = self.series.iter().flat_map(|series| &series.cells).flat_map(|cell| &cell.scores);
        scores.chain(self.bounds.iter().map(|bound| &bound.score)).all(|score| score.successes == 0)
    }
}

/// What an arm learned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Arm {
    /// Its name.
    pub name: String,
    /// The skill at the top of its tree.
    pub root: String,
    /// Whether there are other skills below.
    pub hierarchical: bool,
}

/// Everything that the report computes from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Rooms in which tests start, by name.
    pub rooms: Vec<String>,
    /// In the order of the rows; without the planner.
    pub arms: Vec<Arm>,
    /// In the order of the rows.
    pub skills: Vec<Skill>,
    /// What the reader must know about gaps in the data.
    pub warnings: Vec<String>,
}

impl Summary {
    /// A skill of an arm, at the first sweep point.
    pub fn series(&self, arm: &str, skill: &str) -> Option<&Series> {
        self.skill(skill)?.series.iter().find(|series| series.arm == arm)
    }

    /// A skill by its name.
    pub fn skill(&self, name: &str) -> Option<&Skill> {
        self.skills.iter().find(|skill| skill.name == name)
    }

    /// An arm by its name.
    pub fn arm(&self, name: &str) -> Option<&Arm> {
        self.arms.iter().find(|arm| arm.name == name)
    }

    /// The place of a room among [`Cell::rooms`].
    pub fn room(&self, name: &str) -> Option<usize> {
        self.rooms.iter().position(|room| room == name)
    }
}

/// One score per room, by seed.
type Seeds = BTreeMap<u32, Vec<Score>>;
/// The same by training trials.
type Cells = BTreeMap<u32, Seeds>;
/// Skill, arm and sweep point.
type Key = (u32, u32, u32);

/// Sums the rows and sorts them by skill, arm, sweep point, trials and seed. A test that some seeds of its series lack
/// is left out, with a warning: an average over the seeds that happen to be there would mislead.
pub fn summarise(names: &Names, rows: &[EvaluationRow], seeds: &[u32]) -> Summary {
    let rooms = names.rooms.len();
    let mut sums: BTreeMap<Key, Cells> = BTreeMap::new();
    let mut altered: BTreeMap<Key, BTreeMap<u32, Seeds>> = BTreeMap::new();
    let mut bounds: BTreeMap<(u32, u32), Vec<Score>> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.episodes > 0) {
        let key = (row.skill, row.arm, row.point);
        let scores = if of_planner(names, row.arm).is_some() {
            bounds.entry((row.skill, row.arm)).or_default()
        } else if names.variants[row.variant as usize] == TRAINED {
            sums.entry(key).or_default().entry(row.trials).or_default().entry(row.seed).or_default()
        } else {
            altered.entry(key).or_default().entry(row.variant).or_default().entry(row.seed).or_default()
        };
        scores.resize(rooms, Score::default());
        scores[row.room as usize].add(&row.into());
    }
    let swept = sums.keys().any(|&(_, _, point)| point > 0);
    let mut summary = Summary { rooms: names.rooms.clone(), arms: arms(names, rows), ..Summary::default() };
    for (code, name) in names.skills.iter().enumerate() {
        let code = code as u32;
        let mut skill = Skill { name: name.clone(), series: Vec::new(), bounds: Vec::new() };
        for (&(_, arm), rooms) in bounds.range((code, 0)..=(code, u32::MAX)) {
            let arm = of_planner(names, arm).flatten().map(str::to_owned);
            skill.bounds.push(Bound { arm, score: total(rooms), rooms: rooms.clone() });
        }
        for (key, cells) in sums.range((code, 0, 0)..=(code, u32::MAX, u32::MAX)) {
            let arm = &names.arms[key.1 as usize];
            let label = if swept { format!("{arm}, point {}", key.2) } else { arm.clone() };
            let cells = complete(&format!("{name}, {label}"), cells, seeds, &mut summary.warnings);
            let altered = altered.get(key).into_iter().flatten().map(|(variant, seeds)| Altered {
                variant: names.variants[*variant as usize].clone(),
                scores: seeds.values().map(|rooms| total(rooms)).collect(),
            });
            if !cells.is_empty() {
                let altered = altered.collect();
                skill.series.push(Series { arm: arm.clone(), point: key.2, label, cells, altered });
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
fn arms(names: &Names, rows: &[EvaluationRow]) -> Vec<Arm> {
    let mut skills: BTreeMap<u32, (u32, BTreeSet<u32>)> = BTreeMap::new();
    let learned = |row: &&EvaluationRow| of_planner(names, row.arm).is_none();
    for row in rows.iter().filter(learned) {
        let (root, all) = skills.entry(row.arm).or_default();
        *root = row.skill;
        all.insert(row.skill);
    }
    let arm = |(arm, (root, all)): (u32, (u32, BTreeSet<u32>))| Arm {
        name: names.arms[arm as usize].clone(),
        root: names.skills[root as usize].clone(),
        hierarchical: all.len() > 1,
    };
    skills.into_iter().map(arm).collect()
}

fn complete(what: &str, cells: &Cells, seeds: &[u32], warnings: &mut Vec<String>) -> Vec<Cell> {
    let all: BTreeSet<u32> = cells.values().flat_map(BTreeMap::keys).copied().collect();
    let absent = seeds.iter().filter(|seed| !all.contains(seed)).count();
    if absent > 0 {
        warnings.push(format!("{what}: {absent} of {} have no tests at all.", seed_count(seeds.len())));
    }
    let mut kept = Vec::new();
    for (&trials, seeds) in cells {
        if seeds.len() == all.len() {
            let rooms = seeds.values().next().map_or(0, Vec::len);
            let room = |room: usize| {
                let scores = seeds.values().map(move |rooms| rooms[room]);
                scores.filter(|score| score.episodes > 0).collect()
            };
            let scores = seeds.values().map(|rooms| total(rooms)).collect();
            kept.push(Cell { trials, scores, rooms: (0..rooms).map(room).collect() });
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

/// One number of each of two scores for every seed that both have.
pub fn paired(a: &[Score], b: &[Score], of: fn(&Score) -> f64) -> (Vec<f64>, Vec<f64>) {
    let other = |seed: u32| b.iter().find(|score| score.seed == seed);
    a.iter().filter_map(|score| Some((of(score), of(other(score.seed)?)))).unzip()
}
