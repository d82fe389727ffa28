//! `sweep.json`: the axes of a sweep, and the value on each of them at every point.
//!
//! The column `point` of the tables indexes [`Sweep::points`]. A run without a sweep has no such file, and its only
//! point is 0.

pub use crate::config::plan::{Axis, AxisValue, Design, Scale, Sweep};

use super::json::JsonFile;

impl JsonFile for Sweep {
    const NAME: &'static str = "sweep.json";
    const PRETTY: bool = false;

    fn problem(&self) -> Option<String> {
        if self.axes.is_empty() || self.points.is_empty() {
            return Some("a sweep without axes or without points".to_owned());
        }
        let on_axes = |point: &Vec<AxisValue>| {
            point.len() == self.axes.len()
                && point.iter().zip(&self.axes).all(|(value, axis)| axis.values.contains(value))
        };
        let number = self.points.iter().position(|point| !on_axes(point))?;
        Some(format!("point {number} does not lie on the axes"))
    }
}
