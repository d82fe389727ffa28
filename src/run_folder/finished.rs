//! A complete run folder, verified and read only.

use super::file_system::{FileSystem, Kind, OsFileSystem};
use super::manifest::FileDigest;
use super::paths::{CONFIG, WORLD, list, tally};
use super::tables::{EVALUATIONS, TRIALS, parse_evaluations, parse_trials};
use super::{EvaluationRow, JsonFile, Manifest, Names, RecordError, TrialRow};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A run folder whose every file has the length and hash that its manifest states.
#[derive(Debug, Clone)]
pub struct FinishedRun {
    disk: Arc<dyn FileSystem>,
    dir: PathBuf,
    manifest: Manifest,
    config: String,
    world: String,
}

impl FinishedRun {
    /// Opens and verifies a run folder.
    ///
    /// # Errors
    /// [`RecordError::NoRun`] or [`RecordError::Unfinished`] without a manifest, [`RecordError::Format`] for another layout,
    /// otherwise [`RecordError::Damaged`] or [`RecordError::Unreadable`] with the file that is missing, cut or altered.
    pub fn read(dir: &Path) -> Result<Self, RecordError> {
        Self::read_on(Arc::new(OsFileSystem), dir)
    }

    /// As [`FinishedRun::read`], on a file system of the caller's.
    pub fn read_on(disk: Arc<dyn FileSystem>, dir: &Path) -> Result<Self, RecordError> {
        let path = dir.join(Manifest::NAME);
        let bytes = match disk.read(&path) {
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Err(without_manifest(&*disk, dir)?);
            }
            other => other.map_err(RecordError::unreadable(&path))?,
        };
        let manifest = Manifest::parse(&bytes, &path)?;
        for (name, stated) in &manifest.files {
            verify(&dir.join(name), stated, |path| FileDigest::of_file(&*disk, path))?;
        }
        let mut run = Self { disk, dir: dir.into(), manifest, config: String::new(), world: String::new() };
        run.config = run.required(CONFIG)?;
        run.world = run.required(WORLD)?;
        Ok(run)
    }

    /// Where the folder lies.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The manifest.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The resolved config.
    pub fn config(&self) -> &str {
        &self.config
    }

    /// The floor plan's text.
    pub fn world(&self) -> &str {
        &self.world
    }

    /// Content of a result file, or none if the run has no such file. What comes out has the hash that the manifest
    /// states, whatever became of the file since the folder was opened.
    pub fn content(&self, name: &str) -> Result<Option<Vec<u8>>, RecordError> {
        let Some(stated) = self.manifest.files.get(name) else { return Ok(None) };
        let mut bytes = Vec::new();
        verify(&self.dir.join(name), stated, |path| {
            bytes = self.disk.read(path)?;
            Ok(FileDigest::of(&bytes))
        })?;
        Ok(Some(bytes))
    }

    /// A JSON file, or none if the run has none.
    pub fn json<T: JsonFile>(&self) -> Result<Option<T>, RecordError> {
        self.content(T::NAME)?.map(|bytes| T::parse(&bytes, &self.dir.join(T::NAME))).transpose()
    }

    /// All tests of all skills, and the names that their numbers stand for; nothing where the run has no table of them.
    pub fn evaluations(&self) -> Result<(Names, Vec<EvaluationRow>), RecordError> {
        let parse = |bytes| parse_evaluations(bytes, &self.dir.join(EVALUATIONS));
        self.content(EVALUATIONS)?.map_or_else(|| Ok(Default::default()), parse)
    }

    /// All training trials, and the names that their numbers stand for; nothing where the run has no table of them.
    pub fn trials(&self) -> Result<(Names, Vec<TrialRow>), RecordError> {
        let parse = |bytes| parse_trials(bytes, &self.dir.join(TRIALS));
        self.content(TRIALS)?.map_or_else(|| Ok(Default::default()), parse)
    }

    /// As [`FinishedRun::content`], for a file of text.
    pub fn text(&self, name: &str) -> Result<Option<String>, RecordError> {
        let damaged = |_| RecordError::damaged(&self.dir.join(name), "not UTF-8");
        self.content(name)?.map(|bytes| String::from_utf8(bytes).map_err(damaged)).transpose()
    }

    fn required(&self, name: &str) -> Result<String, RecordError> {
        let unlisted = || RecordError::damaged(&self.dir.join(Manifest::NAME), format!("does not list `{name}`"));
        self.text(name)?.ok_or_else(unlisted)
    }
}

/// What to say of a folder without a manifest.
fn without_manifest(disk: &dyn FileSystem, dir: &Path) -> Result<RecordError, RecordError> {
    let config = dir.join(CONFIG);
    if disk.kind(&config).map_err(RecordError::unreadable(&config))?.is_some() {
        let (finished, of) = tally(disk, dir)?;
        return Ok(RecordError::Unfinished { path: dir.into(), finished, of });
    }
    let found = match disk.kind(dir).map_err(RecordError::unreadable(dir))? {
        None => " (there is no such folder)".to_owned(),
        Some(Kind::File) => " (it is a file)".to_owned(),
        Some(Kind::Folder) => match list(disk, dir)?.first() {
            Some(name) => format!(" (it holds `{name}`, and no manifest.json)"),
            None => " (it is empty)".to_owned(),
        },
    };
    Ok(RecordError::NoRun { path: dir.into(), found })
}

/// Compares a file, digested by `digest`, with what the manifest states.
fn verify(
    path: &Path,
    stated: &FileDigest,
    digest: impl FnOnce(&Path) -> io::Result<FileDigest>,
) -> Result<(), RecordError> {
    let found = match digest(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(RecordError::damaged(path, "missing, although the manifest lists it"));
        }
        other => other.map_err(RecordError::unreadable(path))?,
    };
    if found.bytes != stated.bytes {
        let problem = format!("{} bytes long where the manifest states {}", found.bytes, stated.bytes);
        return Err(RecordError::damaged(path, problem));
    }
    if found.sha256 != stated.sha256 {
        return Err(RecordError::damaged(path, "its SHA-256 is not the one in the manifest"));
    }
    Ok(())
}
