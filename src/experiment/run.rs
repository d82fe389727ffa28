//! Runs an experiment into a run folder: cohort after cohort, each committed before the next begins.

use super::cohorts::stages;
use super::family::group_of;
use super::files::Results;
use super::group::{Group, LearnerId};
use super::result::{LearnerResult, decode, encode};
use super::senses;
use super::train::{train, train_stem};
use super::trajectories::trajectories;
use crate::backend::{Backend, BackendError};
use crate::config::plan::Plan;
use crate::record::{Provenance, RecordError, RunFolder};
use std::collections::BTreeMap;
use std::time::SystemTime;

/// Why a run stopped.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The run folder could not be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The device failed.
    #[error(transparent)]
    Backend(#[from] BackendError),
}

/// Told how a run goes.
pub trait Observer {
    /// Trials finished so far, of all learners together, those of an earlier start included.
    fn trials(&mut self, finished: u64);
    /// A cohort's results are on disk; so many learners are now.
    fn committed(&mut self, finished: usize);
}

/// How the run is carried out; changes no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Learners that train together; the backend's own choice if not given.
    pub cohort: Option<usize>,
}

/// Trains every learner that the folder does not hold yet, then writes the tables, the nets and the manifest.
///
/// # Errors
/// Where the folder or the device fails. Committed cohorts are kept: the same call continues.
pub fn run(
    plan: &Plan,
    groups: &[Group],
    mut folder: RunFolder,
    backend: &mut dyn Backend,
    options: Options,
    mut provenance: Provenance,
    observer: &mut dyn Observer,
) -> Result<(), RunError> {
    let mut learners = committed(plan, &folder)?;
    let trials_of = |id: &LearnerId| plan.arms[id.arm].skills.iter().map(|skill| u64::from(skill.trials)).sum::<u64>();
    let mut finished: u64 = learners.keys().map(trials_of).sum();
    observer.trials(finished);
    let size = |bytes| match options.cohort {
        Some(cohort) => Ok(cohort),
        None => backend.cohort_size(bytes),
    };
    for stage in stages(plan, groups, size, |id| learners.contains_key(id))? {
        let mut stems = Vec::new();
        if let Some((arm, seeds)) = &stage.stems {
            let branches: usize = stage.cohorts.iter().map(Vec::len).sum();
            // The stem's trials count for every learner that will branch from it.
            let share = |trials: u64| trials * branches as u64 / seeds.len() as u64;
            let progress = &mut |trials| observer.trials(finished + share(trials));
            stems = train_stem(plan, group_of(groups, *arm), (*arm, seeds), backend, progress)?;
        }
        for ids in &stage.cohorts {
            let group = group_of(groups, ids[0].arm);
            let progress = &mut |trials| observer.trials(finished + trials);
            let results = train(plan, group, ids, &stems, backend, progress)?;
            folder.commit_part(&part_name(ids), &encode(&results))?;
            finished += ids.iter().map(trials_of).sum::<u64>();
            learners.extend(results.into_iter().map(|result| (result.id, result)));
            observer.committed(learners.len());
        }
    }
    let failed = learners.values().filter(|result| result.failed).count();
    if failed > 0 {
        provenance.notes.insert("diverged learners".to_owned(), failed.to_string());
    }
    let places = senses::places(plan.world(), backend)?;
    let trajectories = trajectories(plan, groups, &learners);
    let results = Results { plan, groups, learners, places, trajectories };
    provenance.finished = Some(humantime::format_rfc3339_seconds(SystemTime::now()).to_string());
    folder.finish(results.files()?, provenance)?;
    Ok(())
}

/// Learners whose results the folder already holds.
fn committed(plan: &Plan, folder: &RunFolder) -> Result<BTreeMap<LearnerId, LearnerResult>, RecordError> {
    let mut learners = BTreeMap::new();
    for name in folder.parts()? {
        let Some(bytes) = folder.read_part(&name)? else { continue };
        let results = decode(&bytes).map_err(|error| RecordError::Damaged {
            path: folder.dir().join("parts").join(&name),
            problem: error.to_string(),
            hint: "remove this file and give the same command again: only this part is computed anew",
        })?;
        let known = |id: LearnerId| id.arm < plan.arms.len() && plan.seeds.contains(&id.seed);
        learners.extend(results.into_iter().filter(|result| known(result.id)).map(|result| (result.id, result)));
    }
    Ok(learners)
}

/// Names a cohort's part after its first and last learner.
fn part_name(cohort: &[LearnerId]) -> String {
    let name = |id: Option<&LearnerId>| id.map_or_else(String::new, |id| format!("arm{}-seed{}", id.arm, id.seed));
    format!("{}_{}", name(cohort.first()), name(cohort.last()))
}
