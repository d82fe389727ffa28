//! The facade: an experiment is loaded, run into a folder, and what it left is opened.

use crate::backend::Backend;
use crate::config::plan::{ArmPlan, Plan};
use crate::config::{ConfigError, Files, OsFiles, Overrides, load_from};
use crate::run_folder::{FinishedRun, Provenance, RecordError, RunFolder, State};
use crate::train::batch_group::{BatchGroup, SetupError, groups};
use crate::train::callbacks::{Callbacks, Signal};
use crate::train::run::{Options, RunError, run};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::SystemTime;

/// Why an experiment has no results.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// The run folder is another experiment's, in use, or cannot be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A skill of it does not fit the layout or the world, or cannot be taught.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Training ended early; what was finished is kept, and the same call goes on.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Trials finished by all learners together, those of an earlier start included.
    pub finished: u64,
    /// Trials of all learners together.
    pub trials: u64,
}

/// A config that was read and checked: worlds, conditions, skills, seeds.
#[derive(Debug, Clone)]
pub struct Experiment {
    plan: Plan,
}

impl Experiment {
    /// Reads a config file with the worlds and configs that it names; `overrides` is what a command line might change.
    ///
    /// # Errors
    /// [`ConfigError`] says where the file is wrong, and what would be right.
    pub fn load(config: impl AsRef<Path>, overrides: &Overrides) -> Result<Self, ConfigError> {
        Self::load_from(&OsFiles, config, overrides)
    }

    /// The same from any source of files, such as [`MemoryFiles`](crate::MemoryFiles).
    ///
    /// # Errors
    /// As [`Experiment::load`].
    pub fn load_from(files: &dyn Files, config: impl AsRef<Path>, overrides: &Overrides) -> Result<Self, ConfigError> {
        Ok(Self { plan: load_from(files, config.as_ref(), overrides)? })
    }

    /// All that the config says, with every default and derived size.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Independent learners: conditions x sweep points x seeds.
    pub fn learners(&self) -> usize {
        self.plan.arms.len() * self.plan.seeds.len()
    }

    /// Training trials of all learners together.
    pub fn trials(&self) -> u64 {
        self.plan.arms.iter().map(ArmPlan::trials).sum::<u64>() * self.plan.seeds.len() as u64
    }

    /// Trains and tests every learner and writes all results into the folder `out`. A run that was interrupted there goes
    /// on; one that is complete is only opened. `progress` is told how far it is, and ends the run, with everything saved,
    /// by [`ControlFlow::Break`].
    ///
    /// # Errors
    /// Where the experiment, the folder or the device fails, or `progress` ends the run.
    pub fn run(
        &self,
        out: impl AsRef<Path>,
        backend: &mut dyn Backend,
        progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<FinishedRun, ExperimentError> {
        let folder = self.open_folder(out.as_ref())?;
        if folder.state() == State::Complete {
            drop(folder);
        } else {
            let groups = groups(&self.plan)?;
            let mut callback = ProgressCallback { call: progress, trials: self.trials() };
            self.train(&groups, folder, backend, Options::default(), &mut callback)?;
        }
        Ok(FinishedRun::read(out.as_ref())?)
    }

    /// Opens or makes the folder of a run of this experiment, and holds it against other processes.
    ///
    /// # Errors
    /// Where another experiment or process has it.
    pub fn open_folder(&self, out: &Path) -> Result<RunFolder, RecordError> {
        let worlds: Vec<(&str, &str)> = self.plan.worlds.iter().map(|world| (&*world.file, &*world.text)).collect();
        RunFolder::open(out, &self.plan.resolved, &worlds)
    }

    /// Trains every learner that the folder does not hold yet, and completes the folder.
    ///
    /// # Errors
    /// Where the folder or the device fails, or the callbacks stop it.
    pub fn train(
        &self,
        groups: &[BatchGroup],
        folder: RunFolder,
        backend: &mut dyn Backend,
        options: Options,
        callbacks: &mut dyn Callbacks,
    ) -> Result<(), RunError> {
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("SKILLTREE_COMMIT").map(str::to_owned),
            backend: backend.kind().to_owned(),
            adapter: backend.adapter(),
            seeds: self.plan.seeds.clone(),
            started: Some(humantime::format_rfc3339_seconds(SystemTime::now()).to_string()),
            finished: None,
            notes: BTreeMap::from([("executed by".to_owned(), backend.describe())]),
        };
        run(&self.plan, groups, folder, backend, options, provenance, callbacks)
    }
}

/// Tells a function how a run goes.
struct ProgressCallback<F> {
    call: F,
    trials: u64,
}

impl<F: FnMut(Progress) -> ControlFlow<()>> Callbacks for ProgressCallback<F> {
    fn progress(&mut self, finished: u64) -> Signal {
        match (self.call)(Progress { finished, trials: self.trials }) {
            ControlFlow::Continue(()) => Signal::Continue,
            ControlFlow::Break(()) => Signal::Stop,
        }
    }
}
