//! The two tables of sums, from which anybody can recompute every rate: `trials.parquet` and `evaluations.parquet`.

use super::RecordError;
use super::columns::{self, Column, Table, Writer};
use super::file_system::{Disk, FileSystem};
use std::io::Write;
use std::path::Path;

/// File name of the training trials.
pub const TRIALS: &str = "trials.parquet";
/// File name of the tests.
pub const EVALUATIONS: &str = "evaluations.parquet";
/// The arm whose rows are the planner's own tests: a bound, not a learner.
pub const PLANNER: &str = "planner";

/// The variant of tests in the world and with the noise of training.
pub const TRAINED: &str = "trained";

/// What the `arm`, `skill`, `variant` and `room` fields of rows index into. When read back, names come in the order in which the
/// rows first use them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    /// Experimental conditions.
    pub arms: Vec<String>,
    /// Skills.
    pub skills: Vec<String>,
    /// Circumstances of tests: [`TRAINED`], or an alteration's name.
    pub variants: Vec<String>,
    /// Rooms in which tests start.
    pub rooms: Vec<String>,
}

/// One training trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrialRow {
    /// Index into [`Names::arms`].
    pub arm: u32,
    /// Sweep point, counted from 0.
    pub point: u32,
    /// Seed of the learner.
    pub seed: u32,
    /// Index into [`Names::skills`].
    pub skill: u32,
    /// Number of the trial of this skill, counted from 0.
    pub trial: u32,
    /// Primitive actions executed so far, in teaching and for child skills too.
    pub actions: u32,
    /// Primitive steps of this trial.
    pub steps: u32,
    /// Sum of rewards, undiscounted, in the config's units.
    pub reward: f32,
    /// Whether the trial ended as achieved.
    pub success: bool,
    /// Steps with contact.
    pub collisions: u32,
    /// Whether the teacher drove.
    pub taught: bool,
}

/// Tests of one skill from one starting room, summed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EvaluationRow {
    /// Index into [`Names::arms`].
    pub arm: u32,
    /// Sweep point, counted from 0.
    pub point: u32,
    /// Seed of the learner.
    pub seed: u32,
    /// Index into [`Names::skills`].
    pub skill: u32,
    /// Training trials of this skill so far.
    pub trials: u32,
    /// Primitive actions executed so far, in teaching and for child skills too.
    pub actions: u32,
    /// Index into [`Names::variants`].
    pub variant: u32,
    /// Index into [`Names::rooms`].
    pub room: u32,
    /// Test trials.
    pub episodes: u32,
    /// Test trials that ended as achieved.
    pub successes: u32,
    /// Primitive steps of all test trials.
    pub steps: u32,
    /// Sum of rewards of all test trials, undiscounted, in the config's units.
    pub reward: f64,
    /// Sum of rewards of all test trials, each discounted from the start of its trial with the skill's own factor.
    pub returned: f64,
    /// Steps with contact of all test trials.
    pub collisions: u32,
}

const TRIAL_SCHEMA: &str = "message trials {
    REQUIRED BYTE_ARRAY arm (STRING); REQUIRED INT32 point (INTEGER(32,false)); REQUIRED INT32 seed (INTEGER(32,false));
    REQUIRED BYTE_ARRAY skill (STRING); REQUIRED INT32 trial (INTEGER(32,false));
    REQUIRED INT32 actions (INTEGER(32,false)); REQUIRED INT32 steps (INTEGER(32,false)); REQUIRED FLOAT reward;
    REQUIRED BOOLEAN success; REQUIRED INT32 collisions (INTEGER(32,false)); REQUIRED BOOLEAN taught;
}";

const EVALUATION_SCHEMA: &str = "message evaluations {
    REQUIRED BYTE_ARRAY arm (STRING); REQUIRED INT32 point (INTEGER(32,false)); REQUIRED INT32 seed (INTEGER(32,false));
    REQUIRED BYTE_ARRAY skill (STRING); REQUIRED INT32 trials (INTEGER(32,false));
    REQUIRED INT32 actions (INTEGER(32,false)); REQUIRED BYTE_ARRAY variant (STRING); REQUIRED BYTE_ARRAY room (STRING);
    REQUIRED INT32 episodes (INTEGER(32,false)); REQUIRED INT32 successes (INTEGER(32,false));
    REQUIRED INT32 steps (INTEGER(32,false)); REQUIRED DOUBLE reward; REQUIRED DOUBLE return;
    REQUIRED INT32 collisions (INTEGER(32,false));
}";

/// A table that is written row by row, in bounded memory. The same rows give the same bytes; the caller has sorted them.
pub struct TableWriter<'names, Row, Sink: Write + Send> {
    names: &'names Names,
    columns: fn(&[Row], &Names) -> Result<Vec<Column>, RecordError>,
    rows: Vec<Row>,
    file: Writer<Sink>,
}

impl<'names, Sink: Write + Send> TableWriter<'names, TrialRow, Sink> {
    /// Begins `trials.parquet`; `path` is only for messages.
    ///
    /// # Errors
    /// [`RecordError::NotCommitted`] if `sink` takes no more.
    pub fn trials(path: &Path, names: &'names Names, sink: Sink) -> Result<Self, RecordError> {
        let file = Writer::new(path, TRIAL_SCHEMA, sink)?;
        Ok(Self { names, columns: trial_columns, rows: Vec::new(), file })
    }
}

impl<'names, Sink: Write + Send> TableWriter<'names, EvaluationRow, Sink> {
    /// Begins `evaluations.parquet`; `path` is only for messages.
    ///
    /// # Errors
    /// [`RecordError::NotCommitted`] if `sink` takes no more.
    pub fn evaluations(path: &Path, names: &'names Names, sink: Sink) -> Result<Self, RecordError> {
        let file = Writer::new(path, EVALUATION_SCHEMA, sink)?;
        Ok(Self { names, columns: evaluation_columns, rows: Vec::new(), file })
    }
}

impl<Row, Sink: Write + Send> TableWriter<'_, Row, Sink> {
    /// Adds a row.
    ///
    /// # Errors
    /// [`RecordError::Invalid`] if a field of it has no name, [`RecordError::NotCommitted`] if the sink takes no more.
    pub fn push(&mut self, row: Row) -> Result<(), RecordError> {
        self.rows.push(row);
        if self.rows.len() < columns::ROWS_PER_GROUP { Ok(()) } else { self.flush() }
    }

    /// Ends the table and hands back where it was written to.
    ///
    /// # Errors
    /// As [`TableWriter::push`].
    pub fn finish(mut self) -> Result<Sink, RecordError> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        self.file.finish()
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        self.file.group((self.columns)(&self.rows, self.names)?)?;
        self.rows.clear();
        Ok(())
    }
}

fn trial_columns(rows: &[TrialRow], names: &Names) -> Result<Vec<Column>, RecordError> {
    Ok(vec![
        Column::text(rows.iter().map(|r| r.arm), &names.arms)?,
        Column::count(rows.iter().map(|r| r.point)),
        Column::count(rows.iter().map(|r| r.seed)),
        Column::text(rows.iter().map(|r| r.skill), &names.skills)?,
        Column::count(rows.iter().map(|r| r.trial)),
        Column::count(rows.iter().map(|r| r.actions)),
        Column::count(rows.iter().map(|r| r.steps)),
        Column::Single(rows.iter().map(|r| r.reward).collect()),
        Column::Flag(rows.iter().map(|r| r.success).collect()),
        Column::count(rows.iter().map(|r| r.collisions)),
        Column::Flag(rows.iter().map(|r| r.taught).collect()),
    ])
}

fn evaluation_columns(rows: &[EvaluationRow], names: &Names) -> Result<Vec<Column>, RecordError> {
    Ok(vec![
        Column::text(rows.iter().map(|r| r.arm), &names.arms)?,
        Column::count(rows.iter().map(|r| r.point)),
        Column::count(rows.iter().map(|r| r.seed)),
        Column::text(rows.iter().map(|r| r.skill), &names.skills)?,
        Column::count(rows.iter().map(|r| r.trials)),
        Column::count(rows.iter().map(|r| r.actions)),
        Column::text(rows.iter().map(|r| r.variant), &names.variants)?,
        Column::text(rows.iter().map(|r| r.room), &names.rooms)?,
        Column::count(rows.iter().map(|r| r.episodes)),
        Column::count(rows.iter().map(|r| r.successes)),
        Column::count(rows.iter().map(|r| r.steps)),
        Column::Double(rows.iter().map(|r| r.reward).collect()),
        Column::Double(rows.iter().map(|r| r.returned).collect()),
        Column::count(rows.iter().map(|r| r.collisions)),
    ])
}

/// The bytes of a whole `trials.parquet`.
///
/// # Errors
/// [`RecordError::Invalid`] if a row's `arm` or `skill` has no name.
pub fn write_trials(rows: &[TrialRow], names: &Names) -> Result<Vec<u8>, RecordError> {
    let mut table = TableWriter::trials(Path::new(TRIALS), names, Vec::new())?;
    rows.iter().try_for_each(|row| table.push(*row))?;
    table.finish()
}

/// The bytes of a whole `evaluations.parquet`.
///
/// # Errors
/// [`RecordError::Invalid`] if a row's `arm`, `skill`, `variant` or `room` has no name.
pub fn write_evaluations(rows: &[EvaluationRow], names: &Names) -> Result<Vec<u8>, RecordError> {
    let mut table = TableWriter::evaluations(Path::new(EVALUATIONS), names, Vec::new())?;
    rows.iter().try_for_each(|row| table.push(*row))?;
    table.finish()
}

/// Reads a table of training trials. [`Names::rooms`] comes out empty.
///
/// # Errors
/// [`RecordError::Damaged`] for anything but a table of exactly these columns, [`RecordError::Unreadable`],
/// [`RecordError::Format`].
pub fn read_trials(path: &Path) -> Result<(Names, Vec<TrialRow>), RecordError> {
    parse_trials(FileSystem.read(path).map_err(RecordError::unreadable(path))?, path)
}

/// As [`read_trials`], from the file's content; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`], [`RecordError::Format`].
pub fn parse_trials(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<TrialRow>), RecordError> {
    columns::guarded(path, || trials_of(bytes, path))
}

fn trials_of(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<TrialRow>), RecordError> {
    let table = Table::read(bytes, path, TRIAL_SCHEMA)?;
    let (arm, arms) = table.text(0)?;
    let (skill, skills) = table.text(3)?;
    let (point, seed, trial) = (table.count(1)?, table.count(2)?, table.count(4)?);
    let (actions, steps, collisions) = (table.count(5)?, table.count(6)?, table.count(9)?);
    let (reward, success, taught) = (table.single(7)?, table.flag(8)?, table.flag(10)?);
    let row = |i: usize| TrialRow {
        arm: arm[i],
        point: point[i],
        seed: seed[i],
        skill: skill[i],
        trial: trial[i],
        actions: actions[i],
        steps: steps[i],
        reward: reward[i],
        success: success[i],
        collisions: collisions[i],
        taught: taught[i],
    };
    Ok((Names { arms, skills, ..Names::default() }, (0..table.rows).map(row).collect()))
}

/// Reads a table of tests.
///
/// # Errors
/// As [`read_trials`].
pub fn read_evaluations(path: &Path) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
    parse_evaluations(FileSystem.read(path).map_err(RecordError::unreadable(path))?, path)
}

/// As [`read_evaluations`], from the file's content; `path` is only for messages.
///
/// # Errors
/// As [`parse_trials`].
pub fn parse_evaluations(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
    columns::guarded(path, || evaluations_of(bytes, path))
}

fn evaluations_of(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
    let table = Table::read(bytes, path, EVALUATION_SCHEMA)?;
    let (arm, arms) = table.text(0)?;
    let (skill, skills) = table.text(3)?;
    let (variant, variants) = table.text(6)?;
    let (room, rooms) = table.text(7)?;
    let (point, seed, trials, actions) = (table.count(1)?, table.count(2)?, table.count(4)?, table.count(5)?);
    let (episodes, successes, steps) = (table.count(8)?, table.count(9)?, table.count(10)?);
    let (reward, returned, collisions) = (table.double(11)?, table.double(12)?, table.count(13)?);
    let row = |i: usize| EvaluationRow {
        arm: arm[i],
        point: point[i],
        seed: seed[i],
        skill: skill[i],
        trials: trials[i],
        actions: actions[i],
        variant: variant[i],
        room: room[i],
        episodes: episodes[i],
        successes: successes[i],
        steps: steps[i],
        reward: reward[i],
        returned: returned[i],
        collisions: collisions[i],
    };
    Ok((Names { arms, skills, variants, rooms }, (0..table.rows).map(row).collect()))
}
