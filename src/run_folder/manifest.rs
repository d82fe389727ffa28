//! `manifest.json`: what made a run folder, and the length and hash of every file in it.

use super::file_system::FileSystem;
use super::paths::is_plain;
use super::{FORMAT, RecordError, json};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// Who made the results, where and when.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Version of skilltree.
    pub version: String,
    /// Git commit of skilltree, if known.
    pub commit: Option<String>,
    /// `cpu` or `gpu`.
    pub backend: String,
    /// The GPU's name, if one was used.
    pub adapter: Option<String>,
    /// Seeds that were run, ascending.
    pub seeds: Vec<u32>,
    /// When the run began, RFC 3339 in UTC. Differs from run to run, as `finished` does; result files hold no time.
    pub started: Option<String>,
    /// When the run ended, RFC 3339 in UTC.
    pub finished: Option<String>,
    /// Anything else worth keeping (threads, wall time), shown in the report as it stands.
    #[serde(default)]
    pub notes: BTreeMap<String, String>,
}

/// Length and hash of one result file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileDigest {
    /// Length in bytes.
    pub bytes: u64,
    /// SHA-256 in lower-case hexadecimal.
    pub sha256: String,
}

/// The content of `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Layout of the folder: [`FORMAT`].
    pub format: u32,
    /// What made the results.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Every result file by its path in the folder, with `/` between parts.
    pub files: BTreeMap<String, FileDigest>,
}

impl Manifest {
    /// The file's name.
    pub const NAME: &'static str = super::paths::MANIFEST;

    /// JSON text, ending with a line feed.
    pub fn to_bytes(&self) -> Result<Vec<u8>, RecordError> {
        json::write(Self::NAME, self, true)
    }

    /// Reads a manifest: [`RecordError::Format`] for another layout, [`RecordError::Damaged`] for anything that is not a
    /// manifest. `path` is only for messages.
    pub fn parse(bytes: &[u8], path: &Path) -> Result<Self, RecordError> {
        // The format comes first: another version may well have other keys.
        #[derive(Deserialize)]
        struct Version {
            format: serde_json::Value,
        }
        let version: Version = json::read(bytes, path)?;
        if version.format != serde_json::json!(FORMAT) {
            let found = version.format.to_string();
            return Err(RecordError::Format { path: path.into(), found, known: FORMAT });
        }
        let manifest: Self = json::read(bytes, path)?;
        match manifest.files.keys().find(|name| !is_plain(name)) {
            Some(name) => Err(RecordError::damaged(path, format!("lists `{name}`, which lies outside the folder"))),
            None => Ok(manifest),
        }
    }
}

impl FileDigest {
    /// Digest of bytes in memory.
    pub fn of(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, sha256: hexadecimal(&Sha256::digest(bytes)) }
    }

    /// Digest of a file, without holding it in memory.
    pub fn of_file(disk: &dyn FileSystem, path: &Path) -> io::Result<Self> {
        let (mut file, mut hasher) = (disk.open(path)?, Sha256::new());
        let (mut buffer, mut bytes) = (vec![0; 1 << 16], 0);
        loop {
            let read = match file.read(&mut buffer) {
                Ok(0) => return Ok(Self { bytes, sha256: hexadecimal(&hasher.finalize()) }),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                other => other?,
            };
            hasher.update(&buffer[..read]);
            bytes += read as u64;
        }
    }
}

/// Bytes as lower-case hexadecimal digits.
pub(super) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
