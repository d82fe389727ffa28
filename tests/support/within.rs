//! A tiny experiment that runs within the test's own process, on any disk.

use skilltree::backend::cpu::cpu_backend;
use skilltree::config::plan::Plan;
use skilltree::config::{Overrides, load};
use skilltree::run_folder::file_system::FileSystem;
use skilltree::run_folder::{Provenance, RunFolder, State};
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::callbacks::{Callbacks, Signal};
use skilltree::train::run::{Options, RunError, run};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Two learners of one skill in the small world, a few milliseconds of work.
const CUTS: [&str; 7] = [
    "world=../tests/support/small.toml",
    "arms=['taught-adam']",
    "skill.dock.trials=2",
    "evaluate.at=[0, 2]",
    "evaluate.episodes=3",
    "teacher.eval_episodes=4",
    "teacher.lessons=16",
];

/// An experiment that is ready to run.
pub(crate) struct Experiment {
    pub(crate) plan: Plan,
    pub(crate) groups: Vec<BatchGroup>,
}

struct Impatient;

impl Callbacks for Impatient {
    fn progress(&mut self, _: u64) -> Signal {
        Signal::Stop
    }
}

impl Experiment {
    pub(crate) fn tiny() -> Self {
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
        let set = CUTS.iter().map(|&cut| cut.to_owned()).collect();
        let plan = load(&config, &Overrides { set, seeds: Some("0..2".to_owned()), ..Overrides::default() }).unwrap();
        let groups = groups(&plan).unwrap();
        Self { plan, groups }
    }

    pub(crate) fn open(&self, disk: &Arc<dyn FileSystem>, dir: &Path) -> Result<RunFolder, RunError> {
        let worlds: Vec<(&str, &str)> = self.plan.worlds.iter().map(|world| (&*world.file, &*world.text)).collect();
        Ok(RunFolder::open_on(Arc::clone(disk), dir, &self.plan.resolved, &worlds)?)
    }

    /// What the program does between reading the config and reporting: a learner is a cohort, so that there are parts.
    pub(crate) fn run(&self, disk: &Arc<dyn FileSystem>, dir: &Path) -> Result<(), RunError> {
        self.watched(disk, dir, &mut ())
    }

    /// As [`Experiment::run`], but told to stop as soon as a learner has begun: a checkpoint is left.
    pub(crate) fn stop(&self, disk: &Arc<dyn FileSystem>, dir: &Path) -> Result<(), RunError> {
        self.watched(disk, dir, &mut Impatient)
    }

    fn watched(&self, disk: &Arc<dyn FileSystem>, dir: &Path, callbacks: &mut dyn Callbacks) -> Result<(), RunError> {
        let folder = self.open(disk, dir)?;
        if folder.state() == State::Complete {
            return Ok(());
        }
        let mut backend = cpu_backend(1, None).map_err(RunError::Backend)?;
        let provenance = Provenance { seeds: self.plan.seeds.clone(), ..Provenance::default() };
        let options = Options { cohort: Some(1), ..Options::default() };
        run(&self.plan, &self.groups, folder, &mut backend, options, provenance, callbacks)
    }
}

/// Where the tests put the run folder on a disk of their own.
pub(crate) fn folder() -> PathBuf {
    PathBuf::from("/runs/tiny")
}
