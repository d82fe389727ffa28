//! What a run's tables say, summed and judged.

use super::claims::{self, Claim};
use super::error::ReportError;
use super::summary::{self, DivergedLearner, Summary};
use super::sweep::SweepResults;
use super::training::{self, TrainingCurve};
use crate::run_folder::{Divergence, FinishedRun, RecordError, tables};
use std::collections::BTreeMap;
use std::path::Path;

/// What tables and figures of learning are made from.
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
}

impl RunResults {
    /// Reads the tables of a run.
    ///
    /// # Errors
    /// If one of them is damaged.
    pub fn read(run: &FinishedRun) -> Result<Self, ReportError> {
        let (names, rows) = table(run, tables::EVALUATIONS, tables::parse_evaluations)?;
        let seeds = &run.manifest().provenance.seeds;
        let summary = summary::summarise(&names, &rows, seeds, &diverged(run)?);
        let swept = run.json()?.map(|sweep| SweepResults::new(sweep, &summary, seeds));
        let summary = if swept.is_some() { summary.first_points() } else { summary };
        let (names, mut rows) = table(run, tables::TRIALS, tables::parse_trials)?;
        if swept.is_some() {
            let shown = |arm: &String| {
                let mut series = summary.skills.iter().flat_map(|skill| &skill.series);
                (arm.clone(), series.find(|series| series.arm == *arm).map(|series| series.point))
            };
            let points: BTreeMap<String, Option<u32>> = names.arms.iter().map(shown).collect();
            rows.retain(|row| points[&row.arm] == Some(row.point));
        }
        let trainings = training::summarise(&summary, &names, &rows);
        let claims = claims::judge(&summary, &trainings);
        Ok(Self { summary, trainings, claims, swept })
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

fn diverged(run: &FinishedRun) -> Result<Vec<DivergedLearner>, RecordError> {
    let told = |Divergence { arm, point, seed, skill, trial, .. }| DivergedLearner { arm, point, seed, skill, trial };
    let failures: Vec<Divergence> = run.json()?.unwrap_or_default();
    Ok(failures.into_iter().map(told).collect())
}
