//! Learners that share what lies below their roots: they leave what each would have left alone, however the run is cut
//! up and wherever it fails.

use super::three_levels::home;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::host::HostBackend;
use skilltree::backend::{Backend, BackendError, Cohort, Stop, Test};
use skilltree::config::plan::Plan;
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{Episode, LearnerState, Robot};
use skilltree::run_folder::folder::WORLD;
use skilltree::run_folder::tables::{EVALUATIONS, TRIALS, read_evaluations, read_trials};
use skilltree::run_folder::{Provenance, RunFolder};
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::pretraining::shared_skills;
use skilltree::train::run::{Options, RunError, run};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use tempfile::TempDir;

/// Arms that share skills in two ways and of several shapes, and one that shares with nobody.
pub(crate) const ARMS: &str = r#"
    [arm.plain]
    [arm.steps.skill.go-home]
    persistence = "training"
    [arm.steps.skill.go-home.learning]
    backup = "steps"
    advantage_scale = 4.0
    [arm.learned.skill.go-home]
    applicable = { leave = "learned(0.7)", dock = "learned" }
    applicability = true
    [arm.random.skill.go-home]
    policy = "random"
    trials = 0
    [arm.shared-net.skill.go-home]
    inputs = ["values", "room", "bumpers"]
    trials = 9
    [arm.shared-net.skill.go-home.learning]
    shared_net = true
    replay_capacity = 5
    [arm.other-dock.skill.dock.learning]
    gamma = 0.8
    [arm.leave]
    root = "leave"
"#;

/// A plan that takes a fraction of a second.
pub(crate) fn short(arms: &str, set: &[&str]) -> Plan {
    let cuts = [
        "seeds='0..3'",
        "skill.dock.trials=8",
        "skill.pass-door.trials=8",
        "skill.follow-right.trials=4",
        "skill.leave.trials=7",
        "skill.go-home.trials=8",
        "skill.leave.learning.replay_mean_age=3.0",
        "skill.go-home.learning.replays=20",
        "learning.pretrain_epochs=3",
        "evaluate.at=[0, 3]",
        "evaluate.episodes=5",
        "teacher.eval_episodes=3",
    ];
    home(arms, &[cuts.as_slice(), set].concat())
}

/// A backend that fails after some stretches of work.
struct Frail {
    inner: HostBackend,
    left: usize,
}

impl Backend for Frail {
    fn describe(&self) -> String {
        self.inner.describe()
    }

    fn kind(&self) -> &'static str {
        self.inner.kind()
    }

    fn adapter(&self) -> Option<String> {
        None
    }

    fn cohort_size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        self.inner.cohort_size(bytes_per_learner)
    }

    fn load(&mut self, cohort: Cohort) -> Result<(), BackendError> {
        self.inner.load(cohort)
    }

    fn advance(&mut self, stop: Stop) -> Result<&[LearnerState], BackendError> {
        let lost = BackendError::Device { kernel: "train", message: "pulled out".to_owned() };
        self.left = self.left.checked_sub(1).ok_or(lost)?;
        self.inner.advance(stop)
    }

    fn learners(&self) -> usize {
        self.inner.learners()
    }

    fn evaluate_some(&mut self, test: Test, learners: Range<usize>) -> Result<Vec<Episode>, BackendError> {
        self.inner.evaluate_some(test, learners)
    }

    fn memory(&mut self) -> Result<&Cohort, BackendError> {
        self.inner.memory()
    }

    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError> {
        self.inner.step(shared, robots, iterations)
    }
}

/// Runs a plan into a folder, or as far as the backend lasts; what is left of it.
fn attempt(plan: &Plan, groups: &[BatchGroup], dir: &Path, cohort: usize, lasts: usize) -> Result<usize, RunError> {
    let worlds: Vec<(&str, &str)> = plan.worlds.iter().map(|w| (w.file.as_str(), w.text.as_str())).collect();
    assert_eq!(worlds[0].0, WORLD);
    let folder = RunFolder::open(dir, &plan.resolved, &worlds)?;
    // Short stretches, so that there are many moments to fail at.
    let inner = cpu_backend(2, Some(700)).expect("threads");
    let mut backend = Frail { inner, left: lasts };
    let options = Options { cohort: Some(cohort), ..Options::default() };
    run(plan, groups, folder, &mut backend, options, Provenance::default(), &mut ())?;
    Ok(backend.left)
}

/// Everything that the learners of one arm left: weights, and rows of both tables.
pub(crate) fn left(dir: &Path, arm: &str) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(dir.join("skills")).expect("weights") {
        let entry = entry.expect("a file");
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.rsplit_once('-').is_some_and(|(own, _)| own == arm) {
            found.insert(name, std::fs::read(entry.path()).expect("weights"));
        }
    }
    let (_, rows) = read_trials(&dir.join(TRIALS)).expect("trials");
    let own = rows.iter().filter(|row| row.arm == arm);
    found.insert(TRIALS.to_owned(), own.map(|row| format!("{row:?}\n")).collect::<String>().into_bytes());
    let (_, rows) = read_evaluations(&dir.join(EVALUATIONS)).expect("tests");
    let own = rows.iter().filter(|row| row.arm == arm);
    found.insert(EVALUATIONS.to_owned(), own.map(|row| format!("{row:?}\n")).collect::<String>().into_bytes());
    found
}

pub(crate) const NAMES: [&str; 7] = ["plain", "steps", "learned", "random", "shared-net", "other-dock", "leave"];

#[test]
fn shared_skills_leave_what_each_arm_leaves_alone() {
    let plan = short(ARMS, &[]);
    let all = groups(&plan).unwrap_or_else(|error| panic!("{error}"));
    assert!(all.len() >= 4, "{} groups", all.len());
    let sharing: Vec<Vec<usize>> = shared_skills(&plan).into_iter().map(|shared| shared.arms).collect();
    assert_eq!(sharing, [vec![0, 1, 2, 3, 4], vec![5], vec![6]]);
    let parent = TempDir::new().expect("a folder");
    let together = parent.path().join("together");
    let lasts = usize::MAX - attempt(&plan, &all, &together, 32, usize::MAX).unwrap_or_else(|error| panic!("{error}"));
    let expected: Vec<_> = NAMES.iter().map(|arm| left(&together, arm)).collect();
    for (arm, expected) in NAMES.iter().zip(&expected) {
        let rows = String::from_utf8(expected[TRIALS].clone()).expect("text");
        // Taught lessons and trials of everything below, three times, and the root's own.
        let below = if *arm == "leave" { 10 + 8 + 10 + 4 } else { 10 + 8 + 10 + 8 + 10 + 4 + 7 };
        let own = [8, 8, 8, 0, 9, 8, 7][NAMES.iter().position(|name| name == arm).expect("an arm")];
        assert_eq!((expected.len(), rows.lines().count()), (3 + 2, 3 * (below + own)), "{arm}");
    }
    // The roots are not all the same after all.
    let weights = |number: usize| &expected[number][&format!("{}-1.safetensors", NAMES[number])];
    assert!((0..7).all(|a| (0..a).all(|b| weights(a) != weights(b))));
    let same = |dir: &Path, arm: &str, what: &str| {
        let number = NAMES.iter().position(|name| *name == arm).expect("an arm");
        let found = left(dir, arm);
        let differs: Vec<&String> = found.keys().filter(|name| found[*name] != expected[number][*name]).collect();
        assert!(found.len() == expected[number].len() && differs.is_empty(), "{what}: {arm}: {differs:?}");
    };
    let dir = parent.path().join("one-by-one");
    attempt(&plan, &all, &dir, 1, usize::MAX).unwrap_or_else(|error| panic!("{error}"));
    NAMES.iter().for_each(|arm| same(&dir, arm, "cohorts of 1"));
    // Failures, again and again, at moments all over the run, and other cohorts when it is taken up.
    println!("{lasts} stretches");
    let dir = parent.path().join("frail");
    let (mut failures, mut share) = (0, 0.09);
    while let Err(error) = attempt(&plan, &all, &dir, 1 + failures % 3, (lasts as f64 * share) as usize) {
        assert!(error.to_string().contains("pulled out"), "{error}");
        failures += 1;
        share = if failures % 2 == 0 { share + 0.05 } else { share * 1.02 };
    }
    assert!(failures >= 6, "{failures}");
    NAMES.iter().for_each(|arm| same(&dir, arm, &format!("after {failures} failures")));
    // Alone, whoever had company.
    for arm in &NAMES[1..5] {
        let alone = short(ARMS, &[&format!("arms=[{arm:?}]")]);
        let own = groups(&alone).unwrap_or_else(|error| panic!("{error}"));
        let dir = parent.path().join(format!("only-{arm}"));
        attempt(&alone, &own, &dir, 32, usize::MAX).unwrap_or_else(|error| panic!("{error}"));
        same(&dir, arm, "alone");
    }
    // One seed alone.
    let alone = short(ARMS, &["seeds='1'", "arms=['plain']"]);
    let own = groups(&alone).unwrap_or_else(|error| panic!("{error}"));
    let dir = parent.path().join("one-seed");
    attempt(&alone, &own, &dir, 32, usize::MAX).unwrap_or_else(|error| panic!("{error}"));
    let file = "plain-1.safetensors";
    assert!(left(&dir, "plain")[file] == expected[0][file]);
}
