//! Where the learners of a cohort stand: what a checkpoint holds of them.

use super::climb::Moment;
use super::family::group_of;
use super::group::{Group, LearnerId};
use super::result::LearnerResult;
use super::words::{PartError, Reader, put, put_sparse};
use crate::backend::Cohort;
use crate::learner::layout::Cursor;
use bytemuck::Zeroable;
use std::io::{self, Write};

/// Words of a cursor.
const CURSOR: usize = size_of::<Cursor>() / 4;

/// A cohort that was saved. Its settings and shapes are not kept: they follow from the plan and the stems.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// The tests taken so far; after training, all that the learners leave.
    pub results: Vec<LearnerResult>,
    /// Whether training is over, so that only tests under alterations are to come.
    pub trained: bool,
    cursors: Vec<Cursor>,
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
        put(out, bytemuck::cast_slice(&cohort.cursors))?;
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
        let mut cursors = vec![Cursor::zeroed(); results.len()];
        let words: &mut [u32] = bytemuck::cast_slice_mut(&mut cursors);
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
        Ok(Self { results, trained: trained == 1, cursors, nets, lessons, rows })
    }

    /// The learners, in their order.
    pub fn learners(&self) -> Vec<LearnerId> {
        self.results.iter().map(|result| result.id).collect()
    }

    /// Puts the learners back into a cohort of the same ones, and hands over what they leave so far.
    pub fn restore(self, cohort: &mut Cohort) -> Vec<LearnerResult> {
        cohort.cursors = self.cursors;
        cohort.nets = self.nets;
        if !self.trained {
            cohort.lessons = self.lessons;
            cohort.rows = self.rows;
        }
        self.results
    }
}
