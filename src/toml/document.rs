//! TOML as a tree in which every key and value remembers where it was written.

use super::error::{ConfigError, Place};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::de::{DeTable, DeValue};

/// Tables that are replaced as a whole: shares of start regions sum to 1, and thresholds belong to the children that
/// are named beside them.
const WHOLE: [&str; 2] = ["starts", "applicable"];
/// The table whose keys stand for those of the rest: there, each member of [`WHOLE`] tables is an axis of its own.
pub(crate) const SWEEP: &str = "sweep";

/// Where a key or value was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum SourceSpan {
    /// These bytes of a file, or all of it.
    File(Arc<SourceFile>, Option<Range<usize>>),
    /// A command line argument, whole.
    Argument(String),
    /// The default of the key with this path.
    Default(&'static str),
}

/// A file that was read.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SourceFile {
    path: PathBuf,
    text: String,
}

impl SourceSpan {
    fn part(&self, span: Range<usize>) -> Self {
        match self {
            Self::File(file, _) => Self::File(Arc::clone(file), Some(span)),
            other => other.clone(),
        }
    }

    /// A complaint about this place.
    pub(crate) fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> ConfigError {
        let place = match self {
            Self::File(file, Some(span)) => Place::of_span(&file.path, &file.text, span),
            Self::File(file, None) => Place::File(file.path.clone()),
            Self::Argument(argument) => Place::Argument(argument.clone()),
            Self::Default(path) => Place::Argument(format!("the default of {path}")),
        };
        ConfigError::new(place, message, hint)
    }

    /// Whether nobody wrote this.
    pub(crate) fn is_default(&self) -> bool {
        matches!(self, Self::Default(_))
    }

    fn replace_default(&mut self, other: Self) {
        if self.is_default() {
            *self = other;
        }
    }
}

/// A value and its place.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) origin: SourceSpan,
}

/// A TOML value. Numbers are finite; dates are refused on reading.
#[derive(Debug, Clone)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Flag(bool),
    List(Vec<Node>),
    Table(Vec<KeyValue>),
}

/// A key with its value; `origin` is the key's.
#[derive(Debug, Clone)]
pub(crate) struct KeyValue {
    pub(crate) key: String,
    pub(crate) origin: SourceSpan,
    pub(crate) node: Node,
}

impl Node {
    /// Reads a whole file's text.
    pub(crate) fn parse(text: &str, path: &Path) -> Result<Self, ConfigError> {
        let file = SourceFile { path: path.to_owned(), text: text.to_owned() };
        let whole = SourceSpan::File(Arc::new(file), None);
        let document = DeTable::parse(text).map_err(|error| {
            let message = format!("not valid TOML: {}", error.message());
            let hint = "text needs quotes, lists need commas; https://toml.io has the rules";
            whole.part(error.span().unwrap_or(0..0)).error(message, hint)
        })?;
        Ok(Self { value: table(document.get_ref(), &whole)?, origin: whole })
    }

    /// Reads one value, if that is TOML.
    pub(crate) fn parse_value(text: &str, origin: &SourceSpan) -> Result<Option<Self>, ConfigError> {
        match DeValue::parse(text) {
            Ok(value) => convert(value.get_ref(), value.span(), origin).map(Some),
            Err(_) => Ok(None),
        }
    }

    /// An empty table.
    pub(crate) fn empty(origin: SourceSpan) -> Self {
        Self { value: Value::Table(Vec::new()), origin }
    }

    /// Text.
    pub(crate) fn text(text: &str, origin: &SourceSpan) -> Self {
        Self { value: Value::Text(text.to_owned()), origin: origin.clone() }
    }

    /// This value in tables that have nothing else, under the path of keys.
    pub(crate) fn under(self, path: &[&str]) -> Self {
        path.iter().rev().fold(self, |node, key| {
            let mut table = Self::empty(node.origin.clone());
            table.put(key, node);
            table
        })
    }

    /// The value's type in words.
    pub(crate) fn kind(&self) -> &'static str {
        match self.value {
            Value::Text(_) => "a string",
            Value::Integer(_) => "a whole number",
            Value::Float(_) => "a decimal number",
            Value::Flag(_) => "true or false",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
        }
    }

    /// Whether this is a table that holds the values of an axis of a sweep, and no further keys.
    pub(crate) fn is_axis(&self) -> bool {
        self.get("values").or_else(|| self.get("from")).is_some()
    }

    /// What is in it, if this is a table.
    pub(crate) fn entries(&self) -> &[KeyValue] {
        if let Value::Table(entries) = &self.value { entries } else { &[] }
    }

    /// The value under a key, if this is a table that has it.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries().iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    /// The keys of the table under `group`; none if there is no such table.
    pub(crate) fn names(&self, group: &str) -> Vec<&str> {
        self.get(group).map_or(&[][..], Self::entries).iter().map(|entry| entry.key.as_str()).collect()
    }

    /// The value under a key, to be changed.
    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        match &mut self.value {
            Value::Table(entries) => entries.iter_mut().find(|entry| entry.key == key).map(|entry| &mut entry.node),
            _ => None,
        }
    }

    /// Takes a key out of this table.
    pub(crate) fn remove(&mut self, key: &str) -> Option<KeyValue> {
        let Value::Table(entries) = &mut self.value else { return None };
        let at = entries.iter().position(|entry| entry.key == key)?;
        Some(entries.remove(at))
    }

    /// Puts a value under a key of this table, in the place of an old one or last.
    pub(crate) fn put(&mut self, key: &str, node: Node) {
        let Value::Table(entries) = &mut self.value else { return };
        match entries.iter_mut().find(|entry| entry.key == key) {
            Some(entry) => entry.node = node,
            None => entries.push(KeyValue { key: key.to_owned(), origin: node.origin.clone(), node }),
        }
    }

    /// Lays `over` on top: tables are merged key by key, anything else is replaced, and [`WHOLE`] ones are too.
    pub(crate) fn merge(&mut self, over: Node) {
        self.merge_unless(over, |key, _| WHOLE.contains(&key));
    }

    fn merge_unless(&mut self, over: Node, whole: fn(&str, &Node) -> bool) {
        match (&mut self.value, over.value) {
            (Value::Table(below), Value::Table(above)) => {
                // What somebody wrote is a better place for complaints than a default.
                self.origin.replace_default(over.origin);
                for entry in above {
                    match below.iter_mut().find(|old| old.key == entry.key) {
                        Some(old) if !whole(&entry.key, &entry.node) => {
                            old.origin.replace_default(entry.origin);
                            // Each threshold may be an axis, and an axis that is given anew has nothing of the old one.
                            let whole = if entry.key == SWEEP { |_: &str, node: &Node| node.is_axis() } else { whole };
                            old.node.merge_unless(entry.node, whole);
                        }
                        Some(old) => *old = entry,
                        None => below.push(entry),
                    }
                }
            }
            (below, above) => {
                *below = above;
                self.origin = over.origin;
            }
        }
    }
}

fn table(entries: &DeTable<'_>, whole: &SourceSpan) -> Result<Value, ConfigError> {
    let each = entries.iter().map(|(key, value)| {
        let node = convert(value.get_ref(), value.span(), whole)?;
        Ok(KeyValue { key: key.get_ref().to_string(), origin: whole.part(key.span()), node })
    });
    each.collect::<Result<_, _>>().map(Value::Table)
}

fn convert(value: &DeValue<'_>, span: Range<usize>, whole: &SourceSpan) -> Result<Node, ConfigError> {
    let origin = whole.part(span);
    let value = match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => return Err(origin.error(format!("{number} is too large"), "use a number of at most 18 digits")),
        },
        DeValue::Float(number) => match number.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => Value::Float(number),
            _ => {
                let message = format!("`{number}` is not a number that can be used");
                return Err(origin.error(message, "every number must be finite"));
            }
        },
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => return Err(origin.error("dates have no meaning here", "put text in quotes")),
        DeValue::Array(items) => {
            let each = items.iter().map(|item| convert(item.get_ref(), item.span(), whole));
            Value::List(each.collect::<Result<_, _>>()?)
        }
        DeValue::Table(entries) => table(entries, whole)?,
    };
    Ok(Node { value, origin })
}
