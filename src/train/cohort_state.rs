//! Where the learners of a cohort stand: what a checkpoint holds of them.

use super::batch_group::{Group, LearnerId};
use super::codec::{PartError, Reader, put, put_sparse};
use super::pretraining::group_of;
use super::result::LearnerResult;
use super::train_loop::Moment;
use crate::backend::Cohort;
use crate::layout::LearnerState;
use bytemuck::Zeroable;
use std::io::{self, Write};

/// Words of a state.
const CURSOR: usize = size_of::<LearnerState>() / 4;

/// A cohort that was saved. Its params and shapes are not kept: they follow from the plan and the stems.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: Vec<LearnerResult>,
    /// Whether training is over, so that only tests under alterations are to come.
    pub trained: bool,
    states: Vec<LearnerState>,
    nets: Vec<f32>,
    lessons: Vec<u32>,
    rows: Vec<u32>,
}

impl Standing {
    /// Writes a cohort as it is.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(moment: &Moment<'_>, out: &mut dyn Write) -> io::Result<()> {
        let cohort = moment.cohort;
        put(out, &[u32::from(moment.trained), moment.results.len() as u32])?;
        let mut words = Vec::new();
        for result in moment.results {
            words.clear();
            result.write(&mut words);
            put(out, &words)?;
        }
        put(out, bytemuck::cast_slice(&cohort.states))?;
        put(out, bytemuck::cast_slice(&cohort.nets))?;
        if !moment.trained {
            // Most lessons end long before the step limit.
            cohort.lessons.chunks(cohort.lessons_stride).try_for_each(|own| put_sparse(out, own))?;
            cohort.rows.chunks(cohort.rows_stride).try_for_each(|own| put_sparse(out, own))?;
        }
        Ok(())
    }

    /// Reads learners back.
    ///
    /// # Errors
    /// Where the words end early or are those of learners of another shape.
    pub fn read(reader: &mut Reader<'_>, groups: &[Group]) -> Result<Self, PartError> {
        let [trained, count] = reader.words()?;
        let results = (0..count).map(|_| LearnerResult::read(reader)).collect::<Result<Vec<_>, _>>()?;
        let group = group_of(groups, results.first().ok_or(PartError)?.id.arm);
        if results.iter().any(|result| !group.arms.contains(&result.id.arm)) {
            return Err(PartError);
        }
        let mut states = vec![LearnerState::zeroed(); results.len()];
        let words: &mut [u32] = bytemuck::cast_slice_mut(&mut states);
        words.copy_from_slice(reader.slice(results.len() * CURSOR)?);
        let nets = reader.slice(results.len() * group.shape.nets_stride)?;
        let nets = nets.iter().map(|bits| f32::from_bits(*bits)).collect();
        let (mut lessons, mut rows) = (Vec::new(), Vec::new());
        if trained == 0 {
            for (kept, stride) in [(&mut lessons, group.shape.lessons_stride), (&mut rows, group.shape.rows_stride)] {
                for _learner in 0..results.len() {
                    let from = kept.len();
                    kept.resize(from + stride, 0);
                    reader.sparse(&mut kept[from..])?;
                }
            }
        }
        Ok(Self { results, trained: trained == 1, states, nets, lessons, rows })
    }

    /// The learners, in their order.
    pub fn learners(&self) -> Vec<LearnerId> {
        self.results.iter().map(|result| result.id).collect()
    }

    /// Puts the learners back into a cohort of the same ones, and hands over what they leave so far.
    pub fn restore(self, cohort: &mut Cohort) -> Vec<LearnerResult> {
        cohort.states = self.states;
        cohort.nets = self.nets;
        if !self.trained {
            cohort.lessons = self.lessons;
            cohort.rows = self.rows;
        }
        self.results
    }
}
