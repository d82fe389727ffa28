//! Reports: figures, tables and one HTML page from a complete run folder, and from nothing else.
//!
//! The same folder always gives the same bytes. Nothing here reaches back into the simulation.

pub mod alterations;
pub mod axes;
pub mod canvas;
pub mod claims;
pub mod comparison;
pub mod curves;
pub mod figure2;
pub mod figures;
pub mod floor;
pub mod gallery;
pub mod numbers;
pub mod page;
pub mod raster;
pub mod resample;
pub mod results;
pub mod rooms;
pub mod stairs;
pub mod statistics;
pub mod summary;
pub mod sweep;
pub mod text;
pub mod trace;
pub mod training;

use crate::config::ConfigError;
use crate::run_folder::file_system::{Disk, FileSystem};
use crate::run_folder::{FinishedRun, RecordError, folder, writer};
use rayon::prelude::*;
use results::Results;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// File name of the page.
pub const PAGE: &str = "report.html";
const FIGURES: &str = "figures";

/// An error in making a report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The run folder cannot be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run folder's floor plan cannot be read: another version of skilltree made the run.
    #[error("{0}\nnote: the run was made by another version of skilltree: use that one")]
    World(#[from] ConfigError),
    /// A figure could not be turned into PNG.
    #[error("a figure could not be drawn: {0}\nhint: this is a bug in skilltree: please report it")]
    Drawing(String),
    /// The page's template failed.
    #[error("the page could not be written: {0}\nhint: this is a bug in skilltree: please report it")]
    Page(String),
}

/// Writes `figures/*.svg`, `figures/*.png` and `report.html` into a complete run folder and returns their paths.
///
/// # Errors
/// If the folder is not a complete run, in use, damaged or not writable. Each file is written whole or not at all.
pub fn write(dir: &Path) -> Result<Vec<PathBuf>, ReportError> {
    write_on(Arc::new(FileSystem), dir)
}

/// As [`write()`], on a disk of the caller's.
///
/// # Errors
/// As [`write()`].
pub fn write_on(disk: Arc<dyn Disk>, dir: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let run = FinishedRun::read_on(Arc::clone(&disk), dir)?;
    let _lock = folder::lock(&*disk, dir)?;
    let results = Results::read(&run)?;
    let drawings = gallery::draw(&run, &results)?;
    let page = page::render(&run, &results, &drawings)?;

    let folder = dir.join(FIGURES);
    writer::make_folder(&*disk, &folder)?;
    for folder in [dir, &folder] {
        writer::remove_leftovers(&*disk, folder)?;
    }
    let mut written = Vec::new();
    let images: Result<Vec<_>, _> = drawings.par_iter().map(|figure| raster::png(&figure.svg)).collect();
    for (figure, image) in drawings.iter().zip(images?) {
        for (ending, bytes) in [("svg", figure.svg.as_bytes()), ("png", image.as_slice())] {
            let path = folder.join(format!("{}.{ending}", figure.name));
            writer::place(&*disk, &path, bytes)?;
            written.push(path);
        }
    }
    writer::sync_folder(&*disk, &folder)?;
    let path = dir.join(PAGE);
    writer::write(&*disk, &path, page.as_bytes())?;
    written.push(path);
    Ok(written)
}

/// The summary of a complete run as text for a terminal.
///
/// # Errors
/// If the folder is not a complete run or is damaged.
pub fn text(dir: &Path) -> Result<String, ReportError> {
    let results = Results::read(&FinishedRun::read(dir)?)?;
    let mut text = text::table(&results.summary, &results.claims);
    if let Some(swept) = &results.swept {
        text.push_str(&sweep::lines(swept, dir));
    }
    Ok(text)
}
