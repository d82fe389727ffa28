//! A cohort in training, as a checkpoint holds it.

use super::batch_group::LearnerId;
use super::callbacks::Snapshot;
use super::codec::pod;
use super::result::LearnerResult;
use crate::backend::Cohort;
use crate::layout::LearnerState;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A cohort as it is saved. Its hyper-parameters and shapes are not kept: they follow from the plan and from what the
/// learners go on from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CohortState<'a> {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: Cow<'a, [LearnerResult]>,
    /// Whether training is over, so that only tests under alterations are to come. Lessons and rows are then not kept.
    pub trained: bool,
    #[serde(with = "pod")]
    pub(super) states: Cow<'a, [LearnerState]>,
    #[serde(with = "pod")]
    pub(super) nets: Cow<'a, [f32]>,
    #[serde(with = "pod")]
    pub(super) lessons: Cow<'a, [u32]>,
    #[serde(with = "pod")]
    pub(super) rows: Cow<'a, [u32]>,
}

impl<'a> CohortState<'a> {
    pub(super) fn of(snapshot: &Snapshot<'a>) -> Self {
        let Snapshot { results, cohort, trained } = *snapshot;
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
    pub fn learners(&self) -> Vec<LearnerId> {
        self.results.iter().map(|result| result.id).collect()
    }

    /// Puts the learners back into a cohort of the same ones, and hands over what they leave so far.
    pub fn restore(self, cohort: &mut Cohort) -> Vec<LearnerResult> {
        cohort.states = self.states.into_owned();
        cohort.nets = self.nets.into_owned();
        if !self.trained {
            cohort.lessons = self.lessons.into_owned();
            cohort.rows = self.rows.into_owned();
        }
        self.results.into_owned()
    }
}
