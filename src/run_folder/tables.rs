//! The two tables of sums, from which anybody can recompute every rate: `trials.parquet` and `evaluations.parquet`.
//!
//! A row's fields are the table's columns. Names are dictionary encoded by Parquet.

use super::file_system::{FileSystem, OsFileSystem};
use super::{FORMAT, RecordError};
use bytemuck::{Pod, Zeroable};
use bytes::Bytes;
use parquet::basic::Compression;
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, ParquetMetaData};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::{RecordReader, RecordWriter};
use parquet::schema::types::Type;
use parquet_derive::{ParquetRecordReader, ParquetRecordWriter};
use std::io::{self, Write};
use std::ops::AddAssign;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// File name of the training trials.
pub const TRIALS: &str = "trials.parquet";
/// File name of the tests.
pub const EVALUATIONS: &str = "evaluations.parquet";
/// The arm whose rows are the planner's own tests: a bound, not a learner.
pub const PLANNER: &str = "planner";
/// The variant of tests in the world and with the noise of training.
pub const TRAINED: &str = "trained";
/// Room of a test that starts in none.
pub const NO_ROOM: &str = "none";

/// Rows written together; bounds the memory that rows and the copies of their columns take.
const ROWS_PER_GROUP: usize = 1 << 17;
/// Key of the file metadata that holds [`FORMAT`].
const FORMAT_KEY: &str = "skilltree.format";

/// One training trial.
#[derive(Debug, Clone, Default, PartialEq, ParquetRecordWriter, ParquetRecordReader)]
pub struct TrialRow {
    /// Experimental condition.
    pub arm: String,
    /// Sweep point, counted from 0.
    pub point: u32,
    /// Seed of the learner.
    pub seed: u32,
    /// The skill in training.
    pub skill: String,
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
#[derive(Debug, Clone, Default, PartialEq, ParquetRecordWriter, ParquetRecordReader)]
pub struct EvaluationRow {
    /// Experimental condition, or [`PLANNER`] and what follows it.
    pub arm: String,
    /// Sweep point, counted from 0.
    pub point: u32,
    /// Seed of the learner.
    pub seed: u32,
    /// The skill under test.
    pub skill: String,
    /// Training trials of this skill so far.
    pub trials: u32,
    /// Primitive actions executed so far, in teaching and for child skills too.
    pub actions: u32,
    /// Circumstances of the test: [`TRAINED`], or an alteration's name.
    pub variant: String,
    /// Room in which the test trials start, or [`NO_ROOM`].
    pub room: String,
    /// As in [`Sums`], and so all that follow.
    pub episodes: u32,
    /// Test trials that ended as achieved.
    pub successes: u32,
    /// Primitive steps.
    pub steps: u32,
    /// Sum of rewards, undiscounted.
    pub reward: f64,
    /// Sum of discounted rewards.
    pub r#return: f64,
    /// Steps with contact.
    pub collisions: u32,
}

/// What is counted of test trials, from the kernel's episodes to the report's page.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct Sums {
    /// Test trials.
    pub episodes: u32,
    /// Test trials that ended as achieved.
    pub successes: u32,
    /// Primitive steps.
    pub steps: u32,
    /// Steps with contact.
    pub collisions: u32,
    /// Rewards, undiscounted, in the config's units.
    pub reward: f64,
    /// Rewards, each discounted from the start of its trial with the skill's own factor.
    pub returned: f64,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.episodes += other.episodes;
        self.successes += other.successes;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.returned += other.returned;
    }
}

impl EvaluationRow {
    /// What was counted of the test trials.
    pub fn sums(&self) -> Sums {
        let Self { episodes, successes, steps, collisions, reward, r#return: returned, .. } = *self;
        Sums { episodes, successes, steps, collisions, reward, returned }
    }

    /// The row of the same test with these sums.
    pub fn with_sums(self, sums: Sums) -> Self {
        let Sums { episodes, successes, steps, collisions, reward, returned } = sums;
        Self { episodes, successes, steps, collisions, reward, r#return: returned, ..self }
    }
}

/// The distinct names in the rows of a table, in the order of their first use: short numbers for long names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Names {
    /// Experimental conditions.
    pub arms: Vec<String>,
    /// Skills.
    pub skills: Vec<String>,
    /// Circumstances of tests.
    pub variants: Vec<String>,
    /// Rooms in which tests start.
    pub rooms: Vec<String>,
}

impl Names {
    /// Those of training trials.
    pub fn of_trials(rows: &[TrialRow]) -> Self {
        let (arms, skills) = (distinct(rows, |row| &row.arm), distinct(rows, |row| &row.skill));
        Self { arms, skills, ..Self::default() }
    }

    /// Those of tests.
    pub fn of_evaluations(rows: &[EvaluationRow]) -> Self {
        Self {
            arms: distinct(rows, |row| &row.arm),
            skills: distinct(rows, |row| &row.skill),
            variants: distinct(rows, |row| &row.variant),
            rooms: distinct(rows, |row| &row.room),
        }
    }

    /// Number of a name in a list of distinct ones; the list's length if it is not there.
    pub fn number(list: &[String], name: &str) -> u32 {
        list.iter().position(|known| known == name).unwrap_or(list.len()) as u32
    }
}

fn distinct<Row>(rows: &[Row], name: impl Fn(&Row) -> &String) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in rows.iter().map(name) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// A table that is written row by row, in bounded memory: Snappy, dictionaries, no times, nothing that depends on the
/// machine. The same rows give the same bytes; the caller has sorted them.
pub struct TableWriter<Row, Sink: Write + Send> {
    path: PathBuf,
    rows: Vec<Row>,
    file: SerializedFileWriter<Sink>,
}

impl<Row, Sink: Write + Send> TableWriter<Row, Sink>
where
    for<'rows> &'rows [Row]: RecordWriter<Row>,
{
    /// Begins a table; `path` is only for messages. [`RecordError::NotCommitted`] if `sink` takes no more, here and below.
    pub fn new(path: &Path, sink: Sink) -> Result<Self, RecordError> {
        let failed = |error| unwritten(path, error);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by("skilltree version 1 (build 0)".into())
            .set_key_value_metadata(Some(vec![KeyValue::new(FORMAT_KEY.into(), FORMAT.to_string())]))
            .build();
        let schema = (&[] as &[Row]).schema().map_err(failed)?;
        let file = SerializedFileWriter::new(sink, schema, Arc::new(properties)).map_err(failed)?;
        Ok(Self { path: path.into(), rows: Vec::new(), file })
    }

    /// Adds a row.
    pub fn push(&mut self, row: Row) -> Result<(), RecordError> {
        self.rows.push(row);
        if self.rows.len() < ROWS_PER_GROUP { Ok(()) } else { self.flush() }
    }

    /// Ends the table and hands back where it was written to.
    pub fn finish(mut self) -> Result<Sink, RecordError> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        self.file.into_inner().map_err(|error| unwritten(&self.path, error))
    }

    fn flush(&mut self) -> Result<(), RecordError> {
        let mut write = || {
            let mut group = self.file.next_row_group()?;
            self.rows.as_slice().write_to_row_group(&mut group)?;
            group.close().map(drop)
        };
        write().map_err(|error| unwritten(&self.path, error))?;
        self.rows.clear();
        Ok(())
    }
}

/// The disk's own error, or else a bug of ours.
fn unwritten(path: &Path, error: ParquetError) -> RecordError {
    let bug = |text: String| RecordError::invalid(path.display().to_string(), text);
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(source) => RecordError::NotCommitted { path: path.into(), source: *source },
            Err(error) => bug(error.to_string()),
        },
        error => bug(error.to_string()),
    }
}

/// The bytes of a whole table.
pub fn write_table<Row: Clone>(rows: &[Row]) -> Result<Vec<u8>, RecordError>
where
    for<'rows> &'rows [Row]: RecordWriter<Row>,
{
    let mut table = TableWriter::new(Path::new("a table"), Vec::new())?;
    rows.iter().try_for_each(|row| table.push(row.clone()))?;
    table.finish()
}

/// Reads a table of training trials; [`RecordError::Unreadable`], otherwise as [`parse_trials`].
pub fn read_trials(path: &Path) -> Result<(Names, Vec<TrialRow>), RecordError> {
    parse_trials(OsFileSystem.read(path).map_err(RecordError::unreadable(path))?, path)
}

/// As [`read_trials`], from the file's content: [`RecordError::Damaged`] for anything but a table of exactly these columns,
/// [`RecordError::Format`] for one of another version. `path` is only for messages.
pub fn parse_trials(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<TrialRow>), RecordError> {
    let rows: Vec<TrialRow> = rows_of(bytes, path)?;
    Ok((Names::of_trials(&rows), rows))
}

/// Reads a table of tests, as [`read_trials`].
pub fn read_evaluations(path: &Path) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
    parse_evaluations(OsFileSystem.read(path).map_err(RecordError::unreadable(path))?, path)
}

/// As [`parse_trials`], of tests.
pub fn parse_evaluations(bytes: Vec<u8>, path: &Path) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
    let rows: Vec<EvaluationRow> = rows_of(bytes, path)?;
    Ok((Names::of_evaluations(&rows), rows))
}

/// All rows of a table. In a run folder the bytes have passed the manifest's hash before.
fn rows_of<Row>(bytes: Vec<u8>, path: &Path) -> Result<Vec<Row>, RecordError>
where
    for<'rows> &'rows [Row]: RecordWriter<Row>,
    Vec<Row>: RecordReader<Row>,
{
    let read = || -> Result<Vec<Row>, RecordError> {
        let damaged = |error: ParquetError| RecordError::damaged(path, error.to_string());
        let file = SerializedFileReader::new(Bytes::from(bytes)).map_err(damaged)?;
        check_columns(path, file.metadata(), &*(&[] as &[Row]).schema().map_err(damaged)?)?;
        check_format(path, file.metadata())?;
        let mut all = Vec::new();
        for number in 0..file.num_row_groups() {
            let mut group = file.get_row_group(number).map_err(damaged)?;
            let count = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
            let mut rows = Vec::new();
            rows.read_from_row_group(&mut *group, count).map_err(damaged)?;
            all.append(&mut rows);
        }
        Ok(all)
    };
    // The parquet crate and its derived readers assert what only a forged file breaks. Nothing outlives a panic here.
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(RecordError::damaged(path, "not a Parquet file that can be decoded")))
}

/// The columns are those of the row, whatever their order: name, type, meaning, and that no value is absent.
fn check_columns(path: &Path, metadata: &ParquetMetaData, expected: &Type) -> Result<(), RecordError> {
    let (expected, found) = (expected.get_fields(), metadata.file_metadata().schema().get_fields());
    let kind = |column: &Type| {
        let basic = column.get_basic_info();
        let repetition = basic.has_repetition().then(|| basic.repetition());
        (column.is_primitive().then(|| column.get_physical_type()), basic.logical_type_ref().cloned(), repetition)
    };
    let problem = |expected: &Arc<Type>| match found.iter().find(|column| column.name() == expected.name()) {
        None => Some(format!("no column `{}`", expected.name())),
        Some(column) if kind(column) != kind(expected) => Some(format!("column `{}` has another type", column.name())),
        Some(_) => None,
    };
    let is_unknown = |column: &&Arc<Type>| expected.iter().all(|other| other.name() != column.name());
    let problem = if let Some(problem) = expected.iter().find_map(problem) {
        problem
    } else if let Some(column) = found.iter().find(is_unknown) {
        format!("unknown column `{}`", column.name())
    } else if found.len() != expected.len() {
        "a column comes twice".to_owned()
    } else {
        return Ok(());
    };
    Err(RecordError::damaged(path, problem))
}

fn check_format(path: &Path, metadata: &ParquetMetaData) -> Result<(), RecordError> {
    let entries = metadata.file_metadata().key_value_metadata();
    let found = entries.and_then(|entries| entries.iter().find(|entry| entry.key == FORMAT_KEY));
    let found = found.and_then(|entry| entry.value.clone()).unwrap_or_else(|| "unknown".into());
    if found == FORMAT.to_string() {
        return Ok(());
    }
    Err(RecordError::Format { path: path.into(), found, known: FORMAT })
}
