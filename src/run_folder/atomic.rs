//! Writing a file so that a crash leaves either the old one or the new one.

use super::RecordError;
use super::file_system::Disk;
use std::io;
use std::path::{Path, PathBuf};

/// Ends the name of every temporary file of ours, so that leftovers can be told from other people's files.
const TEMPORARY: &str = ".skilltree-tmp";

/// Writes `path` whole: temporary file beside it, fsync, read back, rename, fsync of the folder.
///
/// # Errors
/// [`RecordError::NotCommitted`] if the earlier state is intact, [`RecordError::DurabilityUnknown`] after the rename.
pub fn write(disk: &dyn Disk, path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    place(disk, path, bytes)?;
    sync_folder(disk, folder_of(path))
}

/// As [`write()`], without the last fsync: call [`sync_folder`] once after a batch of files.
///
/// # Errors
/// [`RecordError::NotCommitted`]: the earlier state is intact.
pub fn place(disk: &dyn Disk, path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    let temporary = temporary_name(path);
    let attempt = write_verified(disk, &temporary, bytes).and_then(|()| disk.rename(&temporary, path));
    attempt.map_err(|source| {
        // Best effort: a leftover is ignored by readers and removed by the next run.
        let _ = disk.remove_file(&temporary);
        RecordError::NotCommitted { path: path.into(), source }
    })
}

fn write_verified(disk: &dyn Disk, temporary: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = disk.create(temporary)?;
    file.write_all(bytes)?;
    file.sync()?;
    drop(file);
    if disk.read(temporary)? == bytes { Ok(()) } else { Err(io::Error::other("the file reads back differently")) }
}

/// Asks the disk to keep the folder's entries.
///
/// # Errors
/// [`RecordError::DurabilityUnknown`].
pub fn sync_folder(disk: &dyn Disk, folder: &Path) -> Result<(), RecordError> {
    disk.sync_folder(folder).map_err(|source| RecordError::DurabilityUnknown { path: folder.into(), source })
}

/// Makes a folder, and those above it, that outlives a power cut as the files in it do.
///
/// # Errors
/// [`RecordError::Unreadable`], [`RecordError::NotCommitted`], or [`RecordError::DurabilityUnknown`] once it is there.
pub fn make_folder(disk: &dyn Disk, folder: &Path) -> Result<(), RecordError> {
    let mut parents = Vec::new();
    let mut new = folder;
    while disk.kind(new).map_err(RecordError::unreadable(new))?.is_none() {
        let parent = folder_of(new);
        parents.push(parent);
        // A relative path ends in the working folder, which is there.
        if parent == Path::new(".") {
            break;
        }
        new = parent;
    }
    disk.make_folder(folder).map_err(|source| RecordError::NotCommitted { path: folder.into(), source })?;
    parents.into_iter().rev().try_for_each(|parent| sync_folder(disk, parent))
}

/// Whether a file name is that of a temporary file of ours.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(TEMPORARY)
}

/// Removes leftovers of a killed process from one folder. Call it only while holding the run folder's lock.
///
/// # Errors
/// [`RecordError::Unreadable`] if the folder cannot be listed. A leftover that cannot be removed does no harm.
pub fn remove_leftovers(disk: &dyn Disk, folder: &Path) -> Result<(), RecordError> {
    for name in list(disk, folder)? {
        if is_temporary(&name) {
            let _ = disk.remove_file(&folder.join(name));
        }
    }
    Ok(())
}

/// Names in a folder, sorted; none if there is no such folder. Names that are not Unicode come out altered.
///
/// # Errors
/// [`RecordError::Unreadable`].
pub fn list(disk: &dyn Disk, folder: &Path) -> Result<Vec<String>, RecordError> {
    let names = match disk.list(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        other => other.map_err(RecordError::unreadable(folder))?,
    };
    let mut names: Vec<String> = names.iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// The content of a file, or none if there is no such file.
///
/// # Errors
/// [`RecordError::Unreadable`].
pub fn read_if_there(disk: &dyn Disk, path: &Path) -> Result<Option<Vec<u8>>, RecordError> {
    match disk.read(path) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(RecordError::Unreadable { path: path.into(), source }),
    }
}

/// The process number keeps two processes from writing the same temporary file.
pub(super) fn temporary_name(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    folder_of(path).join(format!(".{name}.{}{TEMPORARY}", std::process::id()))
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
