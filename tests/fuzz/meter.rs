//! What an execution costs and whether it panics.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::{Cell, RefCell};
use std::io::Write;
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;
use std::time::{Duration, Instant};

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
    static MEASURING: Cell<bool> = const { Cell::new(false) };
    static NUMBER: Cell<u64> = const { Cell::new(0) };
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// A request beyond this is refused, as a small machine would refuse it.
const REFUSED: usize = 1 << 30;

/// The system's allocator, with a count of what each thread holds.
struct Counting;

fn count(bytes: isize) {
    let held = HELD.get() + bytes;
    HELD.set(held);
    PEAK.set(PEAK.get().max(held));
}

/// Most programs end when a request is refused: the number of the input is said before.
fn refused(layout: Layout) -> bool {
    let refused = MEASURING.get() && layout.size() > REFUSED;
    if refused {
        let _ = writeln!(std::io::stderr(), "input {} asks for {} bytes", NUMBER.get(), layout.size());
    }
    refused
}

// SAFETY: every request goes to the system's allocator as it is, or is refused.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if refused(layout) {
            return std::ptr::null_mut();
        }
        count(layout.size().cast_signed());
        // SAFETY: the caller's promise is handed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if refused(layout) {
            return std::ptr::null_mut();
        }
        count(layout.size().cast_signed());
        // SAFETY: the caller's promise is handed on.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-layout.size().cast_signed());
        // SAFETY: the caller's promise is handed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// What became of one execution.
pub(crate) struct Execution<T> {
    /// What it gave, or the text and place of its panic.
    pub(crate) outcome: Result<T, String>,
    /// Most bytes that it held at a time, beyond what was held before.
    pub(crate) bytes: usize,
    pub(crate) time: Duration,
}

/// Executes and watches input `number`. Panics print nothing.
pub(crate) fn watch<T>(number: u64, execute: impl FnOnce() -> T) -> Execution<T> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| match MEASURING.get() {
            true => PANIC.set(info.to_string()),
            false => usual(info),
        }));
    });
    let before = HELD.get();
    PEAK.set(before);
    PANIC.take();
    NUMBER.set(number);
    MEASURING.set(true);
    let started = Instant::now();
    let outcome = panic::catch_unwind(AssertUnwindSafe(execute));
    let time = started.elapsed();
    MEASURING.set(false);
    let bytes = (PEAK.get() - before).max(0).cast_unsigned();
    Execution { outcome: outcome.map_err(|_| PANIC.take()), bytes, time }
}

/// Time that this thread has been executed: on a busy machine it also waits for its turn, which no reader can help. None
/// where the system does not tell.
pub(crate) fn executed() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(Duration::from_nanos(text.split_whitespace().next()?.parse().ok()?))
}
