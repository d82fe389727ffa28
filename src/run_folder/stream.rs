//! A file that is written piece by piece and appears whole or not at all.

use super::file_system::{Disk, Writing};
use super::manifest::{FileDigest, hexadecimal};
use super::{RecordError, atomic};
use sha2::{Digest, Sha256};
use std::fmt;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes that gather before they are written.
const BUFFER: usize = 1 << 18;

/// A file in the making. Dropped without [`Stream::place`], it leaves nothing.
pub struct Stream {
    disk: Arc<dyn Disk>,
    path: PathBuf,
    temporary: PathBuf,
    file: BufWriter<Box<dyn Writing>>,
    hasher: Sha256,
    bytes: u64,
    placed: bool,
}

impl fmt::Debug for Stream {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stream").field("path", &self.path).field("bytes", &self.bytes).finish_non_exhaustive()
    }
}

impl Stream {
    /// Begins the file that will stand at `path`.
    ///
    /// # Errors
    /// [`RecordError::NotCommitted`].
    pub fn create(disk: &Arc<dyn Disk>, path: &Path) -> Result<Self, RecordError> {
        let temporary = atomic::temporary_name(path);
        let file = disk.create(&temporary).map_err(RecordError::not_committed(path))?;
        let file = BufWriter::with_capacity(BUFFER, file);
        Ok(Self {
            disk: Arc::clone(disk),
            path: path.into(),
            temporary,
            file,
            hasher: Sha256::new(),
            bytes: 0,
            placed: false,
        })
    }

    /// Where the file will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Number of the bytes written so far, and their SHA-256.
    pub(super) fn so_far(&self) -> (u64, [u8; 32]) {
        (self.bytes, self.hasher.clone().finalize().into())
    }

    /// Puts the file in its place: fsync, read back, rename. The folder's entry still needs [`atomic::sync_folder`].
    ///
    /// # Errors
    /// [`RecordError::NotCommitted`]: the earlier state is intact.
    pub fn place(mut self) -> Result<FileDigest, RecordError> {
        let (bytes, hash) = self.so_far();
        let digest = FileDigest { bytes, sha256: hexadecimal(&hash) };
        self.put(&digest).map_err(RecordError::not_committed(&self.path))?;
        Ok(digest)
    }

    fn put(&mut self, digest: &FileDigest) -> io::Result<()> {
        self.file.flush()?;
        self.file.get_mut().sync()?;
        if FileDigest::of_file(&*self.disk, &self.temporary)? != *digest {
            return Err(io::Error::other("the file reads back differently"));
        }
        self.disk.rename(&self.temporary, &self.path)?;
        self.placed = true;
        Ok(())
    }
}

impl Write for Stream {
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

impl Drop for Stream {
    fn drop(&mut self) {
        if !self.placed {
            // Best effort: a leftover is ignored by readers and removed by the next run.
            let _ = self.disk.remove_file(&self.temporary);
        }
    }
}
