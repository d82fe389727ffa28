//! Work for backends, and what the backends of the host leave of it.

use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::host::HostBackend;
use skilltree::backend::reference::reference_backend;
use skilltree::backend::{Cohort, Stop};
use skilltree::config::{Overrides, load};
use skilltree::train::parity::{Sample, Work, train};
use std::ops::Range;
use std::path::Path;
use std::sync::LazyLock;

/// The point beyond every skill.
pub(crate) const END: Stop = Stop { skill: u32::MAX, trial: u32::MAX };

/// Learners of every arm, so both optimisers, taught and untaught.
pub(crate) static DOCKING: LazyLock<Work> = LazyLock::new(|| work("configs/docking.toml", &[], 6));

/// Two learners of each of four arms, over a tree of three levels.
pub(crate) static TREE: LazyLock<Work> = LazyLock::new(|| work("tests/support/tree.toml", &[], 8));

/// What the CPU leaves of the first five docking learners.
pub(crate) static FIVE: LazyLock<Sample> =
    LazyLock::new(|| train(some(&DOCKING.cohorts()[0], 0..5), &mut cpu()).expect("it runs"));

/// What the CPU leaves of the tree.
pub(crate) static GROWN: LazyLock<Sample> = LazyLock::new(|| TREE.run(&mut cpu()).expect("it runs"));

pub(crate) fn cpu() -> HostBackend {
    cpu_backend(0, None).expect("threads")
}

pub(crate) fn reference() -> HostBackend {
    reference_backend(0, None).expect("threads")
}

/// What both backends of the host leave of a cohort that trains: the same bytes.
#[track_caller]
pub(crate) fn on_host(cohort: &Cohort) -> Sample {
    let expected = train(cohort.clone(), &mut cpu()).expect("it runs");
    let plain = train(cohort.clone(), &mut reference()).expect("it runs");
    assert_eq!(expected.difference(&plain), None, "the reference differs from the CPU");
    expected
}

/// Work cut from a config of the project with some keys set.
pub(crate) fn work(config: &str, set: &[&str], learners: usize) -> Work {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(config);
    let set = set.iter().map(|&key| key.to_owned()).collect();
    let plan = load(&path, &Overrides { set, ..Overrides::default() }).unwrap_or_else(|error| panic!("{error}"));
    Work::new(&plan, learners).unwrap_or_else(|error| panic!("{error}"))
}

/// Three learners of one skill, one for each optimiser, with some keys set.
pub(crate) fn optimisers(set: &[&str]) -> Cohort {
    let arms = "arms=['taught-adam', 'taught-sgd', 'taught-td0']";
    let rows = "arm.taught-td0.learning.optimiser='adam-rows'";
    let set = [&[arms, rows, "skill.dock.trials=2", "skill.dock.max_steps=12"], set].concat();
    let cohort = work("configs/docking.toml", &set, 3).cohorts()[0].clone();
    let mut optimisers: Vec<u32> = cohort.params.iter().map(|params| params.optimiser).collect();
    optimisers.sort_unstable();
    assert_eq!(optimisers, [0, 1, 2]);
    cohort
}

/// Some learners of a cohort.
pub(crate) fn some(all: &Cohort, range: Range<usize>) -> Cohort {
    let part = |stride: usize| range.start * stride..range.end * stride;
    Cohort {
        shared: all.shared.clone(),
        params: all.params[part(all.skills)].to_vec(),
        states: all.states[range.clone()].to_vec(),
        nets: all.nets[part(all.nets_stride)].to_vec(),
        lessons: all.lessons[part(all.lessons_stride)].to_vec(),
        rows: all.rows[part(all.rows_stride)].to_vec(),
        ..*all
    }
}
