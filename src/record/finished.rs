//! A complete run folder, verified and read only.

use super::folder::{CONFIG, WORLD};
use super::manifest::FileDigest;
use super::{Manifest, RecordError};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A run folder whose every file has the length and hash that its manifest states.
#[derive(Debug, Clone)]
pub struct FinishedRun {
    dir: PathBuf,
    manifest: Manifest,
    config: String,
    world: String,
}

impl FinishedRun {
    /// Opens and verifies a run folder.
    ///
    /// # Errors
    /// [`RecordError::NoRun`] or [`RecordError::Unfinished`] without a manifest, [`RecordError::Format`] for another layout, otherwise
    /// [`RecordError::Damaged`] or [`RecordError::Unreadable`] with the file that is missing, cut or altered.
    pub fn read(dir: &Path) -> Result<Self, RecordError> {
        let path = dir.join(Manifest::NAME);
        let bytes = match fs::read(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && dir.join(CONFIG).exists() => {
                return Err(RecordError::Unfinished { path: dir.into() });
            }
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
                return Err(RecordError::NoRun { path: dir.into(), found: what_is(dir)? });
            }
            other => other.map_err(RecordError::unreadable(&path))?,
        };
        let manifest = Manifest::parse(&bytes, &path)?;
        for (name, stated) in &manifest.files {
            verify(&dir.join(name), stated)?;
        }
        let mut run = Self { dir: dir.into(), manifest, config: String::new(), world: String::new() };
        run.config = run.text(CONFIG)?;
        run.world = run.text(WORLD)?;
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

    /// Path of a result file, or none if the run has no such file.
    pub fn path(&self, name: &str) -> Option<PathBuf> {
        self.manifest.files.contains_key(name).then(|| self.dir.join(name))
    }

    fn text(&self, name: &str) -> Result<String, RecordError> {
        let path = self.dir.join(name);
        if !self.manifest.files.contains_key(name) {
            return Err(RecordError::damaged(&self.dir.join(Manifest::NAME), format!("does not list `{name}`")));
        }
        let bytes = fs::read(&path).map_err(RecordError::unreadable(&path))?;
        String::from_utf8(bytes).map_err(|_| RecordError::damaged(&path, "not UTF-8"))
    }
}

/// What is where a run folder was expected, in brackets.
fn what_is(path: &Path) -> Result<String, RecordError> {
    Ok(match fs::metadata(path) {
        Err(_) => " (there is no such folder)".to_owned(),
        Ok(data) if !data.is_dir() => " (it is a file)".to_owned(),
        Ok(_) => match super::atomic::list(path)?.first() {
            Some(name) => format!(" (it holds `{name}`, and no manifest.json)"),
            None => " (it is empty)".to_owned(),
        },
    })
}

fn verify(path: &Path, stated: &FileDigest) -> Result<(), RecordError> {
    let found = match FileDigest::of_file(path) {
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
