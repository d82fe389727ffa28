//! What a key of a config or world file is: its path, its default, what it may be, and where that comes from.

use std::fmt;

/// What a number may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Whether `low` itself is not allowed.
    pub open_low: bool,
    /// Whether `high` itself is not allowed.
    pub open_high: bool,
}

impl Bounds {
    /// From `low` to `high`, both allowed.
    pub const fn between(low: f64, high: f64) -> Self {
        Self { low, high, open_low: false, open_high: false }
    }

    /// More than `low`, at most `high`.
    pub const fn above(low: f64, high: f64) -> Self {
        Self { low, high, open_low: true, open_high: false }
    }

    /// At least `low`, less than `high`.
    pub const fn below(low: f64, high: f64) -> Self {
        Self { low, high, open_low: false, open_high: true }
    }

    /// More than `low`, less than `high`.
    pub const fn inside(low: f64, high: f64) -> Self {
        Self { low, high, open_low: true, open_high: true }
    }

    /// Whether the value is allowed, also once it is rounded to f32.
    pub fn holds(self, value: f64) -> bool {
        let one = |value: f64| {
            let low = if self.open_low { value > self.low } else { value >= self.low };
            let high = if self.open_high { value < self.high } else { value <= self.high };
            low && high
        };
        // An allowed end may lie just outside once rounded; a forbidden one must not be rounded to.
        let rounded = f64::from(value as f32);
        let forbidden = (self.open_low && rounded <= self.low) || (self.open_high && rounded >= self.high);
        one(value) && !forbidden
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high, open_low, open_high } = self;
        match (open_low, open_high) {
            (false, false) => write!(f, "between {low} and {high}"),
            (true, false) => write!(f, "more than {low} and at most {high}"),
            (false, true) => write!(f, "at least {low} and less than {high}"),
            (true, true) => write!(f, "more than {low} and less than {high}"),
        }
    }
}

/// What a key's value may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// A number.
    Number(Bounds),
    /// A whole number, both ends allowed.
    Whole(u32, u32),
    /// True or false.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Anything else: its types in JSON, and in words.
    Other(&'static [&'static str], &'static str),
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(bounds) => write!(f, "a number {bounds}"),
            Self::Whole(low, high) => write!(f, "a whole number between {low} and {high}"),
            Self::Flag => f.write_str("true or false"),
            Self::Choice(words) => f.write_str(&words.join(" or ")),
            Self::Other(_, words) => f.write_str(words),
        }
    }
}

/// Where a default comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DefaultSource {
    /// Stated by the paper.
    Paper,
    /// Our choice.
    Ours,
}

/// One key of a config or world file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeyRow {
    /// Dotted path; `*` stands for a name that the file gives, such as a skill's.
    pub path: &'static str,
    /// Default as TOML; none if the key is required, or may be left out for the reason that `doc` gives.
    pub default: Option<&'static str>,
    /// What it may be.
    pub allowed: Allowed,
    /// Where the default comes from.
    pub source: DefaultSource,
    /// What it means, with its unit.
    pub doc: &'static str,
}

impl KeyRow {
    /// The last part of the path.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or(self.path)
    }
}

/// JSON type of a key that holds text.
pub const TEXT: &[&str] = &["string"];
/// JSON type of a key that holds a list.
pub const LIST: &[&str] = &["array"];

/// A constant for each key, and a list of them all: name, path, default, what it may be, source, meaning.
macro_rules! key_rows {
    ($(#[$all_doc:meta])* $all:ident:
        $($name:ident = $path:literal, $default:expr, $allowed:expr, $source:ident, $doc:literal;)*) => {
        $(
            #[doc = concat!("`", $path, "`: ", $doc)]
            pub const $name: $crate::layout::schema::KeyRow = $crate::layout::schema::KeyRow {
                path: $path,
                default: $default,
                allowed: $allowed,
                source: $crate::layout::schema::DefaultSource::$source,
                doc: $doc,
            };
        )*
        $(#[$all_doc])*
        pub const $all: &[$crate::layout::schema::KeyRow] = &[$($name),*];
    };
}
pub(crate) use key_rows;
