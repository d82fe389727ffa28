//! What was learned, tested in altered worlds and with other noise, without further training.

use super::comparison::MAIN;
use super::numbers::{percent, percent_with, points_with};
use super::statistics::{TABLE_RESAMPLES, bootstrap, mean};
use super::summary::{Altered, Score, Series, Summary, paired};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Every series that was tested under alterations, [`MAIN`] first.
pub fn series(summary: &Summary) -> Vec<&Series> {
    let all = summary.skills.iter().flat_map(|skill| &skill.series);
    let mut altered: Vec<&Series> = all.filter(|series| !series.altered.is_empty()).collect();
    altered.sort_by_key(|series| series.arm != MAIN);
    altered
}

/// Success under an alteration minus success in the circumstances of training, on the same seeds.
pub fn differences(series: &Series, altered: &Altered) -> Vec<f64> {
    let (changed, trained) = paired(&altered.scores, &series.last().scores, Score::success);
    changed.iter().zip(&trained).map(|(changed, trained)| changed - trained).collect()
}

/// Rows of the table by arm and alteration.
pub fn table(series: &[&Series]) -> Vec<Value> {
    let pairs: Vec<(&Series, &Altered)> =
        series.iter().flat_map(|series| series.altered.iter().map(move |altered| (*series, altered))).collect();
    pairs.into_par_iter().map(|(series, altered)| row(series, altered)).collect()
}

fn row(series: &Series, altered: &Altered) -> Value {
    let success: Vec<f64> = altered.scores.iter().map(Score::success).collect();
    let differences = differences(series, altered);
    context! {
        arm => series.label.as_str(),
        variant => altered.variant.as_str(),
        success => percent_with(mean(&success), bootstrap(&success, mean, TABLE_RESAMPLES)),
        trained => percent(mean(&series.last().values(Score::success))),
        difference => points_with(mean(&differences), bootstrap(&differences, mean, TABLE_RESAMPLES)),
        pairs => differences.len(),
    }
}

/// What each alteration alters, as the resolved config says it.
pub fn meanings(config: &toml::Table) -> Vec<(String, String)> {
    let table = config.get("alter").and_then(toml::Value::as_table);
    let bare = |value: &toml::Value| {
        let text = value.to_string();
        text.strip_prefix("{ ").and_then(|text| text.strip_suffix(" }")).unwrap_or(&text).to_owned()
    };
    table.into_iter().flatten().map(|(name, value)| (name.clone(), bare(value))).collect()
}
