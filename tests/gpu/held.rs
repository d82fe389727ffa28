//! Weights that lie in workgroup memory while a learner replays: no byte depends on whether they do, and what is not
//! written back is found out.

use super::adapter::{gpu, opened};
use super::broken::broken;
use super::work::{on_host, optimisers, work};
use skilltree::backend::gpu::source::TRAIN;
use skilltree::backend::gpu::workgroup_weights::{holders, wanted};
use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use skilltree::backend::{Cohort, parity};
use skilltree::layout::{LearnerState, PHASE_FAILED};
use skilltree::train::parity::train;

/// Six nets of 16 units, which fit any device.
fn lean() -> Cohort {
    optimisers(&["learning.hidden=16"])
}

fn open(held: Option<u32>, iterations: Option<u32>) -> GpuBackend {
    opened(&GpuOptions { held, iterations, shard: Some(2), ..GpuOptions::default() })
}

#[test]
fn a_tree_that_is_held_in_part_leaves_the_bytes_of_the_cpu() {
    let _alone = gpu();
    let tree = work("tests/support/tree.toml", &[], 4).cohorts()[0].clone();
    let expected = on_host(&tree);
    // Half of the skills that are trained: 16 units beside 32, one net beside six, all optimisers.
    let sizes = wanted(&tree);
    let trained = holders(&tree, u32::MAX);
    for (held, iterations) in [(0, None), (sizes[sizes.len() / 2], Some(7))] {
        let mut gpu = open(Some(held), iterations);
        assert_eq!(
            expected.difference(&train(tree.clone(), &mut gpu).expect("it runs")),
            None,
            "{held} {iterations:?}"
        );
        let holders = holders(&tree, gpu.held());
        assert_eq!(gpu.held(), held.max(1));
        assert_eq!((holders != 0, holders != trained), (held > 0, true), "{holders:b} of {trained:b}");
    }
}

#[test]
fn every_optimiser_leaves_the_bytes_of_the_cpu() {
    let _alone = gpu();
    // 32 units take twice as much: one net for all actions.
    let wide = optimisers(&["learning.shared_net=true"]);
    for cohort in [lean(), wide] {
        let expected = on_host(&cohort);
        for iterations in [Some(3), None] {
            let mut gpu = open(None, iterations);
            let found = train(cohort.clone(), &mut gpu).expect("it runs");
            assert_eq!(expected.difference(&found), None, "{iterations:?}");
            assert_eq!((gpu.held(), holders(&cohort, gpu.held())), (wanted(&cohort)[0], 1));
        }
    }
}

/// A learning rate that drives weights beyond all numbers: the learner fails in the middle of a replay, after updates
/// that are in workgroup memory alone.
#[test]
fn a_learner_that_fails_leaves_the_bytes_of_the_cpu() {
    let _alone = gpu();
    let mut cohort = lean();
    for params in &mut cohort.params[1..] {
        params.learning_rate = 3.0e38;
    }
    let expected = on_host(&cohort);
    let after = &expected.cohorts()[0];
    let failed = |state: &LearnerState| state.phase == PHASE_FAILED && state.replay_left > 0 && state.updates > 0;
    assert_eq!(after.states.iter().map(failed).collect::<Vec<_>>(), [false, true, true]);
    let found = train(cohort.clone(), &mut open(None, None)).expect("it runs");
    assert_eq!(parity::advance(after, &found.cohorts()[0]), None);
}

/// Compiling a kernel takes software adapters many seconds, so the faults are few and small.
#[test]
fn weights_that_are_not_written_back_are_found_out() {
    const BACK: &str = "nets[net + row * LANES + lane] = held_weights[(number * rows + row) * units + lane];";
    let _alone = gpu();
    let cohort = lean();
    let expected = on_host(&cohort);
    let mut gpu = open(None, None);
    let but_a_bias = format!("if lane != 15u || row != skills[skill].inputs {{ {BACK} }}");
    for (lacking, fault) in [
        // The bias of one hidden unit.
        ("a bias", ("qnet/weights.wgsl", BACK, but_a_bias.as_str())),
        // At the end of a dispatch alone.
        ("the end of a dispatch", ("kernels/train.wgsl", "    release_weights(lane);\n    state", "    state")),
    ] {
        gpu.replace(broken(TRAIN, &[fault]));
        let found = train(cohort.clone(), &mut gpu).expect("it runs");
        let found = parity::advance(&expected.cohorts()[0], &found.cohorts()[0]);
        let found = found.unwrap_or_else(|| panic!("without {lacking} nothing differs"));
        assert!(found.field.starts_with("nets word ") || found.field.starts_with("state "), "{found}");
    }
    gpu.replace(TRAIN);
    assert_eq!(expected.difference(&train(cohort, &mut gpu).expect("it runs")), None);
}
