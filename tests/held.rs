//! Weights that lie in workgroup memory while a learner replays: no byte depends on whether they do, and what is not
//! written back is found out.
//!
//! A machine without any adapter fails these tests: install software Vulkan (mesa-vulkan-drivers). Nothing
//! here is skipped.
#![cfg(feature = "gpu")]

use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::gpu::source::{ADVANCE, Kernel, Part};
use skilltree::backend::gpu::workgroup_weights::{holders, wanted};
use skilltree::backend::gpu::{GpuBackend, GpuOptions};
use skilltree::backend::{Cohort, parity};
use skilltree::config::{Overrides, load};
use skilltree::layout::LearnerState;
use skilltree::layout::phase::PHASE_FAILED;
use skilltree::train::parity::{Sample, Work, train};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Drivers are tested one user at a time.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn alone() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Learners of a config with some keys set, before training.
fn cohort(config: &str, set: &[&str], learners: usize) -> Cohort {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(config);
    let set = set.iter().map(|&key| key.to_owned()).collect();
    let plan = load(&path, &Overrides { set, ..Overrides::default() }).expect("the config is good");
    Work::new(&plan, learners).expect("the experiment can be set up").cohorts()[0].clone()
}

/// Three learners of one skill, one for each optimiser, with some keys set.
fn docking(set: &[&str]) -> Cohort {
    let arms = "arms=['taught-adam', 'taught-sgd', 'taught-td0']";
    let rows = "arm.taught-td0.learning.optimiser='adam-rows'";
    let set = [&[arms, rows, "skill.dock.trials=2", "skill.dock.max_steps=12"], set].concat();
    let cohort = cohort("configs/docking.toml", &set, 3);
    let mut optimisers: Vec<u32> = cohort.params.iter().map(|params| params.optimiser).collect();
    optimisers.sort_unstable();
    assert_eq!(optimisers, [0, 1, 2]);
    cohort
}

/// Six nets of 16 units, which fit any device.
fn lean() -> Cohort {
    docking(&["learning.hidden=16"])
}

fn on_cpu(cohort: &Cohort) -> Sample {
    train(cohort.clone(), &mut CpuBackend::new(0, None).expect("threads")).expect("it runs")
}

fn open(held: Option<u32>, iterations: Option<u32>) -> GpuBackend {
    let options = GpuOptions { held, iterations, shard: Some(2), ..GpuOptions::default() };
    GpuBackend::new(&options).expect("an adapter, if only a software one")
}

#[test]
fn a_tree_that_is_held_in_part_leaves_the_bytes_of_the_cpu() {
    let _alone = alone();
    let tree = cohort("tests/support/tree.toml", &[], 4);
    let expected = on_cpu(&tree);
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
    let _alone = alone();
    // 32 units take twice as much: one net for all actions.
    let wide = docking(&["learning.shared_net=true"]);
    for cohort in [lean(), wide] {
        let expected = on_cpu(&cohort);
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
    let _alone = alone();
    let mut cohort = lean();
    for params in &mut cohort.params[1..] {
        params.learning_rate = 3.0e38;
    }
    let expected = on_cpu(&cohort);
    let after = &expected.cohorts()[0];
    let failed = |state: &LearnerState| state.phase == PHASE_FAILED && state.replay_left > 0 && state.updates > 0;
    assert_eq!(after.states.iter().map(failed).collect::<Vec<_>>(), [false, true, true]);
    let found = train(cohort.clone(), &mut open(None, None)).expect("it runs");
    assert_eq!(parity::advance(after, &found.cohorts()[0]), None);
}

/// The shipped kernel with another statement in place of one.
fn broken(from: &str, to: &str) -> Kernel {
    let part = |part: &Part| {
        if part.path != "kernels/train.wgsl" {
            return *part;
        }
        assert_eq!(part.text.matches(from).count(), 1, "`{from}` must stand in {} once", part.path);
        Part { path: part.path, text: part.text.replace(from, to).leak() }
    };
    Kernel { parts: ADVANCE.parts.iter().map(part).collect::<Vec<_>>().leak(), ..ADVANCE }
}

/// Compiling a kernel takes software adapters many seconds, so the faults are few and small.
#[test]
fn weights_that_are_not_written_back_are_found_out() {
    const BACK: &str = "nets[net + row * LANES + lane] = held[(number * rows + row) * units + lane];";
    let _alone = alone();
    let cohort = lean();
    let expected = on_cpu(&cohort);
    let mut gpu = open(None, None);
    for (lacking, kernel) in [
        // The bias of one hidden unit.
        ("a bias", broken(BACK, &format!("if lane != 15u || row != skills[skill].inputs {{ {BACK} }}"))),
        // At the end of a dispatch alone.
        (
            "the end of a dispatch",
            broken("    let_go(lane, base);\n    state.agent = agent;", "    state.agent = agent;"),
        ),
    ] {
        gpu.replace(kernel);
        let found = train(cohort.clone(), &mut gpu).expect("it runs");
        let found = parity::advance(&expected.cohorts()[0], &found.cohorts()[0]);
        let found = found.unwrap_or_else(|| panic!("without {lacking} nothing differs"));
        assert!(found.field.starts_with("nets word ") || found.field.starts_with("state "), "{found}");
    }
    gpu.replace(ADVANCE);
    assert_eq!(expected.difference(&train(cohort, &mut gpu).expect("it runs")), None);
}
