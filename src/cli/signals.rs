//! Signals that ask a run to stop: Ctrl-C, and what `kill` and schedulers send.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Listens from its making to its end. The first signal is noted; the second one ends the program at once, as does any
/// that comes afterwards.
#[derive(Debug)]
pub(super) struct Signals {
    asked: Arc<AtomicBool>,
    /// Whether a signal does what it does by default.
    deadly: Arc<AtomicBool>,
}

impl Signals {
    /// Begins to listen.
    ///
    /// # Errors
    /// Where the operating system refuses.
    pub(super) fn listen() -> io::Result<Self> {
        let (asked, deadly) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicBool::new(false)));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the signal that sets the flag does not see it set.
            flag::register_conditional_default(signal, Arc::clone(&deadly))?;
            flag::register(signal, Arc::clone(&deadly))?;
            flag::register(signal, Arc::clone(&asked))?;
        }
        Ok(Self { asked, deadly })
    }

    /// Whether a signal has come.
    pub(super) fn asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed)
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        self.deadly.store(true, Ordering::Relaxed);
    }
}
