//! Columns of a table, to and from Parquet. Knows nothing of what they mean.

use super::thrift::{footer_is_sound, pages_are_sound};
use super::{FORMAT, RecordError};
use bytes::Bytes;
use parquet::basic::Compression;
use parquet::column::reader::get_typed_column_reader;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, ParquetMetaData};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::Type;
use std::cell::Cell;
use std::collections::HashMap;
use std::io::{self, Write};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Once};

/// Rows written together; bounds the memory that rows and the copies of their columns take.
pub(super) const ROWS_PER_GROUP: usize = 1 << 17;
/// Key of the file metadata that holds [`FORMAT`].
const FORMAT_KEY: &str = "skilltree.format";
/// Rows decoded at a time.
const BATCH: usize = 1 << 14;
/// No honest table packs more rows than this into a byte; a forged row count would otherwise ask for any memory.
const ROWS_PER_BYTE: u64 = 64;

/// One column's values. Names are kept once, with an index per row.
#[derive(Debug)]
pub(super) enum Column {
    Text(Vec<u32>, Vec<String>),
    Count(Vec<i32>),
    Flag(Vec<bool>),
    Single(Vec<f32>),
    Double(Vec<f64>),
}

impl Column {
    pub(super) fn text(codes: impl Iterator<Item = u32>, names: &[String]) -> Result<Self, RecordError> {
        let codes: Vec<u32> = codes.collect();
        match codes.iter().find(|&&code| code as usize >= names.len()) {
            Some(code) => Err(RecordError::invalid("table", format!("row names entry {code} of {}", names.len()))),
            None => Ok(Self::Text(codes, names.to_vec())),
        }
    }

    /// Parquet keeps unsigned integers in signed ones of the same bits.
    pub(super) fn count(values: impl Iterator<Item = u32>) -> Self {
        Self::Count(values.map(u32::cast_signed).collect())
    }
}

/// A Parquet file in the making: Snappy, dictionaries, no times, nothing that depends on the machine.
pub(super) struct Writer<Sink: Write + Send> {
    path: PathBuf,
    file: SerializedFileWriter<Sink>,
}

impl<Sink: Write + Send> Writer<Sink> {
    /// `path` is only for messages.
    pub(super) fn new(path: &Path, schema: &str, sink: Sink) -> Result<Self, RecordError> {
        let failed = |error| unwritten(path, error);
        let schema = Arc::new(parse_message_type(schema).map_err(failed)?);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by("skilltree version 1 (build 0)".into())
            .set_key_value_metadata(Some(vec![KeyValue::new(FORMAT_KEY.into(), FORMAT.to_string())]))
            .build();
        let file = SerializedFileWriter::new(sink, schema, Arc::new(properties)).map_err(failed)?;
        Ok(Self { path: path.into(), file })
    }

    /// Writes some rows, column by column.
    pub(super) fn group(&mut self, columns: Vec<Column>) -> Result<(), RecordError> {
        write_group(&mut self.file, columns).map_err(|error| unwritten(&self.path, error))
    }

    /// Ends the file and hands back where it was written to.
    pub(super) fn finish(self) -> Result<Sink, RecordError> {
        self.file.into_inner().map_err(|error| unwritten(&self.path, error))
    }
}

/// The disk's own error, or else a bug of ours.
fn unwritten(path: &Path, error: ParquetError) -> RecordError {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(source) => RecordError::NotCommitted { path: path.into(), source: *source },
            Err(error) => RecordError::invalid(path.display().to_string(), error.to_string()),
        },
        error => RecordError::invalid(path.display().to_string(), error.to_string()),
    }
}

fn write_group<Sink: Write + Send>(
    file: &mut SerializedFileWriter<Sink>,
    group: Vec<Column>,
) -> Result<(), ParquetError> {
    let mut rows = file.next_row_group()?;
    for column in group {
        let Some(mut writer) = rows.next_column()? else {
            return Err(ParquetError::General("more columns than the schema has".into()));
        };
        match (writer.untyped(), &column) {
            (ColumnWriter::ByteArrayColumnWriter(to), Column::Text(codes, names)) => {
                let names: Vec<ByteArray> = names.iter().map(|name| ByteArray::from(name.as_str())).collect();
                let values: Vec<ByteArray> = codes.iter().map(|&code| names[code as usize].clone()).collect();
                to.write_batch(&values, None, None)?
            }
            (ColumnWriter::Int32ColumnWriter(to), Column::Count(values)) => to.write_batch(values, None, None)?,
            (ColumnWriter::BoolColumnWriter(to), Column::Flag(values)) => to.write_batch(values, None, None)?,
            (ColumnWriter::FloatColumnWriter(to), Column::Single(values)) => to.write_batch(values, None, None)?,
            (ColumnWriter::DoubleColumnWriter(to), Column::Double(values)) => to.write_batch(values, None, None)?,
            _ => return Err(ParquetError::General("a column is not of the schema's type".into())),
        };
        writer.close()?;
    }
    rows.close()?;
    Ok(())
}

/// A table whose schema has been checked; columns are read when asked for.
pub(super) struct Table<'path> {
    /// Every column has this many values.
    pub(super) rows: usize,
    path: &'path Path,
    reader: SerializedFileReader<Bytes>,
}

impl<'path> Table<'path> {
    /// Opens a file's content that has exactly the columns of the schema; `path` is only for messages.
    pub(super) fn read(file: Vec<u8>, path: &'path Path, schema: &str) -> Result<Self, RecordError> {
        let damaged = |error: ParquetError| RecordError::damaged(path, error.to_string());
        let bytes = file.len() as u64;
        let forged = || RecordError::damaged(path, "it claims to hold more than its length allows");
        let file = Bytes::from(file);
        if !footer_is_sound(&file) {
            return Err(forged());
        }
        let reader = SerializedFileReader::new(file.clone()).map_err(damaged)?;
        if !pages_are_sound(&file, reader.metadata()) {
            return Err(forged());
        }
        check_schema(path, reader.metadata(), &parse_message_type(schema).map_err(damaged)?)?;
        check_format(path, reader.metadata())?;
        let rows = u64::try_from(reader.metadata().file_metadata().num_rows())
            .ok()
            .filter(|&rows| rows / ROWS_PER_BYTE <= bytes)
            .and_then(|rows| usize::try_from(rows).ok())
            .ok_or_else(|| RecordError::damaged(path, "an impossible number of rows"))?;
        Ok(Self { rows, path, reader })
    }

    /// A column of names: an index per row, and the names in the order of first use.
    pub(super) fn text(&self, column: usize) -> Result<(Vec<u32>, Vec<String>), RecordError> {
        let (mut names, mut codes) = (Vec::new(), HashMap::new());
        let values = self.values::<ByteArrayType, u32>(column, |value| {
            if let Some(&code) = codes.get(value.data()) {
                return Ok(code);
            }
            let code = names.len() as u32;
            names.push(value.as_utf8()?.to_owned());
            codes.insert(value.data().to_vec(), code);
            Ok(code)
        })?;
        Ok((values, names))
    }

    pub(super) fn count(&self, column: usize) -> Result<Vec<u32>, RecordError> {
        self.values::<Int32Type, _>(column, |value| Ok(value.cast_unsigned()))
    }

    pub(super) fn flag(&self, column: usize) -> Result<Vec<bool>, RecordError> {
        self.values::<BoolType, _>(column, |&value| Ok(value))
    }

    pub(super) fn single(&self, column: usize) -> Result<Vec<f32>, RecordError> {
        self.values::<FloatType, _>(column, |&value| Ok(value))
    }

    pub(super) fn double(&self, column: usize) -> Result<Vec<f64>, RecordError> {
        self.values::<DoubleType, _>(column, |&value| Ok(value))
    }

    fn values<D: DataType, T>(
        &self,
        column: usize,
        mut convert: impl FnMut(&D::T) -> Result<T, ParquetError>,
    ) -> Result<Vec<T>, RecordError> {
        let damaged = |error: ParquetError| RecordError::damaged(self.path, format!("column {column}: {error}"));
        let mut values = Vec::new();
        let mut batch = Vec::with_capacity(BATCH);
        for group in 0..self.reader.num_row_groups() {
            let from = self.reader.get_row_group(group).and_then(|group| group.get_column_reader(column));
            // The schema check has settled the type, so this cannot meet another.
            let mut from = get_typed_column_reader::<D>(from.map_err(damaged)?);
            loop {
                batch.clear();
                let (read, _, _) = from.read_records(BATCH, None, None, &mut batch).map_err(damaged)?;
                if read == 0 {
                    break;
                }
                if values.len() + batch.len() > self.rows {
                    return Err(damaged(ParquetError::General("more values than rows".into())));
                }
                for value in &batch {
                    values.push(convert(value).map_err(damaged)?);
                }
            }
        }
        if values.len() == self.rows {
            return Ok(values);
        }
        Err(damaged(ParquetError::General(format!("{} values for {} rows", values.len(), self.rows))))
    }
}

fn check_schema(path: &Path, metadata: &ParquetMetaData, expected: &Type) -> Result<(), RecordError> {
    let found = metadata.file_metadata().schema();
    let damaged = |problem| Err(RecordError::damaged(path, problem));
    let (expected, found) = (expected.get_fields(), found.get_fields());
    if let Some(missing) = expected.iter().find(|field| found.iter().all(|other| other.name() != field.name())) {
        return damaged(format!("no column `{}`", missing.name()));
    }
    if let Some(unknown) = found.iter().find(|field| expected.iter().all(|other| other.name() != field.name())) {
        return damaged(format!("unknown column `{}`", unknown.name()));
    }
    if found.len() != expected.len() {
        return damaged("a column comes twice".into());
    }
    for (found, expected) in found.iter().zip(expected) {
        if found.name() != expected.name() {
            return damaged(format!("column `{}` where `{}` belongs", found.name(), expected.name()));
        }
        // The physical type, the meaning and `REQUIRED` matter; field ids and the older type notation do not.
        let (a, b) = (found.get_basic_info(), expected.get_basic_info());
        let same = found.is_primitive()
            && found.get_physical_type() == expected.get_physical_type()
            && a.logical_type_ref() == b.logical_type_ref()
            && a.has_repetition()
            && a.repetition() == b.repetition();
        if !same {
            return damaged(format!("column `{}` has another type", found.name()));
        }
    }
    Ok(())
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

thread_local! {
    /// Whether this thread is within [`guarded`].
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}

/// Turns a panic of the parquet crate into an error: it asserts things that a damaged file can break (in 60.1.0 the
/// sign of offsets and the presence of dictionaries). Files of a run folder have passed their hash before.
pub(super) fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T, RecordError>) -> Result<T, RecordError> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        // The error says it all: a message about a panic before it would only alarm.
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if !GUARDED.get() {
                usual(info);
            }
        }));
    });
    GUARDED.set(true);
    // Nothing outlives a panic here: the reader and all columns are dropped with it.
    let outcome = panic::catch_unwind(AssertUnwindSafe(read));
    GUARDED.set(false);
    outcome.unwrap_or_else(|_| Err(RecordError::damaged(path, "not a Parquet file that can be decoded")))
}
