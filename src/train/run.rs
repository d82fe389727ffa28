//! Runs an experiment into a run folder: cohort after cohort, each committed before the next begins.

use super::batch::{Stem, train, train_stem};
use super::batch_group::{Group, LearnerId};
use super::checkpoint::{Checkpoint, Clock, Guard, INTERVAL, Place};
use super::cohort_state::Standing;
use super::committed::Parts;
use super::pretraining::{Family, families, group_of};
use super::schedule::{Stage, branching, stages};
use super::train_loop::Halt;
use super::write_results;
use crate::backend::{Backend, BackendError};
use crate::config::plan::Plan;
use crate::run_folder::{Failure, Provenance, RecordError, RunFolder};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
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

/// Told how a run goes, and asked whether it should go on.
pub trait Observer {
    /// Trials finished so far, of all learners together, those of an earlier start included.
    fn trials(&mut self, finished: u64);

    /// A cohort's results are on disk; so many learners are now.
    fn committed(&mut self, finished: usize);

    /// A learner was frozen because a number stopped being finite.
    fn failed(&mut self, _failure: &Failure) {}

    /// A checkpoint could not be used, and where it is now.
    fn set_aside(&mut self, _why: &RecordError, _now: &Path) {}

    /// Whether to stop at the next opportunity.
    fn stop(&mut self) -> bool {
        false
    }
}

/// How the run is carried out; changes no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Learners that train together; the backend's own choice if not given.
    pub cohort: Option<usize>,
    /// Time between two checkpoints of the learners in training; [`INTERVAL`] if not given.
    pub checkpoint: Option<Duration>,
}

/// Trains every learner that the folder does not hold yet, then writes the tables, the nets and the manifest.
///
/// # Errors
/// Where the folder or the device fails, or the observer stops it. What is committed or in the checkpoint is kept: the
/// same call continues.
pub fn run(
    plan: &Plan,
    groups: &[Group],
    mut folder: RunFolder,
    backend: &mut dyn Backend,
    options: Options,
    mut provenance: Provenance,
    observer: &mut dyn Observer,
) -> Result<(), RunError> {
    let parts = Parts::read(plan, groups, &folder)?;
    let saved = saved(plan, groups, &folder, observer)?;
    let mut run = Run {
        plan,
        groups,
        families: families(plan),
        options,
        clock: Clock::new(options.checkpoint.unwrap_or(INTERVAL)),
        finished: parts.learners().map(|id| trials_of(plan, id)).sum(),
        parts,
        folder: &mut folder,
        backend,
        observer,
    };
    run.observer.trials(run.finished);
    run.all(saved)?;
    let Run { mut parts, folder, observer, backend, .. } = run;
    write_results::finish(plan, groups, folder, &mut parts, backend, observer, |failed| {
        if failed > 0 {
            let of = plan.arms.len() * plan.seeds.len();
            let note = format!("{failed} of {of}, listed in failures.json; each counts as a failure");
            provenance.notes.insert("learners with numbers that are not finite".to_owned(), note);
        }
        provenance.finished = Some(humantime::format_rfc3339_seconds(SystemTime::now()).to_string());
        provenance
    })
}

/// The checkpoint that an earlier start has left, if it can be gone on from.
fn saved(
    plan: &Plan,
    groups: &[Group],
    folder: &RunFolder,
    observer: &mut dyn Observer,
) -> Result<Option<Checkpoint>, RecordError> {
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
            observer.set_aside(&why, &folder.set_checkpoint_aside()?);
            Ok(None)
        }
        other => other,
    }
}

fn trials_of(plan: &Plan, id: LearnerId) -> u64 {
    plan.arms[id.arm].skills.iter().map(|skill| u64::from(skill.params.trials)).sum()
}

fn root_trials(plan: &Plan, id: LearnerId) -> u64 {
    plan.arms[id.arm].skills.last().map_or(0, |root| u64::from(root.params.trials))
}

/// A run that is going on.
struct Run<'a> {
    plan: &'a Plan,
    groups: &'a [Group],
    families: Vec<Family>,
    options: Options,
    clock: Clock,
    /// Trials of the learners that are finished.
    finished: u64,
    parts: Parts,
    folder: &'a mut RunFolder,
    backend: &'a mut dyn Backend,
    observer: &'a mut dyn Observer,
}

impl Run<'_> {
    /// Trains all learners, those that were in training first.
    fn all(&mut self, saved: Option<Checkpoint>) -> Result<(), RunError> {
        if let Some(Checkpoint { place, standing }) = saved {
            self.resume(place, standing)?;
        }
        let size = |bytes| self.size(bytes);
        for Stage { stems, cohorts } in stages(self.plan, self.groups, size, |id| self.parts.holds(id))? {
            let mut place = Place::default();
            if let Some((arm, seeds)) = stems {
                place.branches = seeds.into_iter().map(|seed| LearnerId { arm, seed }).collect();
                self.grow(&mut place, None)?;
            }
            for learners in cohorts {
                self.cohort(&place, &learners, None)?;
            }
            self.folder.remove_checkpoint();
        }
        Ok(())
    }

    /// Goes on with learners that were saved, and then with all others that have stems in common with them.
    fn resume(&mut self, mut place: Place, standing: Standing) -> Result<(), RunError> {
        let mut standing = Some(standing);
        if !place.branches.is_empty() && place.stems.is_none() {
            self.grow(&mut place, standing.take())?;
        }
        if let Some(standing) = standing {
            self.cohort(&place, &standing.learners(), Some(standing))?;
        }
        if let Some(first) = place.branches.first() {
            let seeds: Vec<u32> = place.branches.iter().map(|id| id.seed).collect();
            let size = |bytes| self.size(bytes);
            let done = |id: &LearnerId| self.parts.holds(id);
            for learners in branching(self.plan, self.groups, (first.arm, &seeds), size, done)? {
                self.cohort(&place, &learners, None)?;
            }
        }
        self.folder.remove_checkpoint();
        Ok(())
    }

    /// Most learners of a cohort.
    fn size(&self, bytes_per_learner: usize) -> Result<usize, BackendError> {
        self.options.cohort.map_or_else(|| self.backend.cohort_size(bytes_per_learner), Ok)
    }

    /// Trains the stems.
    fn grow(&mut self, place: &mut Place, saved: Option<Standing>) -> Result<(), RunError> {
        let Some(first) = place.branches.first() else { return Ok(()) };
        let (plan, group) = (self.plan, group_of(self.groups, first.arm));
        // A stem's trials count for every learner that will go on from it.
        let share = (self.lacking(place).len() as u64, place.branches.len() as u64);
        let before = self.finished;
        let (backend, mut guard) = self.guard(place, before, share);
        let stems = train_stem(plan, group, &place.branches, saved, backend, &mut guard);
        place.stems = Some(stems.map_err(|halt| self.stopped(halt))?);
        Ok(())
    }

    /// The learners with these stems that are not finished.
    fn lacking(&self, place: &Place) -> BTreeSet<LearnerId> {
        let family = place.branches.first().map(|first| first.arm);
        let family = family.and_then(|arm| self.families.iter().find(|family| family.arms.binary_search(&arm).is_ok()));
        let arms = family.map_or(&[][..], |family| &family.arms);
        let all = place.branches.iter().flat_map(|id| arms.iter().map(|arm| LearnerId { arm: *arm, seed: id.seed }));
        all.filter(|id| !self.parts.holds(id)).collect()
    }

    /// Trains some learners and commits what they leave.
    fn cohort(&mut self, place: &Place, learners: &[LearnerId], saved: Option<Standing>) -> Result<(), RunError> {
        let Some(first) = learners.first() else { return Ok(()) };
        let (plan, group) = (self.plan, group_of(self.groups, first.arm));
        let stems: BTreeMap<u32, &Stem> = place.stems.iter().flatten().map(|stem| (stem.id.seed, stem)).collect();
        let stem_of = |id: LearnerId| stems.get(&id.seed).copied();
        // Those whose turn is still to come have their stems' trials behind them.
        let mut others = self.lacking(place);
        others.retain(|id| !learners.contains(id));
        let below: u64 = others.iter().map(|id| trials_of(plan, *id) - root_trials(plan, *id)).sum();
        let before = self.finished + below;
        let (backend, mut guard) = self.guard(place, before, (1, 1));
        let results = train(plan, group, learners, &stem_of, saved, backend, &mut guard);
        let results = results.map_err(|halt| self.stopped(halt))?;
        // Some may be finished: an earlier start may have been killed while it committed them.
        let new: u64 = learners.iter().filter(|id| !self.parts.holds(id)).map(|id| trials_of(plan, *id)).sum();
        self.parts.commit(self.folder, &results, self.learners())?;
        self.finished += new;
        for failure in results.iter().filter_map(|result| result.failure.as_ref()) {
            self.observer.failed(failure);
        }
        self.observer.committed(self.parts.learners().count());
        Ok(())
    }

    /// What looks after a cohort, where so many trials were finished before.
    fn guard<'a>(&'a mut self, place: &'a Place, before: u64, share: (u64, u64)) -> (&'a mut dyn Backend, Guard<'a>) {
        let guard =
            Guard { folder: self.folder, observer: self.observer, clock: &mut self.clock, place, before, share };
        (self.backend, guard)
    }

    fn learners(&self) -> usize {
        self.plan.arms.len() * self.plan.seeds.len()
    }

    fn stopped(&self, halt: Halt) -> RunError {
        match halt {
            Halt::Backend(error) => error.into(),
            Halt::Record(error) => error.into(),
            Halt::Stopped => RunError::Stopped {
                dir: self.folder.dir().into(),
                finished: self.parts.learners().count(),
                learners: self.learners(),
            },
        }
    }
}
