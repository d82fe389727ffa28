//! The JSON files of a run folder: written, read and checked in one way.

use super::RecordError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// A JSON file of a run folder: each implementation is one file. Keys that a file's type does not have are ignored.
pub trait JsonFile: Serialize + DeserializeOwned {
    /// The file's name in a run folder.
    const NAME: &'static str;
    /// Whether numbers have a line each, for people to read.
    const PRETTY: bool;

    /// What is wrong with values that have the right types, if anything is.
    fn problem(&self) -> Option<String> {
        None
    }

    /// JSON text, ending with a line feed; [`RecordError::Invalid`] if a number has no JSON form.
    fn to_bytes(&self) -> Result<Vec<u8>, RecordError> {
        write(Self::NAME, self, Self::PRETTY)
    }

    /// Reads the file's content, or else [`RecordError::Damaged`]; `path` is only for messages.
    fn parse(bytes: &[u8], path: &Path) -> Result<Self, RecordError> {
        let content: Self = read(bytes, path)?;
        content.problem().map_or(Ok(content), |problem| Err(RecordError::damaged(path, problem)))
    }
}

/// JSON text; numbers have a line each if it is `pretty`.
pub(super) fn write(name: &str, value: &impl Serialize, pretty: bool) -> Result<Vec<u8>, RecordError> {
    let text = if pretty { serde_json::to_string_pretty(value) } else { serde_json::to_string(value) };
    Ok((text.map_err(|error| RecordError::invalid(name, error.to_string()))? + "\n").into_bytes())
}

/// Reads JSON; `path` is only for messages.
pub(super) fn read<T: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<T, RecordError> {
    serde_json::from_slice(bytes).map_err(|error| RecordError::damaged(path, error.to_string()))
}
