//! What stands where in a run folder.

use super::RecordError;
use super::file_system::FileSystem;
use std::io;
use std::path::Path;

/// Name of the resolved config in a run folder.
pub const CONFIG: &str = "config.toml";
/// Name of the config's own floor plan in a run folder.
pub const WORLD: &str = "world.toml";
/// What vouches for every other file, and says that the run is complete.
pub(super) const MANIFEST: &str = "manifest.json";
/// Keeps two processes from writing to one folder.
pub(super) const LOCK: &str = ".lock";
/// Tells a folder of ours from others.
pub(super) const MARKER: &str = ".skilltree";
/// Folder of the committed parts in a run folder.
pub(super) const PARTS: &str = "parts";
/// What is kept of the learners in training.
pub(super) const CHECKPOINT: &str = "checkpoint";

/// Whether a result or a file of the experiment may have this path: one inside the folder that is not kept for ourselves.
pub(super) fn is_free(name: &str) -> bool {
    is_plain(name) && ![MANIFEST, CHECKPOINT].contains(&name) && name.split('/').next() != Some(PARTS)
}

/// Whether a path stays in its folder: words of ordinary characters with `/` between, none starting with a dot.
pub(super) fn is_plain(path: &str) -> bool {
    path.split('/').all(|word| {
        !word.is_empty()
            && !word.starts_with('.')
            && word.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_' | '+' | '='))
    })
}

/// Learners whose results a folder's parts hold, and those of the whole run if there are parts, as their names say:
/// `32-of-640_...`.
pub(super) fn tally(disk: &dyn FileSystem, dir: &Path) -> Result<(u64, Option<u64>), RecordError> {
    let numbers = |name: &String| -> Option<(u64, u64)> {
        let (finished, rest) = name.split_once("-of-")?;
        Some((finished.parse().ok()?, rest.split('_').next()?.parse().ok()?))
    };
    let counts: Vec<(u64, u64)> = part_names(disk, dir)?.iter().filter_map(numbers).collect();
    let finished = counts.iter().fold(0_u64, |sum, (finished, _)| sum.saturating_add(*finished));
    Ok((finished, counts.first().map(|(_, of)| *of)))
}

/// Names of the committed parts, sorted.
pub(super) fn part_names(disk: &dyn FileSystem, dir: &Path) -> Result<Vec<String>, RecordError> {
    Ok(list(disk, &dir.join(PARTS))?.into_iter().filter(|name| is_plain(name)).collect())
}

/// Names in a folder, sorted; none if there is no such folder. Names that are not Unicode come out altered.
pub(super) fn list(disk: &dyn FileSystem, folder: &Path) -> Result<Vec<String>, RecordError> {
    let names = match disk.list(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        other => other.map_err(RecordError::unreadable(folder))?,
    };
    let mut names: Vec<String> = names.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// The content of a file, or none if there is no such file.
pub(super) fn read_if_there(disk: &dyn FileSystem, path: &Path) -> Result<Option<Vec<u8>>, RecordError> {
    match disk.read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        other => other.map(Some).map_err(RecordError::unreadable(path)),
    }
}
