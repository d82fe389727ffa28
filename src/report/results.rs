//! What a run's tables say, summed and judged.

use super::ReportError;
use super::claims::{self, Claim};
use super::summary::{self, Summary};
use super::training::{self, Training};
use crate::record::{FinishedRun, RecordError, tables};
use std::path::Path;

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
        let (names, rows) = table(run, tables::EVALUATIONS, tables::parse_evaluations)?;
        let summary = summary::summarise(&names, &rows, &run.manifest().provenance.seeds);
        let (names, rows) = table(run, tables::TRIALS, tables::parse_trials)?;
        let trainings = training::summarise(&summary, &names, &rows);
        let claims = claims::judge(&summary, &trainings);
        Ok(Self { summary, trainings, claims })
    }
}

/// A table that a run may lack.
fn table<T: Default>(
    run: &FinishedRun,
    file: &str,
    parse: impl Fn(Vec<u8>, &Path) -> Result<T, RecordError>,
) -> Result<T, ReportError> {
    let Some(bytes) = run.content(file)? else { return Ok(T::default()) };
    Ok(parse(bytes, &run.dir().join(file))?)
}
