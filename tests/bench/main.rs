//! The benchmark tells no rate of wrong results, its JSON is what is documented, and what it exports is what it says.

mod export;

use serde_json::Value;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::host::HostBackend;
use skilltree::backend::{Backend, BackendError, Cohort, Stop, Test};
use skilltree::bench::BenchError;
use skilltree::bench::benchmarks::{BenchSizes, Benchmark, HierarchyLearners, UpdateRule};
use skilltree::bench::benchmarks::{decisions, robot_steps, transitions};
use skilltree::bench::embedded_configs::HIERARCHY;
use skilltree::bench::executor::{Executor, ExecutorKind};
use skilltree::bench::measure::measure;
use skilltree::bench::result::{BenchReport, TaskReport};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{Episode, LearnerState, Robot};
use std::ops::Range;
use std::process::Command;

/// What a broken backend does wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    None,
    Robot,
    Weight,
    Episode,
}

/// The CPU backend with one bit wrong in one of its results.
struct Broken {
    inner: HostBackend,
    fault: Fault,
    cohort: Option<Cohort>,
}

fn broken(fault: Fault) -> Executor {
    let inner = cpu_backend(1, None).expect("a thread");
    Executor::new("broken", ExecutorKind::Cpu, 1, Box::new(Broken { inner, fault, cohort: None }))
}

fn flip(value: &mut f32) {
    *value = f32::from_bits(value.to_bits() ^ 1);
}

impl Backend for Broken {
    fn describe(&self) -> String {
        "broken".to_owned()
    }
    fn kind(&self) -> &'static str {
        "cpu"
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
        self.inner.advance(stop)
    }
    fn learners(&self) -> usize {
        self.inner.learners()
    }
    fn evaluate_some(&mut self, test: Test, learners: Range<usize>) -> Result<Vec<Episode>, BackendError> {
        let mut episodes = self.inner.evaluate_some(test, learners)?;
        if self.fault == Fault::Episode {
            flip(&mut episodes[0].agent.x);
        }
        Ok(episodes)
    }
    fn memory(&mut self) -> Result<&Cohort, BackendError> {
        let mut cohort = self.inner.memory()?.clone();
        if self.fault == Fault::Weight {
            flip(&mut cohort.nets[0]);
        }
        Ok(self.cohort.insert(cohort))
    }
    fn step(&mut self, shared: &CohortData, robots: &mut [Robot], iterations: u32) -> Result<(), BackendError> {
        self.inner.step(shared, robots, iterations)?;
        if self.fault == Fault::Robot {
            flip(&mut robots[17].heading);
        }
        Ok(())
    }
}

fn beside_broken(benchmark: &Benchmark<'_>, fault: Fault) -> Result<TaskReport, BenchError> {
    let sound = cpu_backend(1, None).expect("a thread");
    let sound = Executor::new("sound", ExecutorKind::Reference, 1, Box::new(sound));
    measure(benchmark, &mut [sound, broken(fault)], 1)
}

#[test]
fn one_wrong_bit_leaves_no_rate() {
    let hierarchy = HierarchyLearners::new(HIERARCHY, &[], 2).expect("the built-in experiment");
    let steps = robot_steps(BenchSizes::TINY, 1).expect("robots");
    let transitions = transitions(BenchSizes::TINY, UpdateRule::ALL[0]).expect("learners");
    let decisions = decisions(&hierarchy, BenchSizes::TINY);
    for (benchmark, fault) in [(steps, Fault::Robot), (transitions, Fault::Weight), (decisions, Fault::Episode)] {
        let benchmark = &benchmark;
        let task = beside_broken(benchmark, Fault::None).expect("the same bytes");
        let [sound, other] = &task.rows[..] else { panic!("{task:?}") };
        let ratio = other.per_cpu_second.median / sound.per_cpu_second.median;
        let told = other.over_reference.expect("both did the work").median;
        assert!((told / ratio - 1.0).abs() < 1.0e-6 && sound.over_reference.is_none(), "{task:?}");
        match beside_broken(benchmark, fault) {
            Err(BenchError::Differs { work, right, .. }) => {
                assert_eq!((work, right.as_str()), (benchmark.name, "broken"));
            }
            other => panic!("{}: {other:?}", benchmark.name),
        }
    }
}

#[test]
fn json_is_as_documented() {
    let words = ["bench", "--backend", "cpu", "--samples", "1", "--learners", "0", "--json"];
    let output = Command::new(env!("CARGO_BIN_EXE_skilltree")).args(words).output().expect("runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let report: BenchReport = serde_json::from_value(value.clone()).expect("the documented schema");
    assert_eq!(serde_json::to_value(&report).expect("JSON"), value);
    assert_eq!(report.format, 2);
    let names: Vec<&str> = report.tasks.iter().map(|task| task.name.as_str()).collect();
    let transitions = ["transitions-adam", "transitions-adam-rows", "transitions-few", "transitions-sgd"];
    assert_eq!(names, [&["robot-steps", "robot-steps-held"][..], &transitions, &["decisions"]].concat());
    for task in &report.tasks {
        assert_eq!(task.rows.len(), report.executors.len(), "{}", task.name);
        let one = task.rows.iter().find(|row| row.executor == "cpu-1").expect("one thread");
        // On one thread a CPU-second is no shorter than a second.
        assert!(one.per_cpu_second.median >= 0.95 * one.per_second.median, "{}: {one:?}", task.name);
        assert!(one.per_second.median > 1.0 && one.units > 0, "{}: {one:?}", task.name);
    }
}
