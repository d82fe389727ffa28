//! The end of a run: its results and its manifest.

use super::file_system::FileSystem;
use super::manifest::FileDigest;
use super::paths::is_free;
use super::writer::{self, FileWriter};
use super::{FORMAT, JsonFile, Manifest, Provenance, RecordError};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Writes the results of a run, each whole; [`RunFolder::complete`](super::RunFolder::complete) then writes the manifest
/// that vouches for them. All of this can be repeated.
#[derive(Debug)]
pub struct ResultsWriter<'folder> {
    disk: &'folder dyn FileSystem,
    dir: &'folder Path,
    digests: BTreeMap<String, FileDigest>,
    /// Folders with new entries.
    folders: BTreeSet<PathBuf>,
}

impl<'folder> ResultsWriter<'folder> {
    /// For a run that was made from the files of these names.
    pub(super) fn new(
        disk: &'folder dyn FileSystem,
        dir: &'folder Path,
        given: &[String],
    ) -> Result<Self, RecordError> {
        let mut digests = BTreeMap::new();
        for name in given {
            let path = dir.join(name);
            let digest = FileDigest::of_file(disk, &path).map_err(RecordError::unreadable(&path))?;
            digests.insert(name.clone(), digest);
        }
        Ok(Self { disk, dir, digests, folders: BTreeSet::from([dir.into()]) })
    }

    /// Writes one result file. One that an interrupted end has left with these bytes stays as it is. A path that leaves the
    /// folder, is taken or comes twice is [`RecordError::Invalid`].
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), RecordError> {
        let path = self.path_of(name)?;
        let digest = match self.disk.read(&path) {
            Ok(found) if found == bytes => FileDigest::of(bytes),
            _ => writer::place(self.disk, &path, bytes)?,
        };
        self.digests.insert(name.to_owned(), digest);
        Ok(())
    }

    /// Writes one JSON file, as [`ResultsWriter::add`].
    pub fn add_json<T: JsonFile>(&mut self, content: &T) -> Result<(), RecordError> {
        self.add(T::NAME, &content.to_bytes()?)
    }

    /// Begins a result file that is written piece by piece and ended under the same name.
    pub fn begin(&mut self, name: &str) -> Result<FileWriter<'folder>, RecordError> {
        FileWriter::create(self.disk, &self.path_of(name)?)
    }

    /// Ends a file that was begun under this name.
    pub fn end(&mut self, name: &str, file: FileWriter<'_>) -> Result<(), RecordError> {
        self.digests.insert(name.to_owned(), file.place()?);
        Ok(())
    }

    /// Writes the manifest.
    pub(super) fn manifest(self, provenance: Provenance) -> Result<Manifest, RecordError> {
        self.folders.iter().rev().try_for_each(|folder| writer::sync_folder(self.disk, folder))?;
        let manifest = Manifest { format: FORMAT, provenance, files: self.digests };
        writer::write(self.disk, &self.dir.join(Manifest::NAME), &manifest.to_bytes()?)?;
        Ok(manifest)
    }

    /// Where a file goes; its folder is made.
    fn path_of(&mut self, name: &str) -> Result<PathBuf, RecordError> {
        if !is_free(name) || self.digests.contains_key(name) {
            return Err(RecordError::invalid(name, "not a free path inside the run folder"));
        }
        let path = self.dir.join(name);
        let folder = path.parent().unwrap_or(Path::new("."));
        if !self.folders.contains(folder) {
            writer::make_folder(self.disk, folder)?;
            writer::remove_leftovers(self.disk, folder)?;
            self.folders.insert(folder.into());
        }
        Ok(path)
    }
}
