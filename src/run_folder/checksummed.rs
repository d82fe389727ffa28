//! Files that a run keeps for itself until it is complete, parts and the checkpoint, with their length and checksum.
//!
//! Eight bytes, the length of the maker's text (u32, little-endian) and the text, the content; then the number of all
//! bytes so far (u64) and their SHA-256. The maker is the program and the plan: results of two programs never mix.

use super::file_system::FileSystem;
use super::manifest::hexadecimal;
use super::writer::{FileWriter, sync_folder};
use super::{FORMAT, RecordError};
use sha2::{Digest, Sha256};
use std::io::{self, Write};
use std::path::Path;

const MAGIC: &[u8; 8] = b"SKLPART3";
const HEAD: usize = 8 + 4;
const TRAILER: usize = 8 + 32;

/// Why a file is not accepted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Refusal {
    /// Cut, altered, or never one of ours.
    Damaged(&'static str),
    /// Whole, but of another program or plan: its text.
    Other(String),
}

/// Names this program and the plan with these files: what is kept under one name is never read under another.
pub(super) fn maker(given: &[(&str, &str)]) -> String {
    let mut hasher = Sha256::new();
    for (name, text) in given {
        for part in [name, text] {
            hasher.update((part.len() as u64).to_le_bytes());
            hasher.update(part);
        }
    }
    let plan = hexadecimal(&hasher.finalize()[..8]);
    let commit = option_env!("SKILLTREE_COMMIT").map_or_else(String::new, |commit| format!(", commit {commit:.12}"));
    format!("skilltree {}{commit}, format {FORMAT}, plan {plan}", env!("CARGO_PKG_VERSION"))
}

/// Writes a file whole and asks the disk to keep it.
pub(super) fn write(
    disk: &dyn FileSystem,
    path: &Path,
    maker: &str,
    content: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
) -> Result<(), RecordError> {
    let mut file = FileWriter::create(disk, path)?;
    let mut fill = || {
        file.write_all(MAGIC)?;
        file.write_all(&(maker.len() as u32).to_le_bytes())?;
        file.write_all(maker.as_bytes())?;
        content(&mut file)?;
        let (bytes, hash) = file.so_far();
        file.write_all(&bytes.to_le_bytes())?;
        file.write_all(&hash)
    };
    fill().map_err(RecordError::not_committed(path))?;
    file.place()?;
    sync_folder(disk, path.parent().unwrap_or(Path::new(".")))
}

/// The content of a file of this maker's, from its bytes.
pub(super) fn read(mut bytes: Vec<u8>, maker: &str) -> Result<Vec<u8>, Refusal> {
    let damaged = |problem| Err(Refusal::Damaged(problem));
    let Some(end) = bytes.len().checked_sub(TRAILER).filter(|end| *end >= HEAD) else {
        return damaged("cut within its frame");
    };
    let (framed, trailer) = bytes.split_at(end);
    if &framed[..8] != MAGIC {
        return damaged("not a file of a skilltree run");
    }
    if trailer[..8] != (end as u64).to_le_bytes() {
        return damaged("its length is not the one that was written");
    }
    if trailer[8..] != Sha256::digest(framed)[..] {
        return damaged("its content is not what was written");
    }
    let length = u32::from_le_bytes([framed[8], framed[9], framed[10], framed[11]]) as usize;
    match framed[HEAD..].get(..length) {
        None => return damaged("its frame is not one that was written"),
        Some(found) if found != maker.as_bytes() => {
            return Err(Refusal::Other(String::from_utf8_lossy(found).into_owned()));
        }
        Some(_) => {}
    }
    bytes.truncate(end);
    bytes.drain(..HEAD + length);
    Ok(bytes)
}
