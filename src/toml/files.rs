//! Where configs and floor plans are read from: the disk, or memory.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::io;
use std::path::{Component, Path, PathBuf};

/// A source of named texts.
pub trait Files: Debug {
    /// The whole text of a file.
    ///
    /// # Errors
    /// As the file system has them: there is no such file, it is a folder, it is not text.
    fn read(&self, path: &Path) -> io::Result<String>;

    /// A path that all names of one file have in common.
    fn identity(&self, path: &Path) -> PathBuf;
}

/// The files of this machine.
#[derive(Debug, Clone, Copy, Default)]
pub struct OsFiles;

impl Files for OsFiles {
    fn read(&self, path: &Path) -> io::Result<String> {
        std::fs::read_to_string(path)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
    }
}

/// Texts in memory, by path: a config, the one that it extends, its worlds.
///
/// ```
/// use skilltree::config::{MemoryFiles, Overrides, load_from};
///
/// let room = "size = [100, 100]\nrooms = [{ name = 'A', box = [0, 0, 100, 100] }]\n";
/// let files = MemoryFiles::from_iter([("room.toml", room), ("a.toml", "world = 'room.toml'\n")]);
/// let error = load_from(&files, "a.toml".as_ref(), &Overrides::default()).expect_err("a config without a skill");
/// assert!(error.to_string().contains("no skill"));
/// ```
#[derive(Debug, Clone, Default)]
pub struct MemoryFiles(BTreeMap<PathBuf, String>);

impl<P: AsRef<Path>, T: Into<String>> FromIterator<(P, T)> for MemoryFiles {
    fn from_iter<I: IntoIterator<Item = (P, T)>>(files: I) -> Self {
        Self(files.into_iter().map(|(path, text)| (plain(path.as_ref()), text.into())).collect())
    }
}

impl Files for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<String> {
        self.0.get(&plain(path)).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn identity(&self, path: &Path) -> PathBuf {
        plain(path)
    }
}

/// A path without detours.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if out.file_name().is_some() => drop(out.pop()),
            other => out.push(other),
        }
    }
    out
}
