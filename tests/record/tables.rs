//! The two tables.

use super::open;
use parquet::basic::Type;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::TypePtr;
use parquet_derive::ParquetRecordWriter;
use skilltree::run_folder::tables::{read_evaluations, read_trials, write_table};
use skilltree::run_folder::{EvaluationRow, FORMAT, FinishedRun, Provenance, RecordError, Sums, TrialRow};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

fn word(list: &[&str], number: u32) -> String {
    list[number as usize].to_owned()
}

fn trials(count: u32) -> Vec<TrialRow> {
    let row = |i: u32| TrialRow {
        arm: word(&["flat", "tree"], i * 2 / count),
        point: i % 7,
        seed: u32::MAX - i % 5,
        skill: word(&["dock", "räume"], i * 4 / count % 2),
        trial: i,
        actions: i.wrapping_mul(2_654_435_761),
        steps: i % 255,
        reward: i as f32 * 0.1 - 3.0,
        success: i.is_multiple_of(3),
        collisions: i % 4,
        taught: i.is_multiple_of(10),
    };
    (0..count).map(row).collect()
}

fn evaluations(count: u32) -> Vec<EvaluationRow> {
    let row = |i: u32| EvaluationRow {
        arm: word(&["flat", "tree"], i * 2 / count),
        point: 0,
        seed: i % 5,
        skill: word(&["dock", "räume"], i * 4 / count % 2),
        trials: i,
        actions: 3_000_000_000 + i,
        variant: word(&["trained", "moved"], i.div_ceil(2) % 2),
        room: word(&["A", "B"], i % 2),
        episodes: 100,
        successes: i % 101,
        steps: i * 30,
        reward: f64::from(i) / 3.0,
        r#return: f64::from(i) / -7.0,
        collisions: i % 9,
    };
    (0..count).map(row).collect()
}

fn saved(dir: &TempDir, bytes: &[u8]) -> PathBuf {
    let path = dir.path().join("table.parquet");
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn tables_come_back_and_their_bytes_are_fixed() {
    let dir = TempDir::new().unwrap();
    // The last count takes more than one group of rows.
    for count in [2, 20_000, 140_000] {
        let bytes = write_table(&trials(count)).unwrap();
        assert_eq!((&bytes[..4], &bytes[bytes.len() - 4..]), (&b"PAR1"[..], &b"PAR1"[..]));
        assert_eq!(bytes, write_table(&trials(count)).unwrap());
        let (names, rows) = read_trials(&saved(&dir, &bytes)).unwrap();
        assert!(rows == trials(count), "{count} rows");
        assert_eq!((names.arms, names.rooms), (vec!["flat".to_owned(), "tree".to_owned()], vec![]));
        let bytes = write_table(&evaluations(count)).unwrap();
        let (names, rows) = read_evaluations(&saved(&dir, &bytes)).unwrap();
        assert!(rows == evaluations(count), "{count} rows");
        assert_eq!((names.rooms.concat(), names.variants.concat()), ("AB".to_owned(), "trainedmoved".to_owned()));
    }
    let empty = write_table::<TrialRow>(&[]).unwrap();
    assert_eq!(read_trials(&saved(&dir, &empty)).unwrap().1, vec![]);
}

/// What others read with: names, order and types of the columns, and that names are numbered in a dictionary.
#[test]
fn tables_have_the_columns_that_users_know() {
    let columns = |bytes: Vec<u8>| {
        let file = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let fields = file.metadata().file_metadata().schema().get_fields().to_vec();
        let named = file.metadata().row_group(0).columns().iter().zip(&fields).filter(|(chunk, field)| {
            field.get_physical_type() == Type::BYTE_ARRAY && chunk.dictionary_page_offset().is_none()
        });
        assert_eq!(named.count(), 0, "names without a dictionary");
        let text = |field: &TypePtr| format!("{} {}", field.name(), field.get_physical_type());
        fields.iter().map(text).collect::<Vec<_>>().join(", ")
    };
    assert_eq!(
        columns(write_table(&trials(9)).unwrap()),
        "arm BYTE_ARRAY, point INT32, seed INT32, skill BYTE_ARRAY, trial INT32, actions INT32, steps INT32, \
         reward FLOAT, success BOOLEAN, collisions INT32, taught BOOLEAN"
    );
    assert_eq!(
        columns(write_table(&evaluations(9)).unwrap()),
        "arm BYTE_ARRAY, point INT32, seed INT32, skill BYTE_ARRAY, trials INT32, actions INT32, variant BYTE_ARRAY, \
         room BYTE_ARRAY, episodes INT32, successes INT32, steps INT32, reward DOUBLE, return DOUBLE, collisions INT32"
    );
}

#[test]
fn sums_go_into_a_row_and_out_of_it_and_add_up() {
    let row = evaluations(9).swap_remove(4);
    assert_eq!(EvaluationRow { successes: 0, r#return: 0.0, ..row.clone() }.with_sums(row.sums()), row);
    let one = Sums { episodes: 1, successes: 2, steps: 3, collisions: 4, reward: 0.5, returned: -0.25 };
    let three = Sums { episodes: 3, successes: 6, steps: 9, collisions: 12, reward: 1.5, returned: -0.75 };
    let mut sum = Sums::default();
    [one; 3].into_iter().for_each(|one| sum += one);
    assert_eq!(sum, three);
}

#[derive(Clone, ParquetRecordWriter)]
struct Foreign {
    arm: String,
    trial: u64,
}

#[test]
fn tables_that_are_not_ours_are_refused() {
    let dir = TempDir::new().unwrap();
    let said = |bytes: &[u8]| read_trials(&saved(&dir, bytes)).unwrap_err().to_string();
    let message = said(&write_table(&evaluations(50)).unwrap());
    assert!(message.contains("table.parquet") && message.contains("no column `trial`"), "{message}");
    let message = said(&write_table(&[Foreign { arm: "flat".to_owned(), trial: 7 }]).unwrap());
    assert!(message.contains("no column `point`"), "{message}");
    let message = said(b"arm,point,seed\nflat,0,1\n");
    assert!(message.contains("table.parquet: damaged") && message.contains("hint: "), "{message}");
    // The format's number, a digit between its key and the file's end.
    let mut other = write_table(&trials(3)).unwrap();
    let key = other.windows(16).rposition(|text| text == b"skilltree.format").unwrap() + 16;
    let digit = key + other[key..].iter().position(u8::is_ascii_digit).unwrap();
    assert_eq!(other[digit], b'0' + FORMAT as u8);
    other[digit] += 1;
    assert!(matches!(read_trials(&saved(&dir, &other)), Err(RecordError::Format { .. })), "{}", said(&other));
}

/// Every cut of a table is an error wherever it is read. In a run folder the manifest's hash comes first: no altered byte
/// gets as far as the Parquet reader.
#[test]
fn damaged_tables_give_errors() {
    let dir = TempDir::new().unwrap();
    let bytes = write_table(&evaluations(40)).unwrap();
    for length in 0..bytes.len() {
        assert!(read_evaluations(&saved(&dir, &bytes[..length])).is_err(), "cut to {length}");
    }
    let run = dir.path().join("run");
    let files = [("evaluations.parquet".to_owned(), bytes.clone())];
    open(&run).unwrap().finish(files, Provenance::default()).unwrap();
    let finished = FinishedRun::read(&run).unwrap();
    assert_eq!(finished.content("evaluations.parquet").unwrap(), Some(bytes.clone()));
    for position in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut altered = bytes.clone();
            altered[position] ^= flip;
            fs::write(run.join("evaluations.parquet"), altered).unwrap();
            let message = finished.content("evaluations.parquet").unwrap_err().to_string();
            assert!(message.contains("evaluations.parquet: damaged"), "byte {position}: {message}");
        }
    }
}
