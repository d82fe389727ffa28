//! Writing files so that a crash leaves either the old one or the new one, and the folders that hold them.

use super::RecordError;
use super::file_system::{FileSystem, Writing};
use super::manifest::{FileDigest, hexadecimal};
use super::paths::list;
use sha2::{Digest, Sha256};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Ends the name of every temporary file of ours, so that leftovers can be told from other people's files.
const TEMPORARY: &str = ".skilltree-tmp";
/// Bytes that gather before they are written.
const BUFFER: usize = 1 << 18;

/// A file that is written piece by piece and appears whole or not at all. Dropped without [`FileWriter::place`], it
/// leaves nothing.
pub struct FileWriter<'disk> {
    disk: &'disk dyn FileSystem,
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<Box<dyn Writing>>,
    hasher: Sha256,
    bytes: u64,
    placed: bool,
}

impl<'disk> FileWriter<'disk> {
    /// Begins the file that will stand at `path`; [`RecordError::NotCommitted`] if it cannot be.
    pub fn create(disk: &'disk dyn FileSystem, path: &Path) -> Result<Self, RecordError> {
        // The process number keeps two processes from writing the same temporary file.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let temporary = folder_of(path).join(format!(".{name}.{}{TEMPORARY}", std::process::id()));
        let file = disk.create(&temporary).map_err(RecordError::not_committed(path))?;
        let file = BufWriter::with_capacity(BUFFER, file);
        Ok(Self { disk, path: path.into(), temporary, file, hasher: Sha256::new(), bytes: 0, placed: false })
    }

    /// Number of the bytes written so far, and their SHA-256.
    pub(super) fn so_far(&self) -> (u64, [u8; 32]) {
        (self.bytes, self.hasher.clone().finalize().into())
    }

    /// Puts the file in its place: fsync, read back, rename. The folder's entry still needs [`sync_folder`]. On
    /// [`RecordError::NotCommitted`] the earlier state is intact.
    pub fn place(mut self) -> Result<FileDigest, RecordError> {
        let (bytes, hash) = self.so_far();
        let digest = FileDigest { bytes, sha256: hexadecimal(&hash) };
        let mut put = || {
            self.file.flush()?;
            self.file.get_mut().sync()?;
            if FileDigest::of_file(self.disk, &self.temporary)? != digest {
                return Err(io::Error::other("the file reads back differently"));
            }
            self.disk.rename(&self.temporary, &self.path)
        };
        put().map_err(RecordError::not_committed(&self.path))?;
        self.placed = true;
        Ok(digest)
    }
}

impl Write for FileWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Drop for FileWriter<'_> {
    fn drop(&mut self) {
        if !self.placed {
            // Best effort: a leftover is ignored by readers and removed by the next run.
            let _ = self.disk.remove_file(&self.temporary);
        }
    }
}

/// Writes `path` whole: temporary file beside it, fsync, read back, rename, fsync of the folder. The error is
/// [`RecordError::NotCommitted`] if the earlier state is intact, [`RecordError::DurabilityUnknown`] after the rename.
pub fn write(disk: &dyn FileSystem, path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    place(disk, path, bytes)?;
    sync_folder(disk, folder_of(path))
}

/// As [`write()`], without the last fsync: call [`sync_folder`] once after a batch of files.
pub fn place(disk: &dyn FileSystem, path: &Path, bytes: &[u8]) -> Result<FileDigest, RecordError> {
    let mut file = FileWriter::create(disk, path)?;
    file.write_all(bytes).map_err(RecordError::not_committed(path))?;
    file.place()
}

/// Asks the disk to keep the folder's entries, or else [`RecordError::DurabilityUnknown`].
pub fn sync_folder(disk: &dyn FileSystem, folder: &Path) -> Result<(), RecordError> {
    disk.sync_folder(folder).map_err(|source| RecordError::DurabilityUnknown { path: folder.into(), source })
}

/// Makes a folder, and those above it, that outlives a power cut as the files in it do.
pub fn make_folder(disk: &dyn FileSystem, folder: &Path) -> Result<(), RecordError> {
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
    disk.make_folder(folder).map_err(RecordError::not_committed(folder))?;
    parents.into_iter().rev().try_for_each(|parent| sync_folder(disk, parent))
}

/// Whether a file name is that of a temporary file of ours.
pub fn is_temporary(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(TEMPORARY)
}

/// Removes leftovers of a killed process from one folder, which must be held by the run folder's lock. A leftover that
/// cannot be removed does no harm.
pub fn remove_leftovers(disk: &dyn FileSystem, folder: &Path) -> Result<(), RecordError> {
    for name in list(disk, folder)?.iter().filter(|name| is_temporary(name)) {
        let _ = disk.remove_file(&folder.join(name));
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
