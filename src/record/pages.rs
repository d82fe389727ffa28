//! Pages of a Parquet column, looked at before they are decoded.
//!
//! The parquet crate (60.1.0) makes room for as many values as a dictionary says that it holds. A forged number would
//! ask for any memory, which no error can be made of.

use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};

/// Fewest bytes that a value takes in a dictionary: a number of 32 bits, or the length of a text.
const LEAST: usize = 4;

/// The pages of a column.
pub(super) struct Pages(pub(super) Box<dyn PageReader>);

fn checked(page: Option<Page>) -> Result<Option<Page>> {
    match &page {
        Some(Page::DictionaryPage { buf, num_values, .. }) if *num_values as usize > buf.len() / LEAST => {
            Err(ParquetError::General(format!("a dictionary of {num_values} values in {} bytes", buf.len())))
        }
        _ => Ok(page),
    }
}

impl Iterator for Pages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Self::Item> {
        self.get_next_page().transpose()
    }
}

impl PageReader for Pages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        checked(self.0.get_next_page()?)
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.0.peek_next_page()
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.0.skip_next_page()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytes::Bytes;
    use parquet::basic::Encoding;

    #[test]
    fn a_dictionary_holds_no_more_values_than_fit() {
        let page = |bytes: usize, num_values: u32| {
            let buf = Bytes::from(vec![0; bytes]);
            checked(Some(Page::DictionaryPage { buf, num_values, encoding: Encoding::PLAIN, is_sorted: false }))
        };
        assert!(page(12, 3).is_ok() && page(0, 0).is_ok());
        assert!(page(12, 4).is_err() && page(0, 1).is_err() && page(1 << 20, u32::MAX).is_err());
    }
}
