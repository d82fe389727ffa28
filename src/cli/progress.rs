//! How a run shows where it is: a bar on a terminal, a line per cohort otherwise.

use super::console::tell;
use super::signals::Signals;
use crate::run_folder::{Divergence, RecordError};
use crate::train::callbacks::{Callbacks, Signal};
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::Path;

/// The message comes last, most important first: a narrow terminal cuts it, and never wraps it.
const TEMPLATE: &str = "{percent:>3} % [{bar:20}] {wide_msg}";

/// A run's progress on standard error.
#[derive(Debug)]
pub(super) struct RunProgress {
    bar: Option<ProgressBar>,
    learners: usize,
    trials: u64,
    /// Trials that were finished at the start.
    began: Option<u64>,
    signals: Signals,
    /// Whether the user knows that it is stopping.
    stopping: bool,
}

impl RunProgress {
    /// For a run of so many learners and so many trials in all, which these signals stop.
    pub(super) fn new(learners: usize, trials: u64, signals: Signals) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(trials);
            if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar
        });
        Self { bar, learners, trials, began: None, signals, stopping: false }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Tells something beside the bar.
    fn say(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| tell(text)),
            None => tell(text),
        }
    }
}

impl Callbacks for RunProgress {
    fn progress(&mut self, finished: u64) -> Signal {
        if let Some(bar) = &self.bar {
            bar.set_position(finished);
            let of = format!("{} of {} trials", HumanCount(finished), HumanCount(self.trials));
            match self.began {
                None => {
                    // What an earlier start did says nothing about the speed of this one.
                    bar.reset_eta();
                    bar.set_message(of);
                    self.began = Some(finished);
                }
                Some(first) if finished > first => {
                    bar.set_message(format!("{:#} left, {of}, {:.0}/s", HumanDuration(bar.eta()), bar.per_sec()));
                }
                Some(_) => {}
            }
        }
        if !self.signals.asked() {
            return Signal::Continue;
        }
        if !self.stopping {
            self.stopping = true;
            self.say("stopping: saving the learners in training; a second signal ends it at once");
        }
        Signal::Stop
    }

    fn committed(&mut self, finished: usize) {
        if self.bar.is_none() {
            tell(&format!("{finished} of {} learners trained, tested and saved", self.learners));
        }
    }

    fn diverged(&mut self, divergence: &Divergence) {
        let Divergence { arm, point, seed, skill, trial, what, .. } = divergence;
        let point = if *point > 0 { format!(", point {point}") } else { String::new() };
        self.say(&format!(
            "warning: arm `{arm}`{point}, seed {seed}: {what}, in skill `{skill}` after {trial} trials: the learner is \
             frozen there, and counts as a failure"
        ));
    }

    fn set_aside(&mut self, why: &RecordError, now: &Path) {
        self.say(&format!("warning: {why}\nnote: it is now {}", now.display()));
    }
}
