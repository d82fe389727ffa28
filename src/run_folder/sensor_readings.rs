//! `places.json`: what the sensors read at the world's named places, without noise.

use super::{RecordError, json};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The file's name in a run folder.
pub const FILE: &str = "places.json";

/// One reading of the sensors at a named place. Keys that are not listed here are allowed and ignored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlaceReading {
    /// The place's name in the world file.
    pub place: String,
    /// Inches to the right.
    pub x: f32,
    /// Inches up.
    pub y: f32,
    /// Degrees, 0 = east, counter-clockwise.
    pub heading: f32,
    /// Distances in inches from the robot's centre; index 0 straight ahead, then counter-clockwise every 15 degrees.
    pub sonar: [u32; 24],
    /// 1 where the light is seen, in the same order.
    pub light: [u8; 24],
}

/// JSON text of `places.json`.
///
/// # Errors
/// [`RecordError::Invalid`] if a number has no JSON form.
pub fn write_places(readings: &[PlaceReading]) -> Result<Vec<u8>, RecordError> {
    json::write(FILE, &readings, true)
}

/// Reads the content of `places.json`; `path` is only for messages.
///
/// # Errors
/// [`RecordError::Damaged`] for anything but an array of readings with finite poses.
pub fn read_places(bytes: &[u8], path: &Path) -> Result<Vec<PlaceReading>, RecordError> {
    let readings: Vec<PlaceReading> = json::read(bytes, path)?;
    match readings.iter().find(|r| !(r.x.is_finite() && r.y.is_finite() && r.heading.is_finite())) {
        Some(reading) => Err(RecordError::damaged(path, format!("the pose of `{}` is not finite", reading.place))),
        None => Ok(readings),
    }
}
