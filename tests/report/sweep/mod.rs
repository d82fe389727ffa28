//! Sweeps made by hand, one of them over a surface with a known optimum.

mod numbers;
mod pages;

use crate::OFFICE;
use skilltree::report::summary::{Summary, summarise};
use skilltree::report::sweep::SweepResults;
use skilltree::run_folder::sweep::{Axis, AxisValue, Design, Scale};
use skilltree::run_folder::tables::write_table;
use skilltree::run_folder::{Divergence, EvaluationRow, JsonFile, Names, Provenance, RunFolder, Sweep};
use std::path::Path;

pub(crate) const COLUMNS: u32 = 6;
pub(crate) const ROWS: u32 = 5;
pub(crate) const SEEDS: u32 = 24;
pub(crate) const TESTS: [u32; 8] = [0, 25, 50, 100, 150, 200, 250, 300];

/// Successes of 40 at the last test: highest at column 2 and row 3, with noise, and every fourth seed is weak.
pub(crate) fn peak(column: u32, row: u32, seed: u32) -> u32 {
    let away = 2 * (i64::from(column) - 2).pow(2) + (i64::from(row) - 3).pow(2);
    let (i, j, s) = (i64::from(column), i64::from(row), i64::from(seed));
    let noise = (s * 7 + i * 13 + j * 29 + (s * s) % 11 * 3) % 19 - 9;
    let weak = if seed % 4 == 3 { 6 } else { 0 };
    (39 - away + noise - weak).clamp(0, 40) as u32
}

/// Rows of a sweep: `last` gives the successes of 40 at the last test of an arm, point and seed, and how many trials
/// half of the learning takes; none where there are no tests.
pub(crate) fn rows(
    arms: u32,
    points: u32,
    seeds: u32,
    last: impl Fn(u32, u32, u32) -> Option<(u32, u32)>,
) -> Vec<EvaluationRow> {
    let mut rows = Vec::new();
    for (arm, point, seed) in
        (0..arms).flat_map(|arm| (0..points).flat_map(move |point| (0..seeds).map(move |seed| (arm, point, seed))))
    {
        let Some((last, slow)) = last(arm, point, seed) else { continue };
        for trials in TESTS {
            let successes = last * trials * (300 + slow) / (300 * (trials + slow));
            let steps = 200 * 40 - 150 * successes;
            rows.push(EvaluationRow {
                arm: ["hierarchical", "monolithic"][arm as usize].to_owned(),
                point,
                seed,
                skill: "recharge".to_owned(),
                trials,
                actions: 100 + 60 * trials,
                variant: "trained".to_owned(),
                room: "A".to_owned(),
                episodes: 40,
                successes,
                steps,
                reward: f64::from(successes),
                r#return: f64::from(successes),
                collisions: 0,
            });
        }
    }
    rows
}

pub(crate) fn names(arms: &[&str]) -> Names {
    let words = |list: &[&str]| list.iter().map(|word| (*word).to_owned()).collect();
    Names { arms: words(arms), skills: words(&["recharge"]), variants: words(&["trained"]), rooms: words(&["A"]) }
}

pub(crate) fn axis(key: &str, label: &str, scale: Scale, values: &[f64]) -> Axis {
    let values = values.iter().map(|value| AxisValue::Number(*value)).collect();
    Axis { key: key.into(), label: label.into(), scale, values }
}

/// All combinations, the last axis fastest.
pub(crate) fn grid(axes: Vec<Axis>) -> Sweep {
    let mut points = vec![Vec::new()];
    for axis in &axes {
        let longer = |point: &Vec<AxisValue>| {
            axis.values.iter().map(|value| point.iter().chain([value]).cloned().collect()).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(longer).collect();
    }
    Sweep { design: Design::Grid, axes, points }
}

pub(crate) fn thresholds() -> Sweep {
    grid(vec![
        axis("skill.recharge.applicable.dock", "dock threshold", Scale::Log, &[0.01, 0.02, 0.05, 0.1, 0.2, 0.5]),
        axis("learning.learning_rate", "rate", Scale::Linear, &[0.1, 0.2, 0.3, 0.4, 0.5]),
    ])
}

/// The arm `hierarchical` on the grid, and `monolithic`, which has none of its keys, at the first point alone.
pub(crate) fn known() -> (Names, Vec<EvaluationRow>) {
    let last = |arm: u32, point: u32, seed: u32| {
        let (column, row) = (point / ROWS, point % ROWS);
        (arm == 0 || point == 0).then(|| (peak(column, row, seed), 20 + 15 * column))
    };
    (names(&["hierarchical", "monolithic"]), rows(2, COLUMNS * ROWS, SEEDS, last))
}

pub(crate) fn summary(names: &Names, rows: &[EvaluationRow], seeds: u32, diverged: &[Divergence]) -> Summary {
    summarise(names, rows, &(0..seeds).collect::<Vec<_>>(), diverged)
}

pub(crate) fn swept() -> SweepResults {
    let (names, rows) = known();
    let seeds: Vec<u32> = (0..SEEDS).collect();
    SweepResults::new(thresholds(), &summary(&names, &rows, SEEDS, &[]), &seeds)
}

pub(crate) fn folder(dir: &Path, sweep: &Sweep, rows: &[EvaluationRow], seeds: u32) {
    let provenance = Provenance { backend: "cpu".into(), seeds: (0..seeds).collect(), ..Provenance::default() };
    let files = [
        ("evaluations.parquet".to_owned(), write_table(rows).unwrap()),
        (Sweep::NAME.to_owned(), sweep.to_bytes().unwrap()),
    ];
    RunFolder::open(dir, "", &[("world.toml", OFFICE)]).unwrap().finish(files, provenance).unwrap();
}
