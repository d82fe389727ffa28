//! How a run shows where it is: a bar on a terminal, a line per cohort otherwise.

use super::output::tell;
use crate::experiment::run::Observer;
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressStyle};
use std::io::IsTerminal;

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
}

impl RunProgress {
    /// For a run of so many learners and so many trials in all.
    pub(super) fn new(learners: usize, trials: u64) -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(trials);
            if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar
        });
        Self { bar, learners, trials, began: None }
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
    }

    fn committed(&mut self, finished: usize) {
        if self.bar.is_none() {
            tell(&format!("{finished} of {} learners trained, tested and saved", self.learners));
        }
    }
}
