//! What is kept of the learners in training, so that little is lost when a run is stopped.
//!
//! One cohort is in training at a time: its stems are, or one arm's learners from stems that are complete. A learner's
//! whole position is in its memory, so going on is training as ever, without the tests that are taken already.

use super::batch::Stem;
use super::batch_group::{Group, LearnerId};
use super::codec::{PartError, Reader, put, words_of};
use super::cohort_state::Standing;
use super::pretraining::group_of;
use super::result::{TestResult, read_failure, read_tests, write_double, write_failure, write_tests};
use super::run::Observer;
use super::thresholds::Fit;
use super::train_loop::{Keeper, Moment, Wish};
use super::validate::{are_rows, are_tests, is_known};
use crate::config::plan::Plan;
use crate::layout::LearnerState;
use crate::run_folder::{RecordError, RunFolder};
use bytemuck::Zeroable;
use std::io::{self, Write};
use std::time::{Duration, Instant};

/// Time between two checkpoints if none is given.
pub const INTERVAL: Duration = Duration::from_secs(60);
/// Saving takes at most one part in so many of the time.
const SHARE: u32 = 10;

/// The stems of the learners in training.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Place {
    /// Whose they are: an arm, the first one that goes on from them, and seeds. Empty where there is nothing below roots.
    pub branches: Vec<LearnerId>,
    /// The stems, once they are complete; none where they are in training, or where there are none.
    pub stems: Option<Vec<Stem>>,
}

/// A cohort as it was saved.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// Whose it is.
    pub place: Place,
    /// How far it is.
    pub standing: Standing,
}

impl Checkpoint {
    /// Writes the cohort in training.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write(place: &Place, moment: &Moment<'_>, out: &mut dyn Write) -> io::Result<()> {
        let mut words = vec![place.branches.len() as u32];
        words.extend(place.branches.iter().flat_map(|id| [id.arm as u32, id.seed]));
        words.push(place.stems.as_ref().map_or(0, |stems| stems.len() as u32 + 1));
        put(out, &words)?;
        for stem in place.stems.iter().flatten() {
            words.clear();
            write_stem(stem, &mut words);
            put(out, &words)?;
        }
        Standing::write(moment, out)
    }

    /// Reads it back.
    ///
    /// # Errors
    /// Where the bytes are not those of a cohort of this experiment.
    pub fn read(bytes: &[u8], plan: &Plan, groups: &[Group]) -> Result<Self, PartError> {
        let words = words_of(bytes)?;
        let mut reader = Reader::new(&words);
        let mut branches = Vec::new();
        let [count] = reader.words()?;
        for _branch in 0..count {
            let [arm, seed] = reader.words()?;
            branches.push(LearnerId { arm: arm as usize, seed });
        }
        let [count] = reader.words()?;
        let stems = (1..count).map(|_| read_stem(&mut reader, groups)).collect::<Result<Vec<_>, _>>()?;
        let stems = (count > 0).then_some(stems);
        let standing = Standing::read(&mut reader, groups)?;
        reader.end()?;
        let of_branches = |stems: &Vec<Stem>| stems.iter().map(|stem| stem.id).eq(branches.iter().copied());
        let of_plan = |arm: usize, tests: &[TestResult], rows: &[u32]| {
            let arm = &plan.arms[arm];
            are_tests(plan, arm, tests) && are_rows(arm, rows)
        };
        let sound = branches.iter().copied().chain(standing.learners()).all(|id| is_known(plan, id))
            && stems.as_ref().is_none_or(of_branches)
            && stems.iter().flatten().all(|stem| of_plan(stem.id.arm, &stem.tests, &stem.rows))
            && standing.results.iter().all(|result| of_plan(result.id.arm, &result.tests, &result.rows));
        if sound { Ok(Self { place: Place { branches, stems }, standing }) } else { Err(PartError) }
    }
}

fn write_stem(stem: &Stem, words: &mut Vec<u32>) {
    words.extend([stem.id.arm as u32, stem.id.seed]);
    words.extend(bytemuck::cast_slice::<LearnerState, u32>(&[stem.state]));
    words.push(stem.nets.len() as u32);
    words.extend(stem.nets.iter().map(|weight| weight.to_bits()));
    words.push(stem.rows.len() as u32);
    words.extend(&stem.rows);
    write_tests(words, &stem.tests);
    words.push(stem.fits.len() as u32);
    for fit in &stem.fits {
        words.push(u32::from(fit.is_some()));
        for value in fit.iter().flat_map(|fit| [fit.offset, fit.slope]) {
            write_double(words, value);
        }
    }
    write_failure(words, stem.failure.as_ref());
}

fn read_stem(reader: &mut Reader<'_>, groups: &[Group]) -> Result<Stem, PartError> {
    let [arm, seed] = reader.words()?;
    let id = LearnerId { arm: arm as usize, seed };
    let mut state = [LearnerState::zeroed()];
    let words: &mut [u32] = bytemuck::cast_slice_mut(&mut state);
    words.copy_from_slice(reader.slice(words.len())?);
    let (nets, rows) = (reader.singles()?, reader.list()?.to_vec());
    let tests = read_tests(reader)?;
    let [count] = reader.words()?;
    let mut fits = Vec::new();
    for _skill in 0..count {
        let [known] = reader.words()?;
        fits.push(match known {
            0 => None,
            _ => Some(Fit { offset: reader.double()?, slope: reader.double()? }),
        });
    }
    let failure = read_failure(reader)?;
    let shape = &group_of(groups, id.arm).shape;
    let root = shape.skills.len() - 1;
    let fits_in = nets.len() == shape.skills[root].nets_offset as usize && rows.len() <= shape.rows_stride;
    if !fits_in || fits.len() != root {
        return Err(PartError);
    }
    Ok(Stem { id, state: state[0], nets, rows, tests, fits, failure })
}

/// When the next checkpoint is due.
#[derive(Debug)]
pub struct Clock {
    interval: Duration,
    due: Instant,
}

impl Clock {
    /// The first is due an interval from now.
    pub fn new(interval: Duration) -> Self {
        Self { interval, due: Instant::now() + interval }
    }

    fn saved(&mut self, took: Duration) {
        self.due = Instant::now() + self.interval.max(took * (SHARE - 1));
    }
}

/// Keeps a cohort of a run: tells how far it is, and saves it.
pub(super) struct Guard<'a> {
    pub(super) folder: &'a mut RunFolder,
    pub(super) observer: &'a mut dyn Observer,
    pub(super) clock: &'a mut Clock,
    pub(super) place: &'a Place,
    /// Trials that were finished before.
    pub(super) before: u64,
    /// For how many learners a learner's trials count, as a fraction.
    pub(super) share: (u64, u64),
}

impl Keeper for Guard<'_> {
    fn look(&mut self, trials: u64) -> Wish {
        self.observer.trials(self.before + trials * self.share.0 / self.share.1.max(1));
        if self.observer.stop() {
            Wish::Stop
        } else if Instant::now() >= self.clock.due {
            Wish::Save
        } else {
            Wish::GoOn
        }
    }

    fn save(&mut self, moment: &Moment<'_>) -> Result<(), RecordError> {
        let begun = Instant::now();
        self.folder.write_checkpoint(&mut |out| Checkpoint::write(self.place, moment, out))?;
        self.clock.saved(begun.elapsed());
        Ok(())
    }
}
