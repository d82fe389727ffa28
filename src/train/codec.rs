//! Little-endian words, to and from the files that a run keeps for itself.

use std::io::{self, Write};

/// What a run keeps for itself does not hold what it should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("it does not hold whole results of this experiment")]
pub struct PartError;

/// Fewest zeros in a row that are counted and not written.
const GAP: usize = 4;

/// The words of a file.
///
/// # Errors
/// Where a word is cut.
pub fn words_of(bytes: &[u8]) -> Result<Vec<u32>, PartError> {
    let (chunks, rest) = bytes.as_chunks::<4>();
    if rest.is_empty() { Ok(chunks.iter().map(|chunk| u32::from_le_bytes(*chunk)).collect()) } else { Err(PartError) }
}

/// Writes words.
///
/// # Errors
/// Those of `out`.
pub fn put(out: &mut dyn Write, words: &[u32]) -> io::Result<()> {
    let mut bytes = Vec::with_capacity(4096);
    for chunk in words.chunks(1024) {
        bytes.clear();
        bytes.extend(chunk.iter().flat_map(|word| word.to_le_bytes()));
        out.write_all(&bytes)?;
    }
    Ok(())
}

/// Writes words among which there are many zeros: in turn a number of zeros, a number of words, and the words.
///
/// # Errors
/// Those of `out`.
pub fn put_sparse(out: &mut dyn Write, words: &[u32]) -> io::Result<()> {
    let mut rest = words;
    while !rest.is_empty() {
        let zeros = rest.iter().position(|word| *word != 0).unwrap_or(rest.len());
        rest = &rest[zeros..];
        let count = rest.windows(GAP).position(|words| words == [0; GAP]).unwrap_or(rest.len());
        put(out, &[zeros as u32, count as u32])?;
        put(out, &rest[..count])?;
        rest = &rest[count..];
    }
    Ok(())
}

/// Reads words one after another.
#[derive(Debug)]
pub struct Reader<'a> {
    words: &'a [u32],
}

impl<'a> Reader<'a> {
    /// From the first word on.
    pub fn new(words: &'a [u32]) -> Self {
        Self { words }
    }

    /// The next `count` words.
    ///
    /// # Errors
    /// Where there are fewer.
    pub fn slice(&mut self, count: usize) -> Result<&'a [u32], PartError> {
        let (head, tail) = self.words.split_at_checked(count).ok_or(PartError)?;
        self.words = tail;
        Ok(head)
    }

    /// The next words, as many as are asked for.
    ///
    /// # Errors
    /// Where there are fewer.
    pub fn words<const N: usize>(&mut self) -> Result<[u32; N], PartError> {
        self.slice(N)?.try_into().map_err(|_| PartError)
    }

    /// An f64.
    ///
    /// # Errors
    /// Where the words end.
    pub fn double(&mut self) -> Result<f64, PartError> {
        let [low, high] = self.words()?;
        Ok(f64::from_bits(u64::from(low) | u64::from(high) << 32))
    }

    /// Some f32, their number first.
    ///
    /// # Errors
    /// Where the words end.
    pub fn singles(&mut self) -> Result<Vec<f32>, PartError> {
        Ok(self.list()?.iter().map(|bits| f32::from_bits(*bits)).collect())
    }

    /// Some words, their number first.
    ///
    /// # Errors
    /// Where the words end.
    pub fn list(&mut self) -> Result<&'a [u32], PartError> {
        let [count] = self.words()?;
        self.slice(count as usize)
    }

    /// As many words as `into` has, as [`put_sparse`] wrote them.
    ///
    /// # Errors
    /// Where they are more or fewer.
    pub fn sparse(&mut self, into: &mut [u32]) -> Result<(), PartError> {
        let mut rest = into;
        while !rest.is_empty() {
            let [zeros, count] = self.words()?;
            let (gap, tail) = rest.split_at_mut_checked(zeros as usize).ok_or(PartError)?;
            gap.fill(0);
            let (words, tail) = tail.split_at_mut_checked(count as usize).ok_or(PartError)?;
            words.copy_from_slice(self.slice(count as usize)?);
            rest = tail;
        }
        Ok(())
    }

    /// The end.
    ///
    /// # Errors
    /// Where there are more words.
    pub fn end(&self) -> Result<(), PartError> {
        if self.words.is_empty() { Ok(()) } else { Err(PartError) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_gaps_come_back() {
        let cases: [&[u32]; 6] =
            [&[], &[0; 9], &[7], &[0, 0, 0, 0, 5, 0, 0, 6, 0, 0, 0, 0], &[1, 0, 0, 0, 2], &[1, 0, 0, 0, 0, 2]];
        for words in cases {
            let mut bytes = Vec::new();
            put_sparse(&mut bytes, words).unwrap();
            let written = words_of(&bytes).unwrap();
            let mut found = vec![9; words.len()];
            let mut reader = Reader::new(&written);
            reader.sparse(&mut found).unwrap();
            assert_eq!((found.as_slice(), reader.end()), (words, Ok(())));
            assert!(words.is_empty() || Reader::new(&written).sparse(&mut vec![0; words.len() + 1]).is_err());
            assert!(
                words.is_empty()
                    || Reader::new(&written).sparse(&mut vec![0; words.len() - 1]).is_err()
                    || words.len() == 1
            );
        }
        let mut bytes = Vec::new();
        put_sparse(&mut bytes, &[0; 1_000_000]).unwrap();
        assert_eq!(bytes.len(), 8);
    }
}
