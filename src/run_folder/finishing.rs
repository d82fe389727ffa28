//! The end of a run: its results and its manifest.

use super::folder::{RunFolder, is_free};
use super::manifest::FileDigest;
use super::stream::Stream;
use super::{FORMAT, Manifest, Provenance, RecordError, atomic};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Writes the results of a run, each whole, then the manifest that makes it complete. Until then the parts stay, so that
/// all of this can be repeated.
#[derive(Debug)]
pub struct Finishing<'folder> {
    folder: &'folder RunFolder,
    digests: BTreeMap<String, FileDigest>,
    /// Folders with new entries.
    folders: BTreeSet<PathBuf>,
}

impl<'folder> Finishing<'folder> {
    pub(super) fn new(folder: &'folder RunFolder) -> Result<Self, RecordError> {
        let mut digests = BTreeMap::new();
        for name in folder.given() {
            let path = folder.dir().join(name);
            let digest = FileDigest::of_file(&**folder.disk(), &path).map_err(RecordError::unreadable(&path))?;
            digests.insert(name.clone(), digest);
        }
        Ok(Self { folder, digests, folders: BTreeSet::from([folder.dir().into()]) })
    }

    /// Writes one result file. One that an interrupted end has left with these bytes stays as it is.
    ///
    /// # Errors
    /// [`RecordError::Invalid`] for a path that leaves the folder, is taken or comes twice; otherwise as
    /// [`atomic::place`].
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), RecordError> {
        let path = self.path_of(name)?;
        let disk = &**self.folder.disk();
        if !disk.read(&path).is_ok_and(|found| found == bytes) {
            atomic::place(disk, &path, bytes)?;
        }
        self.digests.insert(name.to_owned(), FileDigest::of(bytes));
        Ok(())
    }

    /// Begins a result file that is written piece by piece.
    ///
    /// # Errors
    /// As [`Finishing::add`].
    pub fn begin(&mut self, name: &str) -> Result<Stream, RecordError> {
        let path = self.path_of(name)?;
        Stream::create(self.folder.disk(), &path)
    }

    /// Ends a file that was begun under this name.
    ///
    /// # Errors
    /// As [`Finishing::add`].
    pub fn end(&mut self, name: &str, file: Stream) -> Result<(), RecordError> {
        if file.path() != self.path_of(name)? {
            return Err(RecordError::invalid(name, "not the name under which the file was begun"));
        }
        self.digests.insert(name.to_owned(), file.place()?);
        Ok(())
    }

    /// Writes the manifest, then removes the parts.
    ///
    /// # Errors
    /// As [`atomic::write()`].
    pub fn complete(self, provenance: Provenance) -> Result<Manifest, RecordError> {
        let disk = &**self.folder.disk();
        for folder in self.folders.iter().rev() {
            atomic::sync_folder(disk, folder)?;
        }
        let manifest = Manifest { format: FORMAT, provenance, files: self.digests };
        atomic::write(disk, &self.folder.dir().join(Manifest::NAME), &manifest.to_bytes()?)?;
        self.folder.remove_parts();
        Ok(manifest)
    }

    /// Where a file goes; its folder is made.
    fn path_of(&mut self, name: &str) -> Result<PathBuf, RecordError> {
        if !is_free(name) || self.digests.contains_key(name) {
            return Err(RecordError::invalid(name, "not a free path inside the run folder"));
        }
        let path = self.folder.dir().join(name);
        let folder = path.parent().unwrap_or(Path::new("."));
        if !self.folders.contains(folder) {
            let disk = &**self.folder.disk();
            atomic::make_folder(disk, folder)?;
            atomic::remove_leftovers(disk, folder)?;
            self.folders.insert(folder.into());
        }
        Ok(path)
    }
}
