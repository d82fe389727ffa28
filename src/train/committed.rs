//! The committed parts of a run: which learners are finished, and what they leave, read when it is asked for.

use super::batch_group::group_of;
use super::batch_group::{BatchGroup, LearnerId};
use super::codec::{self, PartError};
use super::nets::weight_count;
use super::result::{LearnerResult, is_known};
use crate::config::plan::Plan;
use crate::layout::MAX_CHILDREN;
use crate::run_folder::{RecordError, RunFolder};
use std::collections::{BTreeMap, VecDeque};

/// Most learners of a part: what is read at a time.
const LEARNERS: usize = 256;
/// Parts that are held in memory: those of neighbouring seeds lie side by side, but for cohorts that were interrupted.
const HELD: usize = 4;

/// The learners of a run whose results are on disk.
#[derive(Debug, Default)]
pub struct Parts {
    names: Vec<String>,
    /// Number of the part that holds each learner.
    learners: BTreeMap<LearnerId, usize>,
    held: VecDeque<(usize, BTreeMap<LearnerId, LearnerResult>)>,
}

impl Parts {
    /// Reads every part once: each is whole, or it is an error.
    pub fn read(plan: &Plan, groups: &[BatchGroup], folder: &RunFolder) -> Result<Self, RecordError> {
        let mut parts = Self::default();
        for name in folder.parts()? {
            let mut results = load(folder, &name)?;
            results.retain(|id, _| is_known(plan, *id));
            let complete = |result: &LearnerResult| {
                let shape = &group_of(groups, result.id.arm).shape;
                result.fits(plan)
                    && result.weights.len() == weight_count(&shape.skills)
                    && result.thresholds.len() == MAX_CHILDREN
            };
            if !results.values().all(complete) {
                return Err(damaged(folder, &name, &PartError));
            }
            let ids: Vec<LearnerId> = results.into_keys().collect();
            parts.note(name, &ids);
        }
        Ok(parts)
    }

    /// Writes the results of some learners, of so many in the whole run.
    pub fn commit(
        &mut self,
        folder: &mut RunFolder,
        results: &[LearnerResult],
        learners: usize,
    ) -> Result<(), RecordError> {
        for part in results.chunks(LEARNERS) {
            let ids: Vec<LearnerId> = part.iter().map(|result| result.id).collect();
            let (Some(first), Some(last)) = (ids.first(), ids.last()) else { continue };
            let place = |id: &LearnerId| format!("arm{}-seed{}", id.arm, id.seed);
            let name = format!("{}-of-{learners}_{}_{}", part.len(), place(first), place(last));
            let bytes = codec::encode(part).map_err(|error| RecordError::invalid(&*name, error.to_string()))?;
            folder.commit_part(&name, &bytes)?;
            self.note(name, &ids);
        }
        Ok(())
    }

    fn note(&mut self, name: String, ids: &[LearnerId]) {
        let number = self.names.len();
        self.names.push(name);
        self.learners.extend(ids.iter().map(|id| (*id, number)));
    }

    /// Whether a learner is finished.
    pub fn holds(&self, id: &LearnerId) -> bool {
        self.learners.contains_key(id)
    }

    /// Learners that are finished, ascending.
    pub fn learners(&self) -> impl Iterator<Item = LearnerId> + '_ {
        self.learners.keys().copied()
    }

    /// What a learner leaves, or none if it is not finished.
    pub fn result(&mut self, folder: &RunFolder, id: LearnerId) -> Result<Option<&LearnerResult>, RecordError> {
        let Some(number) = self.learners.get(&id).copied() else { return Ok(None) };
        if !self.held.iter().any(|(held, _)| *held == number) {
            if self.held.len() == HELD {
                self.held.pop_front();
            }
            self.held.push_back((number, load(folder, &self.names[number])?));
        }
        let part = self.held.iter().find(|(held, _)| *held == number);
        Ok(part.and_then(|(_, results)| results.get(&id)))
    }
}

fn load(folder: &RunFolder, name: &str) -> Result<BTreeMap<LearnerId, LearnerResult>, RecordError> {
    let Some(bytes) = folder.read_part(name)? else { return Ok(BTreeMap::new()) };
    let results: Vec<LearnerResult> = codec::read(&bytes).map_err(|error| damaged(folder, name, &error))?;
    Ok(results.into_iter().map(|result| (result.id, result)).collect())
}

fn damaged(folder: &RunFolder, name: &str, error: &PartError) -> RecordError {
    RecordError::Damaged {
        path: folder.dir().join("parts").join(name),
        problem: error.to_string(),
        hint: "remove this file and give the same command again: only this part is computed anew",
    }
}
