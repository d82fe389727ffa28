//! Runs of trees that are stopped at one look after another, or break down between two checkpoints.

use super::pretraining::{ARMS, NAMES, left, short};
use skilltree::backend::cpu::cpu_backend;
use skilltree::config::plan::Plan;
use skilltree::run_folder::{Provenance, RecordError, RunFolder};
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::callbacks::{Callbacks, Signal};
use skilltree::train::run::{Options, RunError, run};
use std::path::Path;
use std::time::Duration;
use tempfile::TempDir;

/// Stops a run after some looks, and remembers how far it was.
struct Looker {
    looks: usize,
    trials: Vec<u64>,
}

impl Callbacks for Looker {
    fn progress(&mut self, trials: u64) -> Signal {
        self.trials.push(trials);
        match self.looks.checked_sub(1) {
            Some(left) => {
                self.looks = left;
                Signal::Continue
            }
            None => Signal::Stop,
        }
    }

    fn set_aside(&mut self, why: &RecordError, _now: &Path) {
        panic!("{why}");
    }
}

fn attempt(
    plan: &Plan,
    groups: &[BatchGroup],
    dir: &Path,
    round: usize,
    looks: usize,
) -> (Result<(), RunError>, Vec<u64>) {
    let worlds: Vec<(&str, &str)> = plan.worlds.iter().map(|w| (w.file.as_str(), w.text.as_str())).collect();
    let folder = RunFolder::open(dir, &plan.resolved, &worlds).expect("a run folder");
    let mut backend = cpu_backend(1 + round % 3, Some([700, 90, 16_384][round % 3])).expect("threads");
    let mut looker = Looker { looks, trials: Vec::new() };
    let options = Options { cohort: Some([32, 4, 2][round % 3]), checkpoint: Some(Duration::from_millis(20)) };
    let outcome = run(plan, groups, folder, &mut backend, options, Provenance::default(), &mut looker);
    (outcome, looker.trials)
}

#[test]
fn a_tree_that_is_stopped_at_every_turn_leaves_the_same() {
    let altered =
        format!("{ARMS}\n[transfer.loud]\nnoise = {{ sonar = 0.5 }}\n[transfer.still]\nnoise = {{ sonar = 0.0 }}\n");
    let plan = short(&altered, &["seeds='0..2'"]);
    let all = groups(&plan).unwrap_or_else(|error| panic!("{error}"));
    let parent = TempDir::new().expect("a folder");
    let whole = parent.path().join("whole");
    attempt(&plan, &all, &whole, 0, usize::MAX).0.unwrap_or_else(|error| panic!("{error}"));
    let dir = parent.path().join("stopped");
    let (mut stops, mut reached) = (0, 0);
    loop {
        // The end asks once for each learner and is done in one go, so some attempts have to be longer than it takes.
        let (outcome, trials) = attempt(&plan, &all, &dir, stops, 1 + stops * 7 % 11 + stops / 10);
        // Nothing that was done is done again: the first look is as far as the last one was.
        assert!(trials.get(1).is_none_or(|first| *first >= reached), "{trials:?} after {reached}");
        reached = trials.last().copied().unwrap_or(0);
        match outcome {
            Err(RunError::Stopped { .. }) => stops += 1,
            Ok(()) => break,
            Err(error) => panic!("{error}"),
        }
        assert!(stops < 2000, "it never ends");
    }
    println!("{stops} stops");
    assert!(stops > 20, "{stops}");
    for arm in NAMES {
        let (found, expected) = (left(&dir, arm), left(&whole, arm));
        let differs: Vec<&String> = expected.keys().filter(|name| found.get(*name) != expected.get(*name)).collect();
        assert!(found.len() == expected.len() && differs.is_empty(), "{arm}: {differs:?}");
    }
}
