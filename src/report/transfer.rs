//! What was learned, tested in altered worlds and with other noise, without further training.

use super::comparison::MAIN;
use super::statistics::{mean, mean_of};
use super::summary::{Score, Series, Summary, TransferTest, paired};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Every series that was tested elsewhere, [`MAIN`] first.
pub fn series(summary: &Summary) -> Vec<&Series> {
    let all = summary.skills.iter().flat_map(|skill| &skill.series);
    let mut tested: Vec<&Series> = all.filter(|series| !series.transfer.is_empty()).collect();
    tested.sort_by_key(|series| series.arm != MAIN);
    tested
}

/// Success elsewhere minus success in the circumstances of training, on the same seeds.
pub fn differences(series: &Series, elsewhere: &TransferTest) -> Vec<f64> {
    let (changed, trained) = paired(&elsewhere.scores, &series.last().scores, Score::success);
    changed.iter().zip(&trained).map(|(changed, trained)| changed - trained).collect()
}

/// Rows of the table by arm and alteration.
pub fn table(series: &[&Series]) -> Vec<Value> {
    let row = |series: &Series, test: &TransferTest| {
        let differences = differences(series, test);
        context! {
            arm => &series.label,
            variant => &test.variant,
            success => mean_of(&test.scores.iter().map(Score::success).collect::<Vec<_>>()),
            trained => mean(&series.last().values(Score::success)),
            difference => mean_of(&differences),
            pairs => differences.len(),
        }
    };
    let pairs: Vec<(&Series, &TransferTest)> =
        series.iter().flat_map(|series| series.transfer.iter().map(move |test| (*series, test))).collect();
    pairs.par_iter().map(|(series, test)| row(series, test)).collect()
}

/// What each alteration alters, as the resolved config says it: name and text of each.
pub fn meanings(config: &toml::Table) -> Vec<Vec<String>> {
    let table = config.get("alter").and_then(toml::Value::as_table);
    let bare = |value: &toml::Value| {
        let text = value.to_string();
        text.strip_prefix("{ ").and_then(|text| text.strip_suffix(" }")).unwrap_or(&text).to_owned()
    };
    table.into_iter().flatten().map(|(name, value)| vec![name.clone(), bare(value)]).collect()
}
