//! No dispatch takes more loop turns than are counted for it beforehand.

use super::adapter::{gpu, opened};
use super::broken::rewritten;
use super::work::{END, TREE, work};
use skilltree::backend::gpu::GpuOptions;
use skilltree::backend::gpu::dispatch_size::iteration_turns;
use skilltree::backend::gpu::source::{Kernel, Part, TRAIN};
use skilltree::backend::gpu::workgroup_weights::holders;
use skilltree::backend::{Backend, Cohort};

/// The kernel with the turns of all its loops counted where the updates stood: the most of any dispatch.
fn counting(kernel: Kernel) -> Kernel {
    const TURN: &str = "turned += 1u;\n";
    let part = |part: &Part| {
        let mut code = part.text.lines().filter(|line| !line.trim_start().starts_with("//"));
        assert!(!code.any(|line| line.contains("while ") || line.contains("loop {")), "{}", part.path);
        // Once for each turn, and once for the test that ends the loop.
        let line = |line: &str| {
            if line.trim_start().starts_with("for (") { format!("{TURN}{line}\n{TURN}") } else { format!("{line}\n") }
        };
        let mut text: String = part.text.lines().map(line).collect();
        if part.path == "kernels/train.wgsl" {
            let from = "states[learner] = state;";
            let to = "state.updates = max(states[learner].updates, turned);";
            text = text.replace(from, &format!("{to}\n{from}")) + "var<private> turned: u32;\n";
        }
        text
    };
    rewritten(kernel, part)
}

#[test]
fn no_iteration_takes_more_turns_than_the_governor_counts() {
    let _alone = gpu();
    let single = GpuOptions { iterations: Some(1), ..GpuOptions::default() };
    let mut gpu = opened(&single);
    gpu.replace(counting(TRAIN));
    let mut most = |cohort: &Cohort| {
        gpu.load(cohort.clone()).expect("it fits");
        while !gpu.advance(END).expect("it runs").iter().all(|state| END.holds(state)) {}
        let states = gpu.advance(END).expect("it runs");
        (states.iter().map(|state| state.updates).max().expect("learners"), gpu.held())
    };
    // Nets of 16 units lie in workgroup memory while they are replayed: that makes the dearest iteration.
    let lean = work("configs/docking.toml", &["learning.hidden=16"], 6);
    for (cohort, replayed) in [(&TREE.cohorts()[0], false), (&lean.cohorts()[0], true)] {
        let (seen, held) = most(cohort);
        let holders = holders(cohort, held);
        let counted = iteration_turns(&cohort.shared, holders);
        assert!(seen <= counted && 5 * seen > 4 * counted, "{seen} turns of {counted}");
        assert_eq!(counted > iteration_turns(&cohort.shared, 0), replayed, "{holders:b}");
    }
}
