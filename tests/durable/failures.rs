//! Learners that are poisoned: found, named with their first bad transition, and without effect on others.

use skilltree::backend::cpu::cpu_backend;
#[cfg(feature = "gpu")]
use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use skilltree::backend::{Backend, BackendError, Cohort, Stop, Test};
use skilltree::config::plan::Plan;
use skilltree::config::{Overrides, load};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{Episode, LESSON_HEADER_WORDS, LearnerState, PHASE_FAILED, PHASE_REPLAY, Robot};
use skilltree::run_folder::failures::{Divergence, Number};
use skilltree::run_folder::tables::{EVALUATIONS, TRIALS, read_evaluations, read_trials};
use skilltree::run_folder::{FinishedRun, Provenance, RunFolder};
use skilltree::train::batch::train;
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::callbacks::{Callbacks, Signal};
use skilltree::train::codec::encode;
use skilltree::train::divergence::divergence_of;
use skilltree::train::result::LearnerResult;
use skilltree::train::run::{Options, run};
use std::ops::Range;
use std::path::Path;
use tempfile::TempDir;

/// A backend in which, when all learners have finished a trial, one word of one learner's nets is overwritten.
struct Poisoner {
    inner: Box<dyn Backend>,
    victim: usize,
    word: usize,
    value: f32,
    /// The trial before which it happens; none once it has.
    before: Option<u32>,
}

impl Backend for Poisoner {
    fn describe(&self) -> String {
        self.inner.describe()
    }

    fn kind(&self) -> &'static str {
        self.inner.kind()
    }

    fn adapter(&self) -> Option<String> {
        self.inner.adapter()
    }

    fn cohort_size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        self.inner.cohort_size(bytes_per_learner)
    }

    fn load(&mut self, cohort: Cohort) -> Result<(), BackendError> {
        self.inner.load(cohort)
    }

    fn advance(&mut self, stop: Stop) -> Result<&[LearnerState], BackendError> {
        if let Some(trial) = self.before.filter(|trial| stop.trial > *trial) {
            let mut cohort = self.inner.memory()?.clone();
            assert!(cohort.states.iter().all(|state| state.trial == trial));
            cohort.nets[self.victim * cohort.nets_stride + self.word] = self.value;
            self.inner.load(cohort)?;
            self.before = None;
        }
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

/// Untaught docking in a small world: a millisecond for each learner.
pub(crate) fn plan(seeds: &str) -> Plan {
    let set = [
        "world=../tests/support/small.toml",
        "arms=['untaught-adam']",
        "skill.dock.trials=4",
        "skill.dock.max_steps=9",
        "learning.replays=3",
        "evaluate.at=[0, 2]",
        "evaluate.episodes=2",
        "teacher.eval_episodes=2",
        "teacher.lessons=16",
    ];
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let set = set.iter().map(|key| (*key).to_owned()).collect();
    load(&path, &Overrides { set, seeds: Some(seeds.to_owned()), ..Overrides::default() }).expect("a plan")
}

pub(crate) fn only_group(plan: &Plan) -> BatchGroup {
    let mut groups = groups(plan).expect("a group");
    assert_eq!(groups.len(), 1);
    groups.remove(0)
}

fn cpu() -> Box<dyn Backend> {
    Box::new(cpu_backend(2, None).expect("threads"))
}

/// Word of a learner's nets at which the weight of an input to a hidden unit of a child's net stands.
fn weight(group: &BatchGroup, child: usize, input: usize, unit: usize) -> usize {
    let skill = &group.shape.skills[0];
    skill.net_offset(child as u32) + 32 * input + unit
}

fn bytes(result: &LearnerResult) -> Vec<u8> {
    encode(std::slice::from_ref(result)).expect("bytes")
}

/// Trains the plan's learners with one of them poisoned before its third trial.
fn poisoned(plan: &Plan, group: &BatchGroup, inner: Box<dyn Backend>, victim: usize) -> (Vec<LearnerResult>, Cohort) {
    let word = weight(group, 3, 7, 5);
    let mut backend = Poisoner { inner, victim, word, value: f32::NAN, before: Some(2) };
    let results = train(plan, group, &group.learners(plan), &|_| None, None, &mut backend, &mut ()).expect("it trains");
    assert_eq!(backend.before, None);
    let memory = backend.memory().expect("memory").clone();
    (results, memory)
}

/// The first replayed step after the poison, read from the learner's memory as the record says it is laid out.
fn check(plan: &Plan, group: &BatchGroup, memory: &Cohort, failure: &Divergence, victim: usize) {
    assert_eq!((failure.arm.as_str(), failure.seed, failure.point), ("untaught-adam", plan.seeds[victim], 0));
    // Two trials finished, and the third acted out.
    assert_eq!((failure.skill.as_str(), failure.trial), ("dock", 2));
    assert!(failure.what.contains("Q-value"), "{}", failure.what);
    let found = failure.weight.as_ref().expect("a weight");
    assert_eq!((found.tensor.as_str(), found.index.as_slice()), ("dock.q.turn-60.0.weight", &[5, 7][..]));
    assert!(found.value.0.is_nan());
    let transition = failure.transition.as_ref().expect("a transition");
    let wild: Vec<usize> = (0..6).filter(|child| !transition.q[*child].0.is_finite()).collect();
    assert_eq!((transition.q.len(), wild), (6, vec![3]));
    assert!(!transition.taught && transition.lesson < 3, "{transition:?}");
    let shape = &group.shape.skills[0];
    let lessons = &memory.lessons[victim * memory.lessons_stride..][..memory.lessons_stride];
    let lesson = &lessons[(shape.memory_offset + transition.lesson * shape.lesson_stride) as usize..];
    // Replay goes from the last step to the first.
    assert_eq!(transition.step, lesson[0] - 1);
    let record = &lesson[LESSON_HEADER_WORDS + (transition.step * shape.record_words) as usize..];
    assert_eq!(transition.record, record[..shape.record_words as usize]);
    let children = ["turn+15", "turn-15", "turn+60", "turn-60", "move+12", "move-12"];
    assert_eq!(transition.child, children[(record[8] & 0xff) as usize]);
    // Nothing follows the last step: its target is its reward, a hundredth of it and inside the nets' range.
    let expected = (f32::from_bits(record[9]) / 100.0).clamp(-0.99, 0.99);
    assert!((transition.target.0 - expected).abs() < 1e-6, "{} for {expected}", transition.target.0);
    assert!(transition.inputs.len() == 52 && transition.inputs.iter().all(|input| input.0.abs() <= 1.0));
}

#[test]
fn one_poisoned_learner_of_4096_is_named_and_the_others_do_not_notice() {
    let plan = plan("0..4096");
    let group = only_group(&plan);
    let sound = train(&plan, &group, &group.learners(&plan), &|_| None, None, &mut *cpu(), &mut ()).expect("it trains");
    assert!(sound.iter().all(|result| result.divergence.is_none()));
    let victim = 2731;
    let (results, memory) = poisoned(&plan, &group, cpu(), victim);
    for (index, (own, other)) in sound.iter().zip(&results).enumerate().filter(|(index, _)| *index != victim) {
        assert!(other.divergence.is_none(), "{index}");
        assert!(bytes(own) == bytes(other), "{index}");
    }
    let failed = &results[victim];
    check(&plan, &group, &memory, failed.divergence.as_ref().expect("a failure"), victim);
    // What was before stays, what would have come after is absent.
    assert_eq!(failed.tests[..], sound[victim].tests[..2]);
    assert_eq!(sound[victim].tests.len(), 3);
    assert_eq!((failed.rows.len(), failed.rows[..16].to_vec()), (24, sound[victim].rows[..16].to_vec()));
}

#[test]
#[cfg(feature = "gpu")]
fn a_gpu_finds_the_same_failure() {
    let plan = plan("0..6");
    let group = only_group(&plan);
    let gpu = GpuBackend::new(&GpuOptions::default()).expect("an adapter, if only a software one");
    let (found, memory) = poisoned(&plan, &group, Box::new(gpu), 4);
    check(&plan, &group, &memory, found[4].divergence.as_ref().expect("a failure"), 4);
    let (expected, _) = poisoned(&plan, &group, cpu(), 4);
    for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
        assert_eq!(found.divergence, expected.divergence, "{index}");
        assert!(bytes(found) == bytes(expected), "{index}");
    }
}

/// Nobody replays with it: the weight alone shows that something is wrong.
#[test]
fn what_the_last_update_spoils_is_found_before_the_test() {
    let plan = plan("0..2");
    let group = only_group(&plan);
    let skill = &group.shape.skills[0];
    let (inputs, rows) = (skill.inputs as usize, skill.rows as usize);
    let cases = [
        (weight(&group, 0, 0, 31), "turn+15.0.weight", vec![31, 0]),
        (weight(&group, 4, inputs, 2), "move+12.0.bias", vec![2]),
        (weight(&group, 5, inputs + 1, 9), "move-12.2.weight", vec![0, 9]),
        (weight(&group, 1, rows - 1, 0), "turn-15.2.bias", vec![0]),
    ];
    for (word, tensor, index) in cases {
        let mut backend = cpu_backend(1, Some(1)).expect("threads");
        backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
        let after = Stop { skill: 0, trial: 2 };
        // All three replays of the second trial are over, one iteration later the learner would wait for its test.
        let over = |state: &LearnerState| {
            (state.phase, state.trial, state.replay, state.replay_left) == (PHASE_REPLAY, 1, 3, 0)
        };
        while !over(&backend.advance(after).expect("it runs")[0]) {}
        let mut cohort = backend.memory().expect("memory").clone();
        cohort.nets[word] = f32::INFINITY;
        backend.load(cohort).expect("memory");
        while !backend.advance(after).expect("it runs").iter().all(|state| after.holds(state)) {}
        let memory = backend.memory().expect("memory");
        assert_eq!((memory.states[0].phase, memory.states[0].trial), (PHASE_FAILED, 2));
        assert_ne!(memory.states[1].phase, PHASE_FAILED);
        let ids = group.learners(&plan);
        assert_eq!(divergence_of(&plan, memory, 1, ids[1]), None);
        let failure = divergence_of(&plan, memory, 0, ids[0]).expect("a failure");
        assert!(failure.what.contains("weight") && failure.trial == 2, "{failure:?}");
        let found = failure.weight.expect("a weight");
        assert_eq!((found.tensor, found.index), (format!("dock.q.{tensor}"), index));
        assert_eq!(found.value, Number(f32::INFINITY));
        // The step that was learned last: the first one of its lesson.
        assert_eq!(failure.transition.expect("a transition").step, 0);
    }
}

#[derive(Default)]
struct Listener {
    diverged: Vec<Divergence>,
}

impl Callbacks for Listener {
    fn progress(&mut self, _trials: u64) -> Signal {
        Signal::Continue
    }

    fn diverged(&mut self, divergence: &Divergence) {
        self.diverged.push(divergence.clone());
    }
}

#[test]
fn a_run_lists_its_failures() {
    let plan = plan("3..9");
    let group = only_group(&plan);
    let parent = TempDir::new().expect("a folder");
    let dir = parent.path().join("run");
    let worlds: Vec<(&str, &str)> = plan.worlds.iter().map(|w| (w.file.as_str(), w.text.as_str())).collect();
    let folder = RunFolder::open(&dir, &plan.resolved, &worlds).expect("a run folder");
    let word = weight(&group, 3, 7, 5);
    let mut backend = Poisoner { inner: cpu(), victim: 2, word, value: f32::NEG_INFINITY, before: Some(2) };
    let mut listener = Listener::default();
    let options = Options { cohort: Some(6), ..Options::default() };
    run(&plan, &[group], folder, &mut backend, options, Provenance::default(), &mut listener).expect("it runs");
    let finished = FinishedRun::read(&dir).expect("complete");
    let failures: Vec<Divergence> = finished.json().expect("a list").unwrap_or_default();
    assert_eq!((failures.len(), failures[0].seed, failures[0].trial), (1, 5, 2));
    assert_eq!(failures, listener.diverged);
    let notes = &finished.manifest().provenance.notes;
    assert!(notes.values().any(|note| note.contains("1 of 6") && note.contains("failures.json")), "{notes:?}");
    let (_, rows) = read_evaluations(&dir.join(EVALUATIONS)).expect("tests");
    let tested = |seed: u32| {
        let mut trials: Vec<u32> =
            rows.iter().filter(|r| r.arm == "untaught-adam" && r.seed == seed).map(|r| r.trials).collect();
        trials.dedup();
        trials
    };
    assert_eq!((tested(4), tested(5)), (vec![0, 2, 4], vec![0, 2]));
    let (_, rows) = read_trials(&dir.join(TRIALS)).expect("trials");
    let trials = |seed: u32| rows.iter().filter(|row| row.seed == seed).count();
    assert_eq!((trials(4), trials(5)), (4, 3));
}
