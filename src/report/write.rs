//! Makes the report of a run, and writes it into the run's folder.

use super::comparison::Comparison;
use super::figure::{Figure, render_svg};
use super::page::{self, DrawnFigure};
use super::results::{ReportError, RunResults};
use super::{figure2, floor_plan, learning_curves, rooms, sweep, trajectory_plot};
use crate::run_folder::file_system::{FileSystem, OsFileSystem};
use crate::run_folder::{FinishedRun, folder, writer};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// File name of the page.
pub const PAGE: &str = "report.html";
const FIGURES: &str = "figures";

/// A report before it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct RenderedReport {
    /// In the order of the page.
    pub figures: Vec<DrawnFigure>,
    /// The HTML page, with all figures in it.
    pub page: String,
    /// A summary for a terminal.
    pub summary: String,
}

/// A report that has been written.
#[derive(Debug, Clone, PartialEq)]
pub struct WrittenReport {
    /// Paths of the figures, then of the page.
    pub files: Vec<PathBuf>,
    /// A summary for a terminal.
    pub summary: String,
}

/// Makes the report of a complete run, in memory.
///
/// # Errors
/// If a file of the run is damaged.
pub fn render(run: &FinishedRun) -> Result<RenderedReport, ReportError> {
    let results = RunResults::read(run)?;
    let drawn = |figure: Figure| {
        let svg = render_svg(&figure);
        DrawnFigure { name: figure.name, section: figure.section, about: figure.about, svg }
    };
    let figures: Vec<DrawnFigure> = draw(&results).into_par_iter().map(drawn).collect();
    let (page, summary) = page::render(run, &results, &figures)?;
    Ok(RenderedReport { figures, page, summary })
}

/// Draws everything that a run has figures for, in the order of the page.
fn draw(results: &RunResults) -> Vec<Figure> {
    let RunResults { summary, worlds, .. } = results;
    let mut figures = results.swept.as_ref().map_or_else(Vec::new, sweep::draw);
    if let Some(comparison) = Comparison::new(summary) {
        figures.extend(figure2::draw(&comparison, &results.trainings));
        figures.extend(figure2::equal_cost(&comparison));
        figures.extend(rooms::draw(&comparison, &rooms::of(&comparison, &summary.rooms)));
        let leaders: Vec<&str> = comparison.leaders().map(|series| series.arm.as_str()).collect();
        figures.extend(trajectory_plot::draw_some(worlds, &results.trajectories, &leaders));
    }
    figures.extend(learning_curves::draw(summary));
    for (file, world) in worlds {
        match file == folder::WORLD {
            true => figures.extend(floor_plan::draw_all(world, &results.places)),
            false => figures.push(floor_plan::draw_elsewhere(world, file)),
        }
    }
    figures
}

/// Writes `figures/*.svg` and `report.html` into a complete run folder.
///
/// # Errors
/// If the folder is not a complete run, in use, damaged or not writable. Each file is written whole or not at all.
pub fn write(dir: &Path) -> Result<WrittenReport, ReportError> {
    write_on(Arc::new(OsFileSystem), dir)
}

/// As [`write()`], on a disk of the caller's.
///
/// # Errors
/// As [`write()`].
pub fn write_on(disk: Arc<dyn FileSystem>, dir: &Path) -> Result<WrittenReport, ReportError> {
    let run = FinishedRun::read_on(Arc::clone(&disk), dir)?;
    let _lock = folder::lock(&*disk, dir)?;
    let RenderedReport { figures, page, summary } = render(&run)?;
    let folder = dir.join(FIGURES);
    writer::make_folder(&*disk, &folder)?;
    for folder in [dir, &folder] {
        writer::remove_leftovers(&*disk, folder)?;
    }
    let mut files = Vec::new();
    for figure in figures {
        let path = folder.join(format!("{}.svg", figure.name));
        writer::place(&*disk, &path, figure.svg.as_bytes())?;
        files.push(path);
    }
    writer::sync_folder(&*disk, &folder)?;
    let path = dir.join(PAGE);
    writer::write(&*disk, &path, page.as_bytes())?;
    files.push(path);
    Ok(WrittenReport { files, summary })
}
