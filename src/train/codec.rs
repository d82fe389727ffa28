//! The bytes of what a run keeps for itself, parts and checkpoints: postcard, compressed by Snappy.
//!
//! Numbers in long rows are bytes as they lie in memory, little-endian on every machine that we run on. Most lessons end
//! long before the step limit: Snappy makes little of the zeros behind them.

use serde::Serialize;
use serde::de::DeserializeOwned;
use snap::{read::FrameDecoder, write::FrameEncoder};
use std::io::{self, Read, Write};

/// What a run keeps for itself does not hold what it should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("it does not hold whole results of this experiment")]
pub struct PartError;

/// Writes a value.
pub fn write(value: &(impl Serialize + ?Sized), out: &mut dyn Write) -> io::Result<()> {
    let mut out = Remembering { inner: FrameEncoder::new(out), error: None };
    match postcard::to_io(value, &mut out) {
        Ok(_) => out.inner.flush(),
        Err(error) => Err(out.error.take().unwrap_or_else(|| io::Error::other(error))),
    }
}

/// The bytes of a value.
pub fn encode(value: &(impl Serialize + ?Sized)) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write(value, &mut bytes)?;
    Ok(bytes)
}

/// Reads a value back; an error where the bytes end early, go on, or are not those of such a value.
pub fn read<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, PartError> {
    let mut plain = Vec::new();
    FrameDecoder::new(bytes).read_to_end(&mut plain).map_err(|_| PartError)?;
    match postcard::take_from_bytes(&plain) {
        Ok((value, [])) => Ok(value),
        _ => Err(PartError),
    }
}

/// Keeps the error of a writer, of which postcard tells nothing.
struct Remembering<W> {
    inner: W,
    error: Option<io::Error>,
}

impl<W: Write> Write for Remembering<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.inner.write(bytes).inspect_err(|error| {
            // An interrupted call is repeated.
            if error.kind() != io::ErrorKind::Interrupted {
                self.error =
                    Some(error.raw_os_error().map_or_else(|| error.kind().into(), io::Error::from_raw_os_error));
            }
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Plain old data in a row, as bytes: for `#[serde(with = "pod")]`.
pub(super) mod pod {
    use bytemuck::Pod;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};
    use std::ops::Deref;

    pub(in crate::train) fn serialize<T: Pod, S: Serializer>(
        values: &impl Deref<Target = [T]>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(bytemuck::cast_slice(values))
    }

    pub(in crate::train) fn deserialize<'de, T: Pod, V, D>(deserializer: D) -> Result<V, D::Error>
    where
        V: Deref<Target = [T]> + From<Vec<T>>,
        D: Deserializer<'de>,
    {
        let bytes = <&[u8]>::deserialize(deserializer)?;
        if !bytes.len().is_multiple_of(size_of::<T>()) {
            return Err(D::Error::custom("a value is cut"));
        }
        let mut values = vec![T::zeroed(); bytes.len() / size_of::<T>()];
        bytemuck::cast_slice_mut(&mut values).copy_from_slice(bytes);
        Ok(values.into())
    }
}

/// One piece of plain old data, as bytes: for `#[serde(with = "record")]`.
pub(super) mod record {
    use bytemuck::Pod;
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(in crate::train) fn serialize<S: Serializer>(value: &impl Pod, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(bytemuck::bytes_of(value))
    }

    pub(in crate::train) fn deserialize<'de, T: Pod, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
        bytemuck::try_pod_read_unaligned(<&[u8]>::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

/// What has JSON of its own, as that text: for `#[serde(with = "json")]`.
pub(super) mod json {
    use serde::de::{DeserializeOwned, Error as _};
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(in crate::train) fn serialize<S: Serializer>(value: &impl Serialize, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&serde_json::to_string(value).map_err(S::Error::custom)?)
    }

    pub(in crate::train) fn deserialize<'de, T: DeserializeOwned, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<T, D::Error> {
        serde_json::from_str(<&str>::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Example {
        #[serde(with = "pod")]
        words: Vec<u32>,
        #[serde(with = "json")]
        names: Vec<String>,
        number: Option<u64>,
    }

    #[test]
    fn values_come_back_and_every_cut_is_seen() {
        let value = Example { words: vec![0, 0, 7, u32::MAX], names: vec!["räume".to_owned()], number: Some(1 << 40) };
        let bytes = encode(&value).unwrap();
        assert_eq!(read::<Example>(&bytes), Ok(value));
        for length in 0..bytes.len() {
            assert_eq!(read::<Example>(&bytes[..length]), Err(PartError), "{length} bytes");
        }
        assert_eq!(read::<Example>(&[bytes, vec![0]].concat()), Err(PartError));
        // Three bytes are no word.
        assert_eq!(read::<Example>(&encode(&(&b"abc"[..].to_vec(), "[]", None::<u64>)).unwrap()), Err(PartError));
    }

    #[test]
    fn zeros_take_little_space() {
        let value = Example { words: vec![0; 1_000_000], names: Vec::new(), number: None };
        let bytes = encode(&value).unwrap().len();
        assert!(bytes < 200_000, "{bytes}");
    }

    struct Full;

    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_full_disk_is_told() {
        let value = Example { words: (0..1_000_000).collect(), names: Vec::new(), number: None };
        assert_eq!(write(&value, &mut Full).unwrap_err().kind(), io::ErrorKind::StorageFull);
    }
}
