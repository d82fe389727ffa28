//! The benchmark's clock of CPU time. It counts all threads of the process, hence a process with nothing else in it.
#![cfg(unix)]

use skilltree::bench::timing::{Elapsed, timed};
use std::time::Duration;

/// How long it takes `threads` threads to do the same work each.
fn work(threads: usize) -> Elapsed {
    let spin = || {
        let mut state = std::hint::black_box(1_u32);
        for _turn in 0..20_000_000 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        }
        std::hint::black_box(state);
    };
    let all = || {
        std::thread::scope(|scope| {
            for _thread in 0..threads {
                scope.spawn(spin);
            }
        });
    };
    timed(all).1
}

#[test]
fn cpu_time_counts_all_threads_and_no_sleep() {
    let asleep = timed(|| std::thread::sleep(Duration::from_millis(50))).1;
    assert!(asleep.wall >= 0.05 && asleep.cpu < 0.5 * asleep.wall, "{asleep:?}");
    let (one, four) = (work(1), work(4));
    assert!(four.cpu > 2.0 * one.cpu, "{four:?} {one:?}");
}
