//! Takes typed values out of a [`Node`] tree and refuses what nobody asked for.

use super::document::{KeyValue, Node, SourceSpan, Value};
use super::error::{ConfigError, list, nearest, suggest};
use crate::layout::params::ParamRow;
use crate::layout::schema::{Allowed, Bounds, KeyRow};
use bytemuck::Pod;
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Whether the text is a short name of letters, digits, `-` and `_`; such names need no quotes in TOML.
pub(crate) fn is_name(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

/// The text in brackets after a name, as in `sonar(60)`.
pub(crate) fn argument<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    text.strip_prefix(name)?.strip_prefix('(')?.strip_suffix(')').map(str::trim)
}

/// A value with its dotted name, for messages.
#[derive(Debug, Clone)]
pub(crate) struct Item<'a> {
    pub(crate) name: String,
    pub(crate) node: &'a Node,
}

impl<'a> Item<'a> {
    /// The document as a value.
    pub(crate) fn root(node: &'a Node) -> Self {
        Self { name: String::new(), node }
    }

    /// Where it was written.
    pub(crate) fn origin(&self) -> &'a SourceSpan {
        &self.node.origin
    }

    /// A complaint about this value.
    pub(crate) fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> ConfigError {
        self.origin().error(message, hint)
    }

    fn wrong(&self, expected: &str, hint: &str) -> ConfigError {
        self.error(format!("`{}` must be {expected}, not {}", self.name, self.node.kind()), hint)
    }

    /// A number within bounds, as written.
    pub(crate) fn double(&self, bounds: Bounds) -> Result<f64, ConfigError> {
        let value = match self.node.value {
            Value::Float(value) => value,
            Value::Integer(value) => value as f64,
            _ => return Err(self.wrong("a number", &format!("use a number {bounds}"))),
        };
        if !bounds.holds(value) {
            // Plain notation would fill the line with zeros.
            let long = value != 0.0 && !(1e-4..1e15).contains(&value.abs());
            let shown = if long { format!("{value:e}") } else { value.to_string() };
            let message = format!("`{}` is {shown}, which is out of range", self.name);
            return Err(self.error(message, format!("use a number {bounds}")));
        }
        Ok(value)
    }

    /// A number within bounds.
    pub(crate) fn number(&self, bounds: Bounds) -> Result<f32, ConfigError> {
        self.double(bounds).map(|value| value as f32)
    }

    /// A whole number within bounds, both allowed.
    pub(crate) fn whole(&self, low: u32, high: u32) -> Result<u32, ConfigError> {
        let hint = format!("use a whole number between {low} and {high}");
        match self.node.value {
            Value::Integer(value) => match u32::try_from(value) {
                Ok(value) if (low..=high).contains(&value) => Ok(value),
                _ => Err(self.error(format!("`{}` is {value}, which is out of range", self.name), hint)),
            },
            _ => Err(self.wrong("a whole number", &hint)),
        }
    }

    /// True or false.
    pub(crate) fn flag(&self) -> Result<bool, ConfigError> {
        match self.node.value {
            Value::Flag(flag) => Ok(flag),
            _ => Err(self.wrong("true or false", "write true or false, without quotes")),
        }
    }

    /// Text.
    pub(crate) fn text(&self) -> Result<&'a str, ConfigError> {
        match &self.node.value {
            Value::Text(text) => Ok(text),
            _ => Err(self.wrong("a string", "put text in quotes")),
        }
    }

    /// A short name of letters, digits, `-` and `_`.
    pub(crate) fn short_name(&self) -> Result<&'a str, ConfigError> {
        let text = self.text()?;
        if !is_name(text) {
            return Err(self.error(format!("`{text}` cannot be a name"), "use letters, digits, `-` and `_` only"));
        }
        Ok(text)
    }

    /// One of the given names; returns its index.
    pub(crate) fn choice(&self, what: &str, allowed: &[&str]) -> Result<usize, ConfigError> {
        let text = self.text()?;
        allowed
            .iter()
            .position(|name| *name == text)
            .ok_or_else(|| self.error(format!("`{text}` is not one of the {what}"), suggest(text, what, allowed)))
    }

    /// The items of a list.
    pub(crate) fn items(&self) -> Result<Vec<Item<'a>>, ConfigError> {
        match &self.node.value {
            Value::List(items) => {
                let item = |(i, node)| Item { name: format!("{}[{i}]", self.name), node };
                Ok(items.iter().enumerate().map(item).collect())
            }
            _ => Err(self.wrong("a list", "write it as [ ..., ... ]")),
        }
    }

    /// A list that is not empty, not too long, and in which nothing is twice.
    pub(crate) fn distinct<T: PartialEq>(
        &self,
        most: usize,
        read: impl Fn(&Item<'a>) -> Result<T, ConfigError>,
    ) -> Result<Vec<T>, ConfigError> {
        let mut out = Vec::new();
        for one in self.items()? {
            let value = read(&one)?;
            if out.contains(&value) {
                return Err(one.error(format!("`{}` is there twice", one.text()?), "name each once"));
            }
            out.push(value);
        }
        if out.is_empty() {
            return Err(self.error(format!("`{}` is empty", self.name), "name at least one"));
        }
        if out.len() > most {
            let message = format!("`{}` has {} entries", self.name, out.len());
            return Err(self.error(message, format!("at most {most} fit")));
        }
        Ok(out)
    }

    /// What a list chooses, in ascending order; `read` gives the number of an item, and its name for messages.
    pub(crate) fn chosen(
        &self,
        what: &str,
        hint: &str,
        read: impl Fn(&Item<'a>) -> Result<(usize, String), ConfigError>,
    ) -> Result<Vec<usize>, ConfigError> {
        let mut chosen = BTreeSet::new();
        for item in self.items()? {
            let (number, name) = read(&item)?;
            if !chosen.insert(number) {
                return Err(item.error(format!("the {what} {name} is there twice"), "name each once"));
            }
        }
        if chosen.is_empty() {
            return Err(self.error(format!("no {what} is chosen"), hint));
        }
        Ok(chosen.into_iter().collect())
    }

    /// A list of whole numbers up to `high`, each more than the one before.
    pub(crate) fn ascending(&self, high: u32) -> Result<Vec<u32>, ConfigError> {
        let mut out = Vec::new();
        for item in self.items()? {
            let number = item.whole(0, high)?;
            if out.last().is_some_and(|&last| last >= number) {
                let message = format!("`{}` does not rise", item.name);
                return Err(item.error(message, "write each number once, in ascending order"));
            }
            out.push(number);
        }
        Ok(out)
    }

    /// A list of exactly N numbers of any reasonable size, inches or degrees; `shape` shows them, for the hint.
    pub(crate) fn numbers<const N: usize>(&self, shape: &str) -> Result<[f32; N], ConfigError> {
        self.numbers_within(shape, Bounds::between(-1e6, 1e6))
    }

    /// A list of exactly N numbers within bounds.
    pub(crate) fn numbers_within<const N: usize>(&self, shape: &str, bounds: Bounds) -> Result<[f32; N], ConfigError> {
        let hint = format!("write {shape}");
        let Value::List(_) = &self.node.value else { return Err(self.wrong(&format!("a list of {N} numbers"), &hint)) };
        let items = self.items()?;
        if items.len() != N {
            return Err(self.error(format!("`{}` must have {N} numbers, not {}", self.name, items.len()), hint));
        }
        let mut out = [0.0; N];
        for (to, item) in out.iter_mut().zip(&items) {
            *to = item.number(bounds)?;
        }
        Ok(out)
    }

    /// The table; every key that is not asked for before [`TableReader::finish`] is refused there.
    pub(crate) fn table(&self) -> Result<TableReader<'a>, ConfigError> {
        match self.node.value {
            Value::Table(_) => Ok(TableReader { name: self.name.clone(), node: self.node, asked: RefCell::default() }),
            _ => Err(self.wrong("a table", "write its keys below a [header], or as { key = value }")),
        }
    }
}

/// A table that keeps track of the keys that were asked for. Where keys have rows, defaults are in the tree already.
#[derive(Debug)]
pub(crate) struct TableReader<'a> {
    name: String,
    node: &'a Node,
    asked: RefCell<Vec<String>>,
}

/// A row stands for the last part of its path.
impl AsRef<str> for KeyRow {
    fn as_ref(&self) -> &str {
        self.name()
    }
}

impl<'a> TableReader<'a> {
    /// The full dotted name of a key.
    fn name_of(&self, key: &str) -> String {
        if self.name.is_empty() { key.to_owned() } else { format!("{}.{key}", self.name) }
    }

    /// The value under a key that may be missing.
    pub(crate) fn optional(&self, key: impl AsRef<str>) -> Option<Item<'a>> {
        let key = key.as_ref();
        let mut asked = self.asked.borrow_mut();
        if !asked.iter().any(|known| known == key) {
            asked.push(key.to_owned());
        }
        self.node.get(key).map(|node| Item { name: self.name_of(key), node })
    }

    /// The value under a key that must be there; `example` shows one.
    pub(crate) fn required(&self, key: impl AsRef<str>, example: &str) -> Result<Item<'a>, ConfigError> {
        let key = key.as_ref();
        self.optional(key).ok_or_else(|| {
            // A misspelt key explains a missing one better.
            let stranger = self.node.entries().iter().find(|e| nearest(&e.key, &[key]).is_some());
            let hint = match stranger {
                Some(entry) => format!("`{}` was found; did you mean `{key}`?", entry.key),
                None => format!("add `{key} = {example}`"),
            };
            self.node.origin.error(format!("`{}` is missing", self.name_of(key)), hint)
        })
    }

    /// The value of a key that has a default.
    pub(crate) fn value(&self, key: &KeyRow) -> Result<Item<'a>, ConfigError> {
        self.required(key, key.default.unwrap_or("..."))
    }

    /// The value of a key as the word that stands for it in a learner's memory: a number as the bits of an f32, a whole
    /// number as it is, 0 or 1, the place of a word among those possible.
    pub(crate) fn word(&self, key: &KeyRow) -> Result<u32, ConfigError> {
        let item = self.value(key)?;
        match key.allowed {
            Allowed::Number(bounds) => item.number(bounds).map(f32::to_bits),
            Allowed::Whole(low, high) => item.whole(low, high),
            Allowed::Flag => item.flag().map(u32::from),
            Allowed::Choice(words) => item.choice("possible values", words).map(|place| place as u32),
            Allowed::Other(..) => Ok(0),
        }
    }

    /// A number in the key's range.
    pub(crate) fn number(&self, key: &KeyRow) -> Result<f32, ConfigError> {
        self.word(key).map(f32::from_bits)
    }

    /// A number in the key's range, or its default where it is left out of a file that no defaults lie under.
    pub(crate) fn number_or_default(&self, key: &KeyRow) -> Result<f32, ConfigError> {
        match (self.optional(key), key.default.and_then(|text| text.parse().ok())) {
            (None, Some(default)) => Ok(default),
            _ => self.number(key),
        }
    }

    /// Reads the keys whose paths are `prefix` and a name into the fields of `out` that their rows name.
    pub(crate) fn fill<T: Pod>(
        &self,
        prefix: &str,
        rows: impl Iterator<Item = &'static ParamRow>,
        out: &mut T,
    ) -> Result<(), ConfigError> {
        let words: &mut [u32] = bytemuck::cast_slice_mut(std::slice::from_mut(out));
        for row in rows.filter(|row| row.key.path.strip_prefix(prefix) == Some(row.key.name())) {
            words[row.word] = self.word(&row.key)?;
        }
        Ok(())
    }

    /// All keys with their values, all counted as asked for.
    pub(crate) fn all(&self) -> Vec<(&'a KeyValue, Item<'a>)> {
        let entries = self.node.entries().iter();
        self.asked.borrow_mut().extend(entries.clone().map(|entry| entry.key.clone()));
        entries.map(|entry| (entry, Item { name: self.name_of(&entry.key), node: &entry.node })).collect()
    }

    /// Refuses keys that were never asked for.
    pub(crate) fn finish(self) -> Result<(), ConfigError> {
        let asked = self.asked.borrow();
        let asked: Vec<&str> = asked.iter().map(String::as_str).collect();
        let Some(entry) = self.node.entries().iter().find(|entry| !asked.contains(&&*entry.key)) else { return Ok(()) };
        let place = if self.name.is_empty() { "here".to_owned() } else { format!("in `{}`", self.name) };
        let hint = match nearest(&entry.key, &asked) {
            Some(best) => format!("did you mean `{best}`?"),
            None => format!("the keys {place} are {}", list(&asked)),
        };
        Err(entry.origin.error(format!("unknown key `{}`", self.name_of(&entry.key)), hint))
    }
}
