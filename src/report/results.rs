//! What a run holds, read, summed and judged.

use super::claims::{self, Claim};
use super::summary::{self, Summary};
use super::sweep::SweepResults;
use super::training::{self, TrainingCurve};
use crate::config::ConfigError;
use crate::run_folder::{Divergence, FinishedRun, PlaceReading, RecordError, Trajectory, folder};
use crate::world::{World, load};
use std::collections::BTreeMap;

/// An error in making a report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The run folder cannot be read or written.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The run folder's floor plan cannot be read: another version of skilltree made the run.
    #[error("{0}\nnote: the run was made by another version of skilltree: use that one")]
    World(#[from] ConfigError),
    /// A template failed.
    #[error("the page could not be written: {0:#}\nhint: this is a bug in skilltree: please report it")]
    Page(#[from] minijinja::Error),
}

/// What tables and figures are made from.
#[derive(Debug)]
pub struct RunResults {
    /// The tests; of a run with a sweep, those of each arm's first point.
    pub summary: Summary,
    /// The training of the roots.
    pub trainings: Vec<TrainingCurve>,
    /// The paper's claims.
    pub claims: Vec<Claim>,
    /// What a sweep measured at all points.
    pub swept: Option<SweepResults>,
    /// Floor plans by file: the config's own, and those of other arms and alterations.
    pub worlds: BTreeMap<String, World>,
    /// Example trials.
    pub trajectories: Vec<Trajectory>,
    /// What the sensors read at the named places.
    pub places: Vec<PlaceReading>,
}

impl RunResults {
    /// Reads the files of a run.
    ///
    /// # Errors
    /// If one of them is damaged or, as a floor plan, of another version of skilltree.
    pub fn read(run: &FinishedRun) -> Result<Self, ReportError> {
        let (names, rows) = run.evaluations()?;
        let seeds = &run.manifest().provenance.seeds;
        let failures: Vec<Divergence> = run.json()?.unwrap_or_default();
        let mut summary = summary::summarise(&names, &rows, seeds, &failures);
        let swept = run.json()?.map(|sweep| SweepResults::new(sweep, &summary, seeds));
        let (names, mut rows) = run.trials()?;
        if swept.is_some() {
            summary = summary.first_points();
            let first = |arm: &str| {
                let mut series = summary.skills.iter().flat_map(|skill| &skill.series);
                series.find(|series| series.arm == arm).map(|series| series.point)
            };
            rows.retain(|row| first(&row.arm) == Some(row.point));
        }
        let trainings = training::summarise(&summary, &names, &rows);
        let mut worlds = BTreeMap::new();
        let is_world = |file: &&String| *file == folder::WORLD || file.starts_with("worlds/");
        for file in run.manifest().files.keys().filter(is_world) {
            let text = run.text(file)?.unwrap_or_default();
            worlds.insert(file.clone(), load::parse(&text, &run.dir().join(file))?);
        }
        Ok(Self {
            claims: claims::judge(&summary, &trainings),
            trajectories: run.json()?.unwrap_or_default(),
            places: run.json()?.unwrap_or_default(),
            summary,
            trainings,
            swept,
            worlds,
        })
    }
}
