//! JSON files of a run folder.

use super::RecordError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// The text of a file; numbers with a line each if it is for people to read.
///
/// # Errors
/// [`RecordError::Invalid`] if a value has no JSON form.
pub(super) fn write(name: &str, value: &impl Serialize, for_people: bool) -> Result<Vec<u8>, RecordError> {
    let text = if for_people { serde_json::to_string_pretty(value) } else { serde_json::to_string(value) };
    Ok((text.map_err(|error| RecordError::invalid(name, error.to_string()))? + "\n").into_bytes())
}

/// Reads a file's content; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`].
pub(super) fn read<T: DeserializeOwned>(bytes: &[u8], path: &Path) -> Result<T, RecordError> {
    serde_json::from_slice(bytes).map_err(|error| RecordError::damaged(path, error.to_string()))
}
