//! The run folder while a run writes to it.

use super::atomic::read_if_there;
use super::disk::{Disk, FileSystem, Lock, TryLockError};
use super::manifest::{FileDigest, is_plain};
use super::{FORMAT, Manifest, Provenance, RecordError, atomic};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Name of the resolved config in a run folder.
pub const CONFIG: &str = "config.toml";
/// Name of the config's own floor plan in a run folder.
pub const WORLD: &str = "world.toml";
const LOCK: &str = ".lock";
const MARKER: &str = ".skilltree";
const PARTS: &str = "parts";
/// Starts every part: eight bytes, then the content's length (u64, little-endian), its SHA-256, and the content.
const PART_MAGIC: &[u8; 8] = b"SKLPART1";
const PART_HEADER: usize = 8 + 8 + 32;

/// How far a run folder has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Nothing computed yet.
    Fresh,
    /// Some parts are committed: the run can be resumed.
    Partial,
    /// The manifest is there: nothing is left to do.
    Complete,
}

/// A run folder, locked against other writers until it is dropped or finished.
#[derive(Debug)]
pub struct RunFolder {
    disk: Arc<dyn Disk>,
    dir: PathBuf,
    /// Names of the config and of the world files.
    given: Vec<String>,
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
        Self::open_on(Arc::new(FileSystem), dir, config_text, worlds)
    }

    /// As [`RunFolder::open`], on a disk of the caller's; all that is done with the folder goes through it.
    ///
    /// # Errors
    /// As [`RunFolder::open`].
    pub fn open_on(
        disk: Arc<dyn Disk>,
        dir: &Path,
        config_text: &str,
        worlds: &[(&str, &str)],
    ) -> Result<Self, RecordError> {
        let on = &*disk;
        let given: Vec<(&str, &str)> = [(CONFIG, config_text)].iter().chain(worlds).copied().collect();
        check_names(&given)?;
        make_run_folder(on, dir)?;
        refuse_foreign(on, dir)?;
        let lock = lock(on, dir)?;
        // Once more under the lock: another process may have filled the folder in between.
        refuse_foreign(on, dir)?;
        let folders: BTreeSet<PathBuf> =
            given.iter().filter_map(|(name, _)| Some(dir.join(name).parent()?.into())).collect();
        for folder in folders.iter().chain([&dir.join(PARTS)]) {
            atomic::remove_leftovers(on, folder)?;
        }
        let complete = exists(on, &dir.join(Manifest::NAME))?;
        let started = complete || !part_names(on, dir)?.is_empty();
        atomic_once(on, &dir.join(MARKER), format!("skilltree run folder, format {FORMAT}\n").as_bytes())?;
        for (name, text) in &given {
            let path = dir.join(name);
            match read_if_there(on, &path)? {
                Some(bytes) if bytes == text.as_bytes() => {}
                Some(_) => return Err(RecordError::OtherExperiment { path: dir.into(), file: (*name).to_owned() }),
                None if started => return Err(RecordError::damaged(&path, "missing, although results exist")),
                None => write_below(on, &path, text.as_bytes())?,
            }
        }
        let given = given.iter().map(|(name, _)| (*name).to_owned()).collect();
        let mut folder = Self { disk, dir: dir.into(), given, state: State::Fresh, _lock: lock };
        if complete {
            super::FinishedRun::read_on(Arc::clone(&folder.disk), dir)?;
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
    ///
    /// # Errors
    /// [`RecordError::Unreadable`] if the folder cannot be listed.
    pub fn parts(&self) -> Result<Vec<String>, RecordError> {
        part_names(&*self.disk, &self.dir)
    }

    /// Commits one cohort's results under a name of letters, digits, `.`, `-`, `_`. Replaces a part of that name whole.
    ///
    /// # Errors
    /// [`RecordError::Invalid`] for another name or a complete run; otherwise as [`atomic::write()`].
    pub fn commit_part(&mut self, name: &str, content: &[u8]) -> Result<(), RecordError> {
        let path = self.part_path(name)?;
        if self.state == State::Complete {
            return Err(RecordError::invalid(name, "the run is complete and takes no more parts"));
        }
        let parts = self.dir.join(PARTS);
        atomic::make_folder(&*self.disk, &parts)?;
        let mut bytes = Vec::with_capacity(PART_HEADER + content.len());
        bytes.extend_from_slice(PART_MAGIC);
        bytes.extend_from_slice(&(content.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&Sha256::digest(content));
        bytes.extend_from_slice(content);
        atomic::write(&*self.disk, &path, &bytes)?;
        self.state = State::Partial;
        Ok(())
    }

    /// The content of a committed part, or none if there is no such part.
    ///
    /// # Errors
    /// [`RecordError::Damaged`] if the part is cut, altered or not one of ours.
    pub fn read_part(&self, name: &str) -> Result<Option<Vec<u8>>, RecordError> {
        let path = self.part_path(name)?;
        let Some(mut bytes) = read_if_there(&*self.disk, &path)? else { return Ok(None) };
        match part_problem(&bytes) {
            Some(problem) => Err(RecordError::Damaged {
                path,
                problem: problem.into(),
                hint: "remove this file and give the same command again: only this part is computed anew",
            }),
            None => Ok(Some(bytes.split_off(PART_HEADER))),
        }
    }

    /// Writes the results, each whole, then the manifest that makes the run complete, then removes the parts. The files
    /// may come from a lazy iterator, so that they need not be in memory together. The lock is given back.
    ///
    /// # Errors
    /// [`RecordError::Invalid`] for a path that leaves the folder, is taken or comes twice, or if the run is complete;
    /// otherwise as [`atomic::write()`]. After an error the parts are still there, so that the run can be resumed.
    pub fn finish<Files>(self, files: Files, provenance: Provenance) -> Result<Manifest, RecordError>
    where
        Files: IntoIterator<Item = (String, Vec<u8>)>,
    {
        if self.state == State::Complete {
            return Err(RecordError::invalid(Manifest::NAME, "the run is already complete"));
        }
        let disk = &*self.disk;
        let mut digests = BTreeMap::new();
        for name in &self.given {
            let path = self.dir.join(name);
            let digest = FileDigest::of_file(disk, &path).map_err(RecordError::unreadable(&path))?;
            digests.insert(name.clone(), digest);
        }
        let mut folders = BTreeSet::from([self.dir.clone()]);
        for (name, bytes) in files {
            if !is_free(&name) || digests.contains_key(&name) {
                return Err(RecordError::invalid(name, "not a free path inside the run folder"));
            }
            let path = self.dir.join(&name);
            if let Some(folder) = path.parent().filter(|folder| !folders.contains(*folder)) {
                atomic::make_folder(disk, folder)?;
                atomic::remove_leftovers(disk, folder)?;
                folders.insert(folder.into());
            }
            atomic::place(disk, &path, &bytes)?;
            digests.insert(name, FileDigest::of(&bytes));
        }
        for folder in folders.iter().rev() {
            atomic::sync_folder(disk, folder)?;
        }
        let manifest = Manifest { format: FORMAT, provenance, files: digests };
        atomic::write(disk, &self.dir.join(Manifest::NAME), &manifest.to_bytes()?)?;
        self.remove_parts();
        Ok(manifest)
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
    }
}

/// Takes the lock that keeps two processes from writing to one folder, as [`Disk::lock`].
///
/// # Errors
/// [`RecordError::Busy`] if another holds it, [`RecordError::Unwritable`] if it cannot be taken at all.
pub fn lock(disk: &dyn Disk, dir: &Path) -> Result<Lock, RecordError> {
    disk.lock(&dir.join(LOCK)).map_err(|error| match error {
        TryLockError::WouldBlock => RecordError::Busy { path: dir.into() },
        TryLockError::Error(source) => RecordError::Unwritable { path: dir.into(), source },
    })
}

/// Whether a file may have this path: one inside the folder that is not kept for ourselves.
fn is_free(name: &str) -> bool {
    is_plain(name) && name != Manifest::NAME && name.split('/').next() != Some(PARTS)
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

/// Makes the folder itself; what keeps it from being made, such as a file in its place, is a matter of `--out`.
fn make_run_folder(disk: &dyn Disk, dir: &Path) -> Result<(), RecordError> {
    atomic::make_folder(disk, dir).map_err(|error| match error {
        RecordError::NotCommitted { path, source } => RecordError::Unwritable { path, source },
        other => other,
    })
}

/// Writes a file, and the folder that holds it if there is none.
fn write_below(disk: &dyn Disk, path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    if let Some(folder) = path.parent() {
        atomic::make_folder(disk, folder)?;
    }
    atomic::write(disk, path, bytes)
}

fn exists(disk: &dyn Disk, path: &Path) -> Result<bool, RecordError> {
    Ok(disk.kind(path).map_err(RecordError::unreadable(path))?.is_some())
}

/// A folder is ours if it has the marker, which is the first file written after the lock.
fn refuse_foreign(disk: &dyn Disk, dir: &Path) -> Result<(), RecordError> {
    let marker = dir.join(MARKER);
    let expected = format!("skilltree run folder, format {FORMAT}\n");
    if let Some(bytes) = read_if_there(disk, &marker)? {
        let found = String::from_utf8_lossy(&bytes);
        return match found.strip_prefix("skilltree run folder, format ") {
            Some(_) if found == expected => Ok(()),
            Some(version) => Err(RecordError::Format { path: marker, found: version.trim().into(), known: FORMAT }),
            None => Err(RecordError::damaged(&marker, "not the text that skilltree writes")),
        };
    }
    match atomic::list(disk, dir)?.into_iter().find(|name| name != LOCK && !atomic::is_temporary(name)) {
        Some(found) => Err(RecordError::Foreign { path: dir.into(), found }),
        None => Ok(()),
    }
}

fn atomic_once(disk: &dyn Disk, path: &Path, bytes: &[u8]) -> Result<(), RecordError> {
    if exists(disk, path)? { Ok(()) } else { atomic::write(disk, path, bytes) }
}

fn part_names(disk: &dyn Disk, dir: &Path) -> Result<Vec<String>, RecordError> {
    Ok(atomic::list(disk, &dir.join(PARTS))?.into_iter().filter(|name| is_plain(name)).collect())
}

fn part_problem(bytes: &[u8]) -> Option<&'static str> {
    let Some((header, content)) = bytes.split_at_checked(PART_HEADER) else { return Some("cut within its header") };
    if &header[..8] != PART_MAGIC {
        return Some("not a part of a skilltree run");
    }
    if header[8..16] != (content.len() as u64).to_le_bytes() {
        return Some("its length is not the one that was written");
    }
    (header[16..] != Sha256::digest(content)[..]).then_some("its content is not what was written")
}
