//! The tuned forms of the CPU against the plain twins, byte by byte: each hot function by itself, then whole cohorts. A
//! fault beside each shows that the comparison sees one last place.

mod backends;
mod bodies;
mod differences;
mod nets;

use skilltree::backend::cpu::CPU;
use skilltree::env::workgroup::HotForms;
use skilltree::kernels::plain::PLAIN;

/// Of the outcomes of two forms, how many differ.
fn differing<T>(cases: &[T], left: &HotForms, right: &HotForms, outcome: impl Fn(&HotForms, &T) -> Vec<u32>) -> usize {
    cases.iter().filter(|case| outcome(left, case) != outcome(right, case)).count()
}

/// The tuned form leaves the words of the plain one in all cases; one with a fault does not.
#[track_caller]
fn compare<T>(cases: &[T], faulty: &HotForms, outcome: impl Fn(&HotForms, &T) -> Vec<u32>) {
    assert_eq!(differing(cases, &PLAIN, &CPU.hot, &outcome), 0, "of {} cases", cases.len());
    assert!(differing(cases, &PLAIN, faulty, &outcome) > 0, "nobody notices the fault");
}

/// The number beside this one.
fn beside(number: f32) -> f32 {
    f32::from_bits(number.to_bits() ^ 1)
}
