//! `sweep.json`: the axes of a sweep, and the value on each of them at every point.
//!
//! The column `point` of the tables indexes [`Sweep::points`]. A run without a sweep has no such file, and its only
//! point is 0.

pub use crate::config::plan::{Axis, AxisValue, Design, Scale, Sweep};

use super::{RecordError, json};
use std::path::Path;

/// The file's name in a run folder.
pub const FILE: &str = "sweep.json";

/// JSON text of `sweep.json`.
///
/// # Errors
/// [`RecordError::Invalid`] if a number has no JSON form.
pub fn write_sweep(sweep: &Sweep) -> Result<Vec<u8>, RecordError> {
    json::write(FILE, sweep, false)
}

/// Reads the content of `sweep.json`; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`] for anything but axes with values, and points that have one of its values on each axis.
pub fn read_sweep(bytes: &[u8], path: &Path) -> Result<Sweep, RecordError> {
    let sweep: Sweep = json::read(bytes, path)?;
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
