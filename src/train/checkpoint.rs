//! What is kept of the learners in training, so that little is lost when a run is stopped.
//!
//! One cohort is in training at a time: the skills that arms share are learned, or some arms' learners go on from them. A
//! learner's whole position is in its memory, so going on is training as ever, without the tests that are taken already.

use super::batch_group::{BatchGroup, LearnerId, group_of};
use super::codec::{self, PartError, pod};
use super::pretraining::Pretraining;
use super::result::{LearnerResult, is_known};
use crate::backend::Cohort;
use crate::config::plan::Plan;
use crate::layout::LearnerState;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// What a checkpoint file holds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<'a> {
    /// The skills that the learners share, or that they are learning to share.
    pub pretraining: Cow<'a, Pretraining>,
    /// How far the cohort in training is.
    pub cohort: CohortState<'a>,
}

impl Checkpoint<'static> {
    /// Reads a checkpoint; an error where the bytes are not those of a cohort of this experiment.
    pub fn read(bytes: &[u8], plan: &Plan, groups: &[BatchGroup]) -> Result<Self, PartError> {
        let checkpoint: Self = codec::read(bytes)?;
        let fits = checkpoint.pretraining.fits(plan, groups) && checkpoint.cohort.fits(plan, groups);
        if fits { Ok(checkpoint) } else { Err(PartError) }
    }
}

/// A cohort in training, as it is saved. Its hyper-parameters and shapes are not kept: they follow from the plan and from
/// what the learners go on from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CohortState<'a> {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: Cow<'a, [LearnerResult]>,
    /// Whether training is over, so that only tests under alterations are to come. Lessons and rows are then not kept.
    pub trained: bool,
    #[serde(with = "pod")]
    states: Cow<'a, [LearnerState]>,
    #[serde(with = "pod")]
    nets: Cow<'a, [f32]>,
    #[serde(with = "pod")]
    lessons: Cow<'a, [u32]>,
    #[serde(with = "pod")]
    rows: Cow<'a, [u32]>,
}

impl<'a> CohortState<'a> {
    pub(super) fn new(results: &'a [LearnerResult], cohort: &'a Cohort, trained: bool) -> Self {
        let kept = |words: &'a [u32]| Cow::Borrowed(if trained { &words[..0] } else { words });
        Self {
            results: Cow::Borrowed(results),
            trained,
            states: Cow::Borrowed(&cohort.states),
            nets: Cow::Borrowed(&cohort.nets),
            lessons: kept(&cohort.lessons),
            rows: kept(&cohort.rows),
        }
    }

    /// The learners, in their order.
    pub(super) fn learners(&self) -> Vec<LearnerId> {
        self.results.iter().map(|result| result.id).collect()
    }

    /// Puts the learners back into a cohort of the same ones, and hands over what they leave so far.
    pub(super) fn restore(self, cohort: &mut Cohort) -> Vec<LearnerResult> {
        cohort.states = self.states.into_owned();
        cohort.nets = self.nets.into_owned();
        if !self.trained {
            cohort.lessons = self.lessons.into_owned();
            cohort.rows = self.rows.into_owned();
        }
        self.results.into_owned()
    }

    /// Whether these are learners of one group, and their memory is of its sizes.
    fn fits(&self, plan: &Plan, groups: &[BatchGroup]) -> bool {
        let Some(first) = self.results.first().filter(|first| is_known(plan, first.id)) else { return false };
        let group = group_of(groups, first.id.arm);
        let (learners, shape) = (self.results.len(), &group.shape);
        let kept = if self.trained { 0 } else { learners };
        self.results.iter().all(|result| group.arms.contains(&result.id.arm) && result.fits(plan))
            && self.states.len() == learners
            && self.nets.len() == learners * shape.nets_stride
            && self.lessons.len() == kept * shape.lessons_stride
            && self.rows.len() == kept * shape.rows_stride
    }
}
