//! All that a run folder asks of a file system, call by call, so that a test can make each call fail.
//!
//! A method is one request to the operating system, or a few that fail as one. Nothing here knows what a run folder is.

use std::any::Any;
use std::ffi::OsString;
use std::fmt::Debug;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

pub use std::fs::TryLockError;

/// What stands at a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A folder.
    Folder,
    /// Anything else.
    File,
}

/// A lock that is held until it is dropped.
pub type Lock = Box<dyn Any + Send + Sync>;

/// A file that is being written.
pub trait Writing: Write + Send {
    /// Returns once the content would survive a power cut. After an error it is unknown what the file holds: a second call
    /// proves nothing.
    fn sync(&mut self) -> io::Result<()>;
}

/// A file system. Errors are the operating system's own; who calls adds the path and what to do.
pub trait FileSystem: Debug + Send + Sync {
    /// Makes a folder and those above it; none of them need be new.
    fn make_folder(&self, path: &Path) -> io::Result<()>;

    /// Opens an empty file for writing, over one that is there.
    fn create(&self, path: &Path) -> io::Result<Box<dyn Writing>>;

    /// Opens a file for reading.
    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>>;

    /// The whole content of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.open(path)?.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Puts a file at another path of the same folder, over one that is there, in one step; on an error both paths are as
    /// before.
    fn rename(&self, from: &Path, to: &Path) -> io::Result<()>;

    /// Returns once the entries of a folder would survive a power cut.
    fn sync_folder(&self, path: &Path) -> io::Result<()>;

    /// Removes a file.
    fn remove_file(&self, path: &Path) -> io::Result<()>;

    /// Removes an empty folder.
    fn remove_folder(&self, path: &Path) -> io::Result<()>;

    /// Names in a folder, in any order.
    fn list(&self, path: &Path) -> io::Result<Vec<OsString>>;

    /// What stands at a path, or none if nothing does. That it cannot be told is an error: it is not the same as nothing.
    fn kind(&self, path: &Path) -> io::Result<Option<Kind>>;

    /// Takes the lock on a file, which is made if there is none; [`TryLockError::WouldBlock`] if another holds it. The
    /// operating system takes it back when the process ends in any way.
    fn lock(&self, path: &Path) -> Result<Lock, TryLockError>;
}

/// The file systems that the operating system offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OsFileSystem;

impl Writing for File {
    fn sync(&mut self) -> io::Result<()> {
        self.sync_all()
    }
}

impl FileSystem for OsFileSystem {
    fn make_folder(&self, path: &Path) -> io::Result<()> {
        fs::create_dir_all(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Writing>> {
        Ok(Box::new(File::create(path)?))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        Ok(Box::new(File::open(path)?))
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        // Only Unix lets a folder be opened and flushed; elsewhere the rename itself is all there is.
        if cfg!(unix) { File::open(path)?.sync_all() } else { Ok(()) }
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        fs::remove_file(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        fs::remove_dir(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        fs::read_dir(path)?.map(|entry| Ok(entry?.file_name())).collect()
    }

    fn kind(&self, path: &Path) -> io::Result<Option<Kind>> {
        match fs::metadata(path) {
            Ok(data) if data.is_dir() => Ok(Some(Kind::Folder)),
            Ok(_) => Ok(Some(Kind::File)),
            // Below a file there is nothing either.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => Ok(None),
            Err(error) => Err(error),
        }
    }

    fn lock(&self, path: &Path) -> Result<Lock, TryLockError> {
        let file = File::options().create(true).append(true).open(path).map_err(TryLockError::Error)?;
        file.try_lock()?;
        Ok(Box::new(file))
    }
}
