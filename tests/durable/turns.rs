//! How far a large cohort moves at a time.

use super::failures::{only_group, plan};
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::{Backend, Stop};

/// However slow the machine: the bound is a number of learners and not a time, for a turn that was over before it began
/// would look like a device that no longer computes.
#[test]
fn a_large_cohort_moves_some_learners_at_a_time() {
    let plan = plan("0..100");
    let group = only_group(&plan);
    let mut backend = cpu_backend(2, Some(1)).expect("threads");
    backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
    let stop = Stop { skill: 0, trial: 1 };
    let mut before = backend.memory().expect("memory").states.clone();
    let (mut calls, mut moved_later) = (0, 0);
    while !before.iter().all(|state| stop.holds(state)) {
        let after = backend.advance(stop).expect("it runs").to_vec();
        let waiting = before.iter().filter(|state| !stop.holds(state)).count();
        let moved: Vec<usize> = (0..100).filter(|learner| before[*learner] != after[*learner]).collect();
        assert_eq!(moved.len(), waiting.min(64), "call {calls}");
        moved_later += usize::from(moved.iter().any(|learner| *learner >= 64));
        (before, calls) = (after, calls + 1);
    }
    assert!(calls > 8 && moved_later > 0, "{calls} {moved_later}");
}
