//! The run folder while a run writes to it.

use super::checksummed::{self, Refusal};
use super::file_system::{FileSystem, Lock, OsFileSystem, TryLockError};
use super::paths::{CHECKPOINT, LOCK, MARKER, PARTS, is_free, is_plain, list, part_names, read_if_there};
use super::{FORMAT, FinishedRun, Manifest, Provenance, RecordError, ResultsWriter, writer};
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use super::paths::{CONFIG, WORLD};

/// How far a run folder has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Nothing computed yet.
    Fresh,
    /// Parts are committed, or learners in training are kept: the run can be resumed.
    Partial,
    /// The manifest is there: nothing is left to do.
    Complete,
}

/// A run folder, locked against other writers until it is dropped or finished.
#[derive(Debug)]
pub struct RunFolder {
    disk: Arc<dyn FileSystem>,
    dir: PathBuf,
    /// Names of the config and of the world files.
    given: Vec<String>,
    /// This program and this plan, as parts name them.
    maker: String,
    state: State,
    _lock: Lock,
}

impl RunFolder {
    /// Creates the folder, or opens the one that the same experiment left behind. `worlds` are the names and texts
    /// of the world files, [`WORLD`] among them.
    ///
    /// # Errors
    /// If the folder cannot be written, is in use, holds anything else than a run of exactly this config and these
    /// worlds, or is complete but fails verification. Nothing is overwritten.
    pub fn open(dir: &Path, config_text: &str, worlds: &[(&str, &str)]) -> Result<Self, RecordError> {
        Self::open_on(Arc::new(OsFileSystem), dir, config_text, worlds)
    }

    /// As [`RunFolder::open`], on a file system of the caller's; all that is done with the folder goes through it.
    pub fn open_on(
        disk: Arc<dyn FileSystem>,
        dir: &Path,
        config_text: &str,
        worlds: &[(&str, &str)],
    ) -> Result<Self, RecordError> {
        let on = &*disk;
        let given: Vec<(&str, &str)> = [(CONFIG, config_text)].iter().chain(worlds).copied().collect();
        check_names(&given)?;
        // What keeps the folder from being made, such as a file in its place, is a matter of `--out`.
        writer::make_folder(on, dir).map_err(|error| match error {
            RecordError::NotCommitted { path, source } => RecordError::Unwritable { path, source },
            other => other,
        })?;
        refuse_foreign(on, dir)?;
        let lock = lock(on, dir)?;
        // Once more under the lock: another process may have filled the folder in between.
        refuse_foreign(on, dir)?;
        let folders: BTreeSet<PathBuf> =
            given.iter().filter_map(|(name, _)| Some(dir.join(name).parent()?.into())).collect();
        for folder in folders.iter().chain([&dir.join(PARTS)]) {
            writer::remove_leftovers(on, folder)?;
        }
        let complete = exists(on, &dir.join(Manifest::NAME))?;
        let started = complete || exists(on, &dir.join(CHECKPOINT))? || !part_names(on, dir)?.is_empty();
        let marker = dir.join(MARKER);
        if !exists(on, &marker)? {
            writer::write(on, &marker, marker_text().as_bytes())?;
        }
        for (name, text) in &given {
            let path = dir.join(name);
            match read_if_there(on, &path)? {
                Some(bytes) if bytes == text.as_bytes() => {}
                Some(_) => return Err(RecordError::OtherExperiment { path: dir.into(), file: (*name).to_owned() }),
                None if started => return Err(RecordError::damaged(&path, "missing, although results exist")),
                None => {
                    writer::make_folder(on, path.parent().unwrap_or(dir))?;
                    writer::write(on, &path, text.as_bytes())?;
                }
            }
        }
        let maker = checksummed::maker(&given);
        let given = given.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut folder = Self { disk, dir: dir.into(), given, maker, state: State::Fresh, _lock: lock };
        if complete {
            FinishedRun::read_on(Arc::clone(&folder.disk), dir)?;
            folder.state = State::Complete;
            folder.remove_parts();
        } else if started {
            folder.state = State::Partial;
        }
        Ok(folder)
    }

    /// Where the folder lies.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// How far the run has come.
    pub fn state(&self) -> State {
        self.state
    }

    /// Names of the committed parts, sorted.
    pub fn parts(&self) -> Result<Vec<String>, RecordError> {
        part_names(&*self.disk, &self.dir)
    }

    /// Commits one cohort's results under a name of letters, digits, `.`, `-`, `_`. Replaces a part of that name whole.
    /// Another name, or a complete run, is [`RecordError::Invalid`].
    pub fn commit_part(&mut self, name: &str, content: &[u8]) -> Result<(), RecordError> {
        let path = self.part_path(name)?;
        if self.state == State::Complete {
            return Err(RecordError::invalid(name, "the run is complete and takes no more parts"));
        }
        let parts = self.dir.join(PARTS);
        writer::make_folder(&*self.disk, &parts)?;
        checksummed::write(&*self.disk, &path, &self.maker, &mut |file| file.write_all(content))?;
        self.state = State::Partial;
        Ok(())
    }

    /// The content of a committed part, or none if there is no such part; [`RecordError::Damaged`] if it is cut, altered or
    /// not one of ours, [`RecordError::OtherProgram`] if another program or another plan left it.
    pub fn read_part(&self, name: &str) -> Result<Option<Vec<u8>>, RecordError> {
        let hint = "remove this file and give the same command again: only this part is computed anew";
        self.read_checksummed(self.part_path(name)?, hint)
    }

    /// Keeps what is needed to go on with the learners in training, in place of what was kept before.
    pub fn write_checkpoint(
        &mut self,
        content: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), RecordError> {
        checksummed::write(&*self.disk, &self.dir.join(CHECKPOINT), &self.maker, content)?;
        self.state = State::Partial;
        Ok(())
    }

    /// What was last kept of the learners in training, if anything; errors as of [`RunFolder::read_part`].
    pub fn read_checkpoint(&self) -> Result<Option<Vec<u8>>, RecordError> {
        self.read_checksummed(self.dir.join(CHECKPOINT), "the learners that it held are trained anew")
    }

    /// Removes the checkpoint: nobody is in training any more.
    pub fn remove_checkpoint(&self) {
        // Best effort: one that is left behind names learners that are finished, and is ignored.
        let _ = self.disk.remove_file(&self.dir.join(CHECKPOINT));
    }

    /// Gives a checkpoint that cannot be used another name, and hands that back: what is not understood is not deleted.
    pub fn set_checkpoint_aside(&self) -> Result<PathBuf, RecordError> {
        let path = self.dir.join(CHECKPOINT);
        let mut number = 1;
        loop {
            let aside = self.dir.join(format!("{CHECKPOINT}.unused-{number}"));
            if !exists(&*self.disk, &aside)? {
                self.disk.rename(&path, &aside).map_err(RecordError::not_committed(&path))?;
                return Ok(aside);
            }
            number += 1;
        }
    }

    fn read_checksummed(&self, path: PathBuf, hint: &'static str) -> Result<Option<Vec<u8>>, RecordError> {
        let Some(bytes) = read_if_there(&*self.disk, &path)? else { return Ok(None) };
        match checksummed::read(bytes, &self.maker) {
            Ok(content) => Ok(Some(content)),
            Err(Refusal::Damaged(problem)) => Err(RecordError::Damaged { path, problem: problem.into(), hint }),
            Err(Refusal::Other(found)) => Err(RecordError::OtherProgram { path, found, known: self.maker.clone() }),
        }
    }

    /// Begins to write the results, unless the run is complete.
    pub fn results(&self) -> Result<ResultsWriter<'_>, RecordError> {
        if self.state == State::Complete {
            return Err(RecordError::invalid(Manifest::NAME, "the run is already complete"));
        }
        ResultsWriter::new(&*self.disk, &self.dir, &self.given)
    }

    /// Writes the manifest, which makes the run complete, then removes the parts.
    pub fn complete(&self, results: ResultsWriter<'_>, provenance: Provenance) -> Result<Manifest, RecordError> {
        let manifest = results.manifest(provenance)?;
        self.remove_parts();
        Ok(manifest)
    }

    /// Writes all results and completes the run. The lock is given back.
    pub fn finish(
        self,
        files: impl IntoIterator<Item = (String, Vec<u8>)>,
        provenance: Provenance,
    ) -> Result<Manifest, RecordError> {
        let mut results = self.results()?;
        files.into_iter().try_for_each(|(name, bytes)| results.add(&name, &bytes))?;
        self.complete(results, provenance)
    }

    fn part_path(&self, name: &str) -> Result<PathBuf, RecordError> {
        if is_plain(name) && !name.contains('/') {
            Ok(self.dir.join(PARTS).join(name))
        } else {
            Err(RecordError::invalid(name, "not a name for a part"))
        }
    }

    /// Best effort: parts of a complete run are only wasted space, and the next opening tries again.
    fn remove_parts(&self) {
        for name in part_names(&*self.disk, &self.dir).unwrap_or_default() {
            let _ = self.disk.remove_file(&self.dir.join(PARTS).join(name));
        }
        let _ = self.disk.remove_folder(&self.dir.join(PARTS));
        self.remove_checkpoint();
    }
}

/// Takes the lock that keeps two processes from writing to one folder: [`RecordError::Busy`] if another holds it,
/// [`RecordError::Unwritable`] if it cannot be taken at all.
pub fn lock(disk: &dyn FileSystem, dir: &Path) -> Result<Lock, RecordError> {
    disk.lock(&dir.join(LOCK)).map_err(|error| match error {
        TryLockError::WouldBlock => RecordError::Busy { path: dir.into() },
        TryLockError::Error(source) => RecordError::Unwritable { path: dir.into(), source },
    })
}

/// The files that a run is made from: each is free and comes once, and one of them is the config's own world.
fn check_names(given: &[(&str, &str)]) -> Result<(), RecordError> {
    let names: BTreeSet<&str> = given.iter().map(|(name, _)| *name).collect();
    if let Some(name) = names.iter().find(|name| !is_free(name)) {
        return Err(RecordError::invalid(*name, "not a free path inside the run folder"));
    }
    if names.len() < given.len() || !names.contains(WORLD) {
        return Err(RecordError::invalid("world files", format!("one is `{WORLD}`, and each has a name of its own")));
    }
    Ok(())
}

fn exists(disk: &dyn FileSystem, path: &Path) -> Result<bool, RecordError> {
    Ok(disk.kind(path).map_err(RecordError::unreadable(path))?.is_some())
}

fn marker_text() -> String {
    format!("skilltree run folder, format {FORMAT}\n")
}

/// A folder is ours if it has the marker, which is the first file written after the lock.
fn refuse_foreign(disk: &dyn FileSystem, dir: &Path) -> Result<(), RecordError> {
    let marker = dir.join(MARKER);
    if let Some(bytes) = read_if_there(disk, &marker)? {
        let found = String::from_utf8_lossy(&bytes);
        return match found.strip_prefix("skilltree run folder, format ") {
            Some(_) if found == marker_text() => Ok(()),
            Some(version) => Err(RecordError::Format { path: marker, found: version.trim().into(), known: FORMAT }),
            None => Err(RecordError::damaged(&marker, "not the text that skilltree writes")),
        };
    }
    match list(disk, dir)?.into_iter().find(|name| name != LOCK && !writer::is_temporary(name)) {
        Some(found) => Err(RecordError::Foreign { path: dir.into(), found }),
        None => Ok(()),
    }
}
