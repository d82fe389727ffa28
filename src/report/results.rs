//! What a run's tables say, summed and judged.

use super::ReportError;
use super::claims::{self, Claim};
use super::summary::{self, Summary};
use super::training::{self, Training};
use crate::record::{FinishedRun, tables};

/// What tables and figures of learning are made from.
#[derive(Debug)]
pub struct Results {
    /// The tests.
    pub summary: Summary,
    /// The training of the roots.
    pub trainings: Vec<Training>,
    /// The paper's claims.
    pub claims: Vec<Claim>,
}

impl Results {
    /// Reads the tables of a run.
    ///
    /// # Errors
    /// If one of them is damaged.
    pub fn read(run: &FinishedRun) -> Result<Self, ReportError> {
        let (names, rows) = match run.path(tables::EVALUATIONS) {
            Some(path) => tables::read_evaluations(&path)?,
            None => Default::default(),
        };
        let summary = summary::summarise(&names, &rows, &run.manifest().provenance.seeds);
        let (names, rows) = match run.path(tables::TRIALS) {
            Some(path) => tables::read_trials(&path)?,
            None => Default::default(),
        };
        let trainings = training::summarise(&summary, &names, &rows);
        let claims = claims::judge(&summary, &trainings);
        Ok(Self { summary, trainings, claims })
    }
}
