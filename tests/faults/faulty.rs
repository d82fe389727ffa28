//! A disk of which one call fails.

use super::memory::Memory;
use skilltree::run_folder::file_system::{FileSystem, Kind, Lock, TryLockError, Writing};
use std::ffi::OsString;
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// How a call fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// No space is left.
    Full,
    /// The device errs.
    Device,
    /// The file system is read-only.
    ReadOnly,
    /// The permissions do not allow it.
    Denied,
    /// Half of the bytes are read or written, which is no error.
    Short,
    /// A signal came first, which is no error either: the call is to be repeated.
    Interrupted,
    /// Half of the bytes are written, and all are said to be.
    Torn,
}

impl Fault {
    /// Those that a call can do nothing about.
    pub(crate) const ERRORS: [Self; 4] = [Self::Full, Self::Device, Self::ReadOnly, Self::Denied];

    fn error(self) -> io::Error {
        match self {
            Self::Full => ErrorKind::StorageFull.into(),
            Self::ReadOnly => ErrorKind::ReadOnlyFilesystem.into(),
            Self::Denied => ErrorKind::PermissionDenied.into(),
            Self::Interrupted => ErrorKind::Interrupted.into(),
            Self::Device | Self::Short | Self::Torn => io::Error::other("input/output error"),
        }
    }
}

/// Calls in order: what was asked, and of which path.
type Log = Arc<Mutex<Vec<(&'static str, PathBuf)>>>;

/// Which calls fail, and how: the first one of a number, or all from it on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plan {
    pub(crate) call: usize,
    pub(crate) lasting: bool,
    pub(crate) fault: Fault,
}

/// The disk.
#[derive(Debug, Clone)]
pub(crate) struct Faulty {
    pub(crate) memory: Arc<Memory>,
    plan: Option<Plan>,
    log: Log,
}

impl Faulty {
    pub(crate) fn new(memory: Memory, plan: Option<Plan>) -> Self {
        Self { memory: Arc::new(memory), plan, log: Log::default() }
    }

    /// The calls so far.
    pub(crate) fn log(&self) -> Vec<(&'static str, PathBuf)> {
        self.log.lock().unwrap().clone()
    }

    /// The same files, on a disk that is whole again.
    pub(crate) fn repaired(&self) -> Arc<dyn FileSystem> {
        self.memory.clone()
    }

    /// Counts a call; the fault, if it is one that fails.
    fn strike(&self, what: &'static str, path: &Path) -> Option<Fault> {
        let mut log = self.log.lock().unwrap();
        log.push((what, path.to_owned()));
        let number = log.len() - 1;
        self.plan.filter(|plan| number == plan.call || plan.lasting && number > plan.call).map(|plan| plan.fault)
    }

    fn call(&self, what: &'static str, path: &Path) -> io::Result<()> {
        // What concerns bytes strikes no other call.
        match self.strike(what, path).filter(|fault| Fault::ERRORS.contains(fault)) {
            Some(fault) => Err(fault.error()),
            None => Ok(()),
        }
    }
}

struct Stream<T: ?Sized> {
    disk: Faulty,
    path: PathBuf,
    inner: Box<T>,
}

impl Read for Stream<dyn Read> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self.disk.strike("read", &self.path) {
            None | Some(Fault::Torn) => self.inner.read(buffer),
            Some(Fault::Short) => {
                let half = buffer.len().div_ceil(2);
                self.inner.read(&mut buffer[..half])
            }
            Some(fault) => Err(fault.error()),
        }
    }
}

impl Write for Stream<dyn Writing> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let half = bytes.len().div_ceil(2);
        match self.disk.strike("write", &self.path) {
            None => self.inner.write(bytes),
            Some(Fault::Short) => self.inner.write(&bytes[..half]),
            Some(Fault::Torn) => self.inner.write_all(&bytes[..half]).map(|()| bytes.len()),
            Some(fault @ Fault::Full) => {
                // A disk that fills up takes what still fits.
                self.inner.write_all(&bytes[..half])?;
                Err(fault.error())
            }
            Some(fault) => Err(fault.error()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl Writing for Stream<dyn Writing> {
    fn sync(&mut self) -> io::Result<()> {
        self.disk.call("sync", &self.path)?;
        self.inner.sync()
    }
}

impl FileSystem for Faulty {
    fn make_folder(&self, path: &Path) -> io::Result<()> {
        self.call("make folder", path)?;
        self.memory.make_folder(path)
    }

    fn create(&self, path: &Path) -> io::Result<Box<dyn Writing>> {
        self.call("create", path)?;
        let inner = self.memory.create(path)?;
        Ok(Box::new(Stream::<dyn Writing> { disk: self.clone(), path: path.to_owned(), inner }))
    }

    fn open(&self, path: &Path) -> io::Result<Box<dyn Read>> {
        self.call("open", path)?;
        let inner = self.memory.open(path)?;
        Ok(Box::new(Stream::<dyn Read> { disk: self.clone(), path: path.to_owned(), inner }))
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.call("rename", to)?;
        self.memory.rename(from, to)
    }

    fn sync_folder(&self, path: &Path) -> io::Result<()> {
        self.call("sync folder", path)?;
        self.memory.sync_folder(path)
    }

    fn remove_file(&self, path: &Path) -> io::Result<()> {
        self.call("remove file", path)?;
        self.memory.remove_file(path)
    }

    fn remove_folder(&self, path: &Path) -> io::Result<()> {
        self.call("remove folder", path)?;
        self.memory.remove_folder(path)
    }

    fn list(&self, path: &Path) -> io::Result<Vec<OsString>> {
        self.call("list", path)?;
        self.memory.list(path)
    }

    fn kind(&self, path: &Path) -> io::Result<Option<Kind>> {
        self.call("kind", path)?;
        self.memory.kind(path)
    }

    fn lock(&self, path: &Path) -> Result<Lock, TryLockError> {
        self.call("lock", path).map_err(TryLockError::Error)?;
        self.memory.lock(path)
    }
}
