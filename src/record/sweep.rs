//! `sweep.json`: the axes of a sweep, and the value on each of them at every point.
//!
//! The column `point` of the tables indexes [`Sweep::points`]. A run without a sweep has no such file, and its only
//! point is 0. An arm is run at a point only if it differs there from the same arm at an earlier point: one that has
//! none of the keys of some axis appears once for each combination of values on the others.

use super::RecordError;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;

/// The file's name in a run folder.
pub const FILE: &str = "sweep.json";

/// How the points lie in the space of the axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Design {
    /// All combinations of values, the last axis fastest.
    Grid,
    /// Points drawn at random.
    Random,
}

/// How the values of an axis are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Evenly, or uniformly at random.
    Linear,
    /// Evenly in the logarithm, or uniformly at random in it.
    Log,
    /// As somebody listed them.
    List,
}

/// A value on an axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum AxisValue {
    /// A finite number, in the units of its key.
    Number(f64),
    /// A word, a world's file in the run folder, or `true` or `false`.
    Text(String),
}

/// Shortest text that reads back as the same number; words as they stand.
impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// A key of the config that differs between points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Dotted path of the key, such as `skill.recharge.applicable.dock`.
    pub key: String,
    /// What figures call it; the key if the config says nothing else.
    pub label: String,
    /// How its values are spread.
    pub scale: Scale,
    /// The distinct values, numbers ascending, words in the order of the config.
    pub values: Vec<AxisValue>,
}

/// The content of `sweep.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Sweep {
    /// How the points lie.
    pub design: Design,
    /// What differs between them.
    pub axes: Vec<Axis>,
    /// For each point, one value per axis. All points of the sweep, also where a run was restricted to some.
    pub points: Vec<Vec<AxisValue>>,
}

impl Sweep {
    /// A point in words, such as `dock threshold 0.05, door threshold 0.3`; empty for a point that is none.
    pub fn describe(&self, point: usize) -> String {
        let values = self.points.get(point).map_or(&[][..], Vec::as_slice);
        let each = self.axes.iter().zip(values).map(|(axis, value)| format!("{} {value}", axis.label));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// JSON text of `sweep.json`.
///
/// # Errors
/// [`RecordError::Invalid`] if a number has no JSON form.
pub fn write_sweep(sweep: &Sweep) -> Result<Vec<u8>, RecordError> {
    let invalid = |error: serde_json::Error| RecordError::invalid(FILE, error.to_string());
    Ok((serde_json::to_string(sweep).map_err(invalid)? + "\n").into_bytes())
}

/// Reads the content of `sweep.json`; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`] for anything but axes with values, and points that have one of its values on each axis.
pub fn read_sweep(bytes: &[u8], path: &Path) -> Result<Sweep, RecordError> {
    let sweep: Sweep = serde_json::from_slice(bytes).map_err(|error| RecordError::damaged(path, error.to_string()))?;
    if sweep.axes.is_empty() || sweep.points.is_empty() {
        return Err(RecordError::damaged(path, "a sweep without axes or without points"));
    }
    for (number, point) in sweep.points.iter().enumerate() {
        let known = point.iter().zip(&sweep.axes).all(|(value, axis)| axis.values.contains(value));
        if point.len() != sweep.axes.len() || !known {
            return Err(RecordError::damaged(path, format!("point {number} does not lie on the axes")));
        }
    }
    Ok(sweep)
}
