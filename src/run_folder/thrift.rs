//! A look over the Thrift texts of a Parquet file before the parquet crate reads them.
//!
//! The crate (60.1.0) believes the numbers in them: a forged page or dictionary size asks for any memory, which no error
//! can be made of, and it counts to the end of a forged list. Here each number is held against the bytes that there are.

use parquet::file::metadata::ParquetMetaData;

/// Snappy makes at most 64 bytes of 3.
const MOST_PER_BYTE: u64 = 22;
/// Fewest bytes that a value takes in a dictionary: a number of 32 bits, or the length of a text.
const LEAST: u64 = 4;
/// Structs and lists within one another; a file of ours has fewer.
const DEPTH: u32 = 16;

/// Whether the text at a file's end that says what is in it can be read at no more cost than its length.
pub(super) fn footer_is_sound(file: &[u8]) -> bool {
    let length = |bytes: &[u8]| {
        let (rest, mark) = bytes.split_at_checked(bytes.len().checked_sub(4)?)?;
        let (rest, length) = rest.split_last_chunk::<4>().filter(|_| mark == b"PAR1")?;
        let start = rest.len().checked_sub(u32::from_le_bytes(*length) as usize)?;
        Text { rest: &rest[start..] }.structure(0, 0, &mut |_, _, _| {})
    };
    length(file).is_some()
}

/// Whether the pages of all columns claim no more than their bytes can hold.
pub(super) fn pages_are_sound(file: &[u8], metadata: &ParquetMetaData) -> bool {
    let chunks = metadata.row_groups().iter().flat_map(|group| group.columns());
    let mut bytes = chunks.map(|chunk| {
        let (start, length) = chunk.byte_range();
        let end = start.checked_add(length)?;
        file.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
    });
    bytes.all(|chunk| chunk.is_some_and(|chunk| chunk_is_sound(chunk).is_some()))
}

fn chunk_is_sound(mut chunk: &[u8]) -> Option<()> {
    while !chunk.is_empty() {
        let (mut expanded, mut stored, mut entries) = (None, None, 0);
        let mut text = Text { rest: chunk };
        // Field numbers are those of `PageHeader` and `DictionaryPageHeader` in Parquet's own description.
        text.structure(0, 0, &mut |parent, field, number| match (parent, field) {
            (0, 2) => expanded = u64::try_from(number).ok(),
            (0, 3) => stored = usize::try_from(number).ok(),
            (7, 1) => entries = u64::try_from(number).unwrap_or(u64::MAX),
            _ => {}
        })?;
        let (page, rest) = text.rest.split_at_checked(stored?)?;
        if expanded? > MOST_PER_BYTE * page.len() as u64 || entries > expanded? / LEAST {
            return None;
        }
        chunk = rest;
    }
    Some(())
}

/// Thrift's compact protocol, what is left of it.
struct Text<'a> {
    rest: &'a [u8],
}

impl Text<'_> {
    fn skip(&mut self, bytes: u64) -> Option<()> {
        self.rest = self.rest.get(usize::try_from(bytes).ok()?..)?;
        Some(())
    }

    fn byte(&mut self) -> Option<u8> {
        let (byte, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*byte)
    }

    fn unsigned(&mut self) -> Option<u64> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    /// Whole numbers alternate: 0, -1, 1, -2.
    fn signed(&mut self) -> Option<i64> {
        let number = self.unsigned()?;
        Some((number >> 1).cast_signed() ^ -((number & 1).cast_signed()))
    }

    /// Walks over a struct that is field `parent` of another, 0 for none, and shows the whole numbers in it.
    fn structure(&mut self, depth: u32, parent: i64, show: &mut dyn FnMut(i64, i64, i64)) -> Option<()> {
        let mut field = 0_i64;
        loop {
            let head = self.byte()?;
            if head == 0 {
                return Some(());
            }
            field = match head >> 4 {
                0 => self.signed()?,
                more => field.checked_add(i64::from(more))?,
            };
            match head & 0xf {
                // A flag is its own type.
                1 | 2 => {}
                4..=6 => show(parent, field, self.signed()?),
                12 if depth < DEPTH => self.structure(depth + 1, field, show)?,
                kind => self.value(kind, depth)?,
            }
        }
    }

    fn value(&mut self, kind: u8, depth: u32) -> Option<()> {
        match kind {
            1..=3 => self.skip(1),
            4..=6 => self.unsigned().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.unsigned()?;
                self.skip(length)
            }
            9 | 10 if depth < DEPTH => {
                let head = self.byte()?;
                let count = if head >> 4 == 15 { self.unsigned()? } else { u64::from(head >> 4) };
                // Each takes a byte at least.
                let count = usize::try_from(count).ok().filter(|count| *count <= self.rest.len())?;
                (0..count).try_for_each(|_| self.value(head & 0xf, depth + 1))
            }
            12 if depth < DEPTH => self.structure(depth + 1, 0, &mut |_, _, _| {}),
            // No map, and nothing newer, is in a Parquet file of ours.
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A page: type 0, its sizes in one byte each, and a dictionary of so many entries.
    fn page(expanded: u8, stored: u8, entries: u8) -> Vec<u8> {
        let twice = |number: u8| 2 * number;
        let mut page =
            vec![0x15, 0, 0x15, twice(expanded), 0x15, twice(stored), 0x4c, 0x15, twice(entries), 0x15, 0, 0, 0];
        page.resize(page.len() + usize::from(stored), 7);
        page
    }

    #[test]
    fn pages_hold_what_they_claim() {
        let sound = |chunk: &[u8]| chunk_is_sound(chunk).is_some();
        assert!(sound(&[]) && sound(&page(12, 4, 3)) && sound(&[page(44, 2, 11), page(0, 0, 0)].concat()));
        assert!(!sound(&page(12, 4, 4)), "too many entries");
        assert!(!sound(&page(45, 2, 1)), "no such compression");
        let whole = page(12, 4, 3);
        assert!((1..whole.len()).all(|length| !sound(&whole[..length])), "cut");
    }

    #[test]
    fn lists_are_no_longer_than_their_text() {
        let footer = |text: &[u8]| {
            let length = (text.len() as u32).to_le_bytes();
            footer_is_sound(&[b"PAR1", text, &length, b"PAR1"].concat())
        };
        assert!(footer(&[0]) && footer(&[0x19, 0x31, 1, 2, 1, 0]) && footer(&[0x19, 0xf5, 2, 9, 9, 0]));
        assert!(!footer(&[0x19, 0xf1, 0xff, 0xff, 0xff, 0xff, 7, 0]), "a list of two thousand million flags");
        assert!(!footer(&[0x19, 0x31, 1, 2]) && !footer(&[]) && !footer_is_sound(b"PAR1"));
        assert!(!footer(&[0x1c; 100]), "structs without end");
    }
}
