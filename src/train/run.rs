//! Runs an experiment into a run folder: cohort after cohort, each committed before the next begins.

use super::batch::{pretrain, train};
use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::callbacks::{Callbacks, Interrupted};
use super::checkpoint::{Checkpoint, CohortState};
use super::cohort_callbacks::{CohortCallbacks, INTERVAL, SaveTimer};
use super::committed::Parts;
use super::pretraining::{Pretrained, Pretraining, SharedSkills, shared_skills};
use super::schedule::{Wave, cohorts, waves};
use super::write_results;
use crate::backend::{Backend, BackendError};
use crate::config::plan::Plan;
use crate::run_folder::{Provenance, RecordError, RunFolder};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

/// Why a run stopped.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The run folder could not be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
    /// It was told to stop, and everything is saved.
    #[error(
        "stopped: {finished} of {learners} learners are finished, and those in training are saved\nhint: the same command \
         goes on from here, and so does `skilltree run {0}/config.toml --out {0}`",
        dir.display()
    )]
    Stopped {
        /// The run folder.
        dir: PathBuf,
        /// Learners whose results are saved.
        finished: usize,
        /// Learners of the run.
        learners: usize,
    },
}

/// How the run is carried out; changes no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Learners that train together; the backend's own choice if not given.
    pub cohort: Option<usize>,
    /// Time between two checkpoints of the learners in training; [`INTERVAL`] if not given.
    pub checkpoint: Option<Duration>,
}

/// Trains every learner that the folder does not hold yet, then writes the tables, the nets and the manifest. Where the
/// folder or the device fails, or the callbacks stop it, what is committed or in the checkpoint is kept: the same call
/// continues.
pub fn run(
    plan: &Plan,
    groups: &[BatchGroup],
    mut folder: RunFolder,
    backend: &mut dyn Backend,
    options: Options,
    mut provenance: Provenance,
    callbacks: &mut dyn Callbacks,
) -> Result<(), RunError> {
    let parts = Parts::read(plan, groups, &folder)?;
    let saved = saved(plan, groups, &folder, callbacks)?;
    let learners = plan.arms.len() * plan.seeds.len();
    let mut run = Run {
        plan,
        groups,
        shared: shared_skills(plan),
        options,
        timer: SaveTimer::new(options.checkpoint.unwrap_or(INTERVAL)),
        finished: parts.learners().map(|id| plan.arms[id.arm].trials()).sum(),
        parts,
        folder: &mut folder,
        backend,
        callbacks,
    };
    // Whether to go on is asked again as soon as learners move.
    run.callbacks.progress(run.finished);
    let outcome = run.all(saved);
    let Run { mut parts, folder, callbacks, backend, .. } = run;
    let finished = parts.learners().count();
    let dir = folder.dir().to_owned();
    let outcome = outcome.and_then(|()| {
        write_results::finish(plan, groups, folder, &mut parts, backend, callbacks, |diverged| {
            if diverged > 0 {
                let note = format!("{diverged} of {learners}, listed in failures.json; each counts as a failure");
                provenance.notes.insert("learners with numbers that are not finite".to_owned(), note);
            }
            provenance.finished = Some(humantime::format_rfc3339_seconds(SystemTime::now()).to_string());
            provenance
        })
    });
    outcome.map_err(|interrupted| match interrupted {
        Interrupted::Backend(error) => error.into(),
        Interrupted::Record(error) => error.into(),
        Interrupted::Stopped => RunError::Stopped { dir, finished, learners },
    })
}

/// The checkpoint that an earlier start has left, if it can be gone on from.
fn saved(
    plan: &Plan,
    groups: &[BatchGroup],
    folder: &RunFolder,
    callbacks: &mut dyn Callbacks,
) -> Result<Option<Checkpoint<'static>>, RecordError> {
    let read = folder.read_checkpoint().and_then(|bytes| {
        let Some(bytes) = bytes else { return Ok(None) };
        Checkpoint::read(&bytes, plan, groups).map(Some).map_err(|error| RecordError::Damaged {
            path: folder.dir().join("checkpoint"),
            problem: error.to_string(),
            hint: "the learners that it held are trained anew",
        })
    });
    match read {
        Err(why @ (RecordError::Damaged { .. } | RecordError::OtherProgram { .. })) => {
            callbacks.set_aside(&why, &folder.set_checkpoint_aside()?);
            Ok(None)
        }
        other => other,
    }
}

/// A run that is going on.
struct Run<'a> {
    plan: &'a Plan,
    groups: &'a [BatchGroup],
    shared: Vec<SharedSkills>,
    options: Options,
    timer: SaveTimer,
    /// Trials of the learners that are finished.
    finished: u64,
    parts: Parts,
    folder: &'a mut RunFolder,
    backend: &'a mut dyn Backend,
    callbacks: &'a mut dyn Callbacks,
}

impl Run<'_> {
    /// Trains all learners, those that were in training first.
    fn all(&mut self, saved: Option<Checkpoint<'_>>) -> Result<(), Interrupted> {
        if let Some(Checkpoint { pretraining, cohort }) = saved {
            self.resume(pretraining.into_owned(), cohort)?;
        }
        let size = |bytes| self.size(bytes);
        for Wave { pretraining, cohorts } in waves(self.plan, self.groups, size, |id| self.parts.holds(id))? {
            let mut shared = Pretraining::default();
            if let Some((arm, seeds)) = pretraining {
                shared.learners = seeds.into_iter().map(|seed| LearnerId { arm, seed }).collect();
                self.pretrain(&mut shared, &mut None)?;
            }
            for learners in cohorts {
                self.cohort(&shared, &learners, None)?;
            }
            self.folder.remove_checkpoint();
        }
        Ok(())
    }

    /// Goes on with learners that were saved, and then with all others that share their skills.
    fn resume(&mut self, mut shared: Pretraining, cohort: CohortState<'_>) -> Result<(), Interrupted> {
        let mut cohort = Some(cohort);
        if shared.done.is_none() {
            self.pretrain(&mut shared, &mut cohort)?;
        }
        if let Some(cohort) = cohort {
            self.cohort(&shared, &cohort.learners(), Some(cohort))?;
        }
        if let Some(heirs) = self.heirs(&shared) {
            let seeds: Vec<u32> = shared.learners.iter().map(|id| id.seed).collect();
            let most = self.size(heirs.bytes_per_learner(self.groups))?;
            for learners in cohorts(self.plan, self.groups, heirs, &seeds, most, &|id: &LearnerId| self.parts.holds(id))
            {
                self.cohort(&shared, &learners, None)?;
            }
        }
        self.folder.remove_checkpoint();
        Ok(())
    }

    /// Most learners of a cohort.
    fn size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        self.options.cohort.map_or_else(|| self.backend.cohort_size(bytes_per_learner), Ok)
    }

    /// Trains the skills that arms share, if they share any, from where they were saved or from nothing.
    fn pretrain(&mut self, shared: &mut Pretraining, saved: &mut Option<CohortState<'_>>) -> Result<(), Interrupted> {
        let Some(first) = shared.learners.first() else { return Ok(()) };
        let (plan, group) = (self.plan, group_of(self.groups, first.arm));
        // A pretrained learner's trials count for every learner that will go on from it.
        let share = (self.lacking(shared).len() as u64, shared.learners.len() as u64);
        let before = self.finished;
        let (backend, mut callbacks) = self.watch(shared, before, share);
        shared.done = Some(pretrain(plan, group, &shared.learners, saved.take(), backend, &mut callbacks)?);
        Ok(())
    }

    /// The arms that go on from pretrained learners, if there are any.
    fn heirs(&self, shared: &Pretraining) -> Option<&SharedSkills> {
        let first = shared.learners.first()?;
        self.shared.iter().find(|heirs| heirs.arms.binary_search(&first.arm).is_ok())
    }

    /// The learners with these shared skills that are not finished.
    fn lacking(&self, shared: &Pretraining) -> BTreeSet<LearnerId> {
        let arms = self.heirs(shared).map_or(&[][..], |heirs| &heirs.arms);
        let all = shared.learners.iter().flat_map(|id| arms.iter().map(|&arm| LearnerId { arm, seed: id.seed }));
        all.filter(|id| !self.parts.holds(id)).collect()
    }

    /// Trains some learners and commits what they leave.
    fn cohort(
        &mut self,
        shared: &Pretraining,
        learners: &[LearnerId],
        saved: Option<CohortState<'_>>,
    ) -> Result<(), Interrupted> {
        let Some(first) = learners.first() else { return Ok(()) };
        let (plan, group) = (self.plan, group_of(self.groups, first.arm));
        let done: BTreeMap<u32, &Pretrained> = shared.done.iter().flatten().map(|one| (one.id.seed, one)).collect();
        let pretrained = |id: LearnerId| done.get(&id.seed).copied();
        // Those whose turn is still to come have the trials of the shared skills behind them.
        let mut others = self.lacking(shared);
        others.retain(|id| !learners.contains(id));
        let of = |id: &LearnerId| plan.arms[id.arm].trials();
        let of_root = |id: &LearnerId| plan.arms[id.arm].skills.last().map_or(0, |root| u64::from(root.params.trials));
        let before = self.finished + others.iter().map(|id| of(id) - of_root(id)).sum::<u64>();
        let (backend, mut callbacks) = self.watch(shared, before, (1, 1));
        let results = train(plan, group, learners, &pretrained, saved, backend, &mut callbacks)?;
        // Some may be finished: an earlier start may have been killed while it committed them.
        let new: u64 = learners.iter().filter(|id| !self.parts.holds(id)).map(of).sum();
        self.parts.commit(self.folder, &results, self.plan.arms.len() * self.plan.seeds.len())?;
        self.finished += new;
        for divergence in results.iter().filter_map(|result| result.divergence.as_ref()) {
            self.callbacks.diverged(divergence);
        }
        self.callbacks.committed(self.parts.learners().count());
        Ok(())
    }

    /// The backend, and what looks after a cohort on it, where so many trials were finished before.
    fn watch<'a>(
        &'a mut self,
        pretraining: &'a Pretraining,
        before: u64,
        share: (u64, u64),
    ) -> (&'a mut dyn Backend, CohortCallbacks<'a>) {
        let (folder, run, timer) = (&mut *self.folder, &mut *self.callbacks, &mut self.timer);
        (self.backend, CohortCallbacks { folder, run, timer, pretraining, before, share })
    }
}
