//! What is wrong with a config or world file, where, and what to do about it.

use std::fmt;
use std::io::{self, ErrorKind};
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A refused config, world file or command line value.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct ConfigError(Box<Complaint>);

/// Where a refused value came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// A part of a line of a file.
    Line {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// In characters, counted from 1.
        column: usize,
        /// Characters that are underlined, at least 1.
        width: usize,
        /// The whole line.
        text: String,
    },
    /// A file as a whole: it cannot be read, or lacks something.
    File(PathBuf),
    /// Something typed on the command line, such as `--set learning.learning_rate=x`.
    Argument(String),
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Complaint {
    place: Place,
    message: String,
    hint: String,
}

impl ConfigError {
    /// A complaint about `place`; the hint says what would be right.
    pub fn new(place: Place, message: impl Into<String>, hint: impl Into<String>) -> Self {
        Self(Box::new(Complaint { place, message: message.into(), hint: hint.into() }))
    }

    /// A file that cannot be read.
    pub fn unreadable(path: &Path, what: &str, error: &io::Error) -> Self {
        let (reason, hint) = match error.kind() {
            ErrorKind::NotFound => {
                ("there is no such file", "check the spelling, and the folder that the path starts from")
            }
            ErrorKind::IsADirectory => ("it is a folder", "name a file, not a folder"),
            ErrorKind::InvalidData => ("it is not text", "the file must be plain UTF-8 text"),
            _ => (&*error.to_string(), "check the file's permissions"),
        };
        Self::new(Place::File(path.to_owned()), format!("cannot read the {what}: {reason}"), hint)
    }

    /// Where the refused value stands.
    pub fn place(&self) -> &Place {
        &self.0.place
    }

    /// What is wrong, in one sentence.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// What would be right.
    pub fn hint(&self) -> &str {
        &self.0.hint
    }
}

impl Place {
    /// The line that holds the first byte of `span`.
    pub fn of_span(path: &Path, text: &str, span: &Range<usize>) -> Self {
        let start = floor_boundary(text, span.start);
        let first = text[..start].rfind('\n').map_or(0, |at| at + 1);
        let last = text[start..].find('\n').map_or(text.len(), |at| start + at);
        let end = floor_boundary(text, span.end).clamp(start, last);
        Self::Line {
            path: path.to_owned(),
            line: text[..first].matches('\n').count() + 1,
            column: text[first..start].chars().count() + 1,
            width: text[start..end].trim_end().chars().count().max(1),
            text: text[first..last].trim_end().to_owned(),
        }
    }
}

/// The nearest place at or before `at` where the text may be cut.
fn floor_boundary(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    (0..=at).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        match &self.place {
            Place::Line { path, line, column, width, text } => {
                let (path, text) = (path.display(), text.replace('\t', " "));
                let margin = " ".repeat(line.to_string().len());
                let under = format!("{}{}", " ".repeat(column.saturating_sub(1)), "^".repeat(*width));
                write!(f, "\n{margin}--> {path}:{line}:{column}")?;
                write!(f, "\n{margin} |\n{line} | {text}\n{margin} | {under}")
            }
            Place::File(path) => write!(f, "\n --> {}", path.display()),
            Place::Argument(argument) => write!(f, "\n --> {argument}"),
        }?;
        if self.hint.is_empty() { Ok(()) } else { write!(f, "\nhint: {}", self.hint) }
    }
}

/// The name of `allowed` that was most likely meant.
pub(crate) fn nearest<'a>(name: &str, allowed: &[&'a str]) -> Option<&'a str> {
    let distance = |other: &&str| strsim::damerau_levenshtein(&name.to_lowercase(), &other.to_lowercase());
    let best = allowed.iter().copied().min_by_key(distance)?;
    // A third of the letters may be wrong; beyond that a suggestion is a guess.
    (distance(&best) <= name.chars().count().max(best.chars().count()) / 3).then_some(best)
}

/// A hint for an unknown name: the likely one, or all that are allowed.
pub(crate) fn suggest(name: &str, what: &str, allowed: &[&str]) -> String {
    match (nearest(name, allowed), allowed) {
        (Some(best), _) => format!("did you mean `{best}`?"),
        (None, []) => format!("there are no {what} here"),
        (None, _) => format!("the {what} here are {}", list(allowed)),
    }
}

/// The names in back quotes, comma separated.
pub(crate) fn list(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters_and_keep_to_one_line() {
        let text = "a = 1\r\n\tb = \"\u{e9}\u{e9}\" + [\r\n2]\r\n";
        let start = text.find('+').expect("a plus");
        let place = Place::of_span(Path::new("f.toml"), text, &(start..text.len()));
        let Place::Line { line, column, width, text: shown, .. } = &place else { panic!("{place:?}") };
        assert_eq!((*line, *column, *width, shown.as_str()), (2, 11, 3, "\tb = \"\u{e9}\u{e9}\" + ["));
        let error = ConfigError::new(place, "no", "yes").to_string();
        let lines: Vec<&str> = error.lines().collect();
        assert_eq!(lines[1], " --> f.toml:2:11");
        assert_eq!(
            lines[3].find('+').map(|_| lines[3].chars().position(|c| c == '+')),
            Some(lines[4].chars().position(|c| c == '^'))
        );
        // Beyond the end, and inside a character.
        for span in [500..600, 13..14, 12..13] {
            assert!(matches!(Place::of_span(Path::new("f"), text, &span), Place::Line { width: 1.., .. }));
        }
    }

    #[test]
    fn suggestions_are_near_or_absent() {
        assert_eq!(nearest("ligth", &["sonar", "light"]), Some("light"));
        assert_eq!(nearest("b", &["A", "B"]), Some("B"));
        assert_eq!(nearest("x", &["A", "B"]), None);
        assert_eq!(nearest("x", &[]), None);
        assert_eq!(suggest("x", "rooms", &[]), "there are no rooms here");
    }
}
