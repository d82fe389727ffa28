//! How a run shows where it is: a bar on a terminal, a line per cohort otherwise.

use crate::experiment::run::Observer;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;

/// A run's progress on standard error.
#[derive(Debug)]
pub(super) struct RunProgress {
    bar: Option<ProgressBar>,
    learners: usize,
}

impl RunProgress {
    /// For a run of so many learners and so many trials in all.
    pub(super) fn new(learners: usize, trials: u64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(trials);
            let template = "{bar:32} {percent:>3}%  {human_pos} of {human_len} trials, {per_sec}, {eta} left";
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        });
        Self { bar, learners }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Observer for RunProgress {
    fn trials(&mut self, finished: u64) {
        if let Some(bar) = &self.bar {
            bar.set_position(finished);
        }
    }

    fn committed(&mut self, _learners: usize, finished: usize) {
        if self.bar.is_none() {
            eprintln!("{finished} of {} learners trained and committed", self.learners);
        }
    }
}
