//! The paper's Figure 2: average reinforcement per primitive step against trials, without and with a hierarchy; and the
//! same learning against executed actions.

use super::comparison::Comparison;
use super::figure::curves::{Curve, CurvePoint, axes};
use super::figure::{Figure, PlotArea};
use super::format::seeds;
use super::learning_curves::{CurveMeasure, SUCCESS};
use super::statistics::{BAND_RESAMPLES, Estimate, TABLE_RESAMPLES, mean, ratio};
use super::summary::{Score, SeedScores, Series};
use super::training::{TrainingCurve, TrainingWindow, WINDOW, of_series, pooled};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Runs behind each curve of the paper.
pub const PAPER_SEEDS: usize = 7;
/// Last trials that the table of averages also shows alone; a multiple of [`WINDOW`].
const LATE: u32 = 50;
const Y_TITLE: &str = "reinforcement per step";
const MOST: usize = 7;

/// The panels with the paper's number of seeds, then those with all.
pub fn draw(comparison: &Comparison<'_>, trainings: &[TrainingCurve]) -> Vec<Figure> {
    let kinds = [&comparison.monolithic, &comparison.hierarchical].map(Vec::as_slice);
    let as_paper = kinds.map(|kind| kind.first().map_or_else(Vec::new, |series| as_in_the_paper(series, trainings)));
    let all = kinds.map(|kind| {
        let shown: Vec<_> = kind.iter().filter_map(|series| of_series(trainings, series)).take(MOST).collect();
        shown.into_par_iter().map(with_band).collect::<Vec<_>>()
    });
    let mut figures = Vec::new();
    for (section, panels) in [("paper", as_paper), ("all seeds", all)] {
        // Both panels have the same axes, so that they can be compared.
        let (x, y) = axes(panels.iter().flatten(), None, ("trials", Y_TITLE), false);
        for (panel, curves) in panels.iter().enumerate().filter(|(_, curves)| !curves.is_empty()) {
            let few = section == "paper";
            let n = kinds[panel].first().map_or(0, |series| series.last().scores.len());
            let mut notes = vec![match few {
                true => format!("Mean over the first n = {}; no interval.", seeds(PAPER_SEEDS.min(n))),
                false => format!("Sums over n = {}; bands: 95% percentile bootstrap interval.", seeds(n)),
            }];
            let trained = kinds[panel].iter().filter(|series| of_series(trainings, series).is_some()).count();
            if !few && trained > MOST {
                notes.push(format!("The first {MOST} of {trained} arms with training trials."));
            }
            let figure = Figure {
                name: format!("figure-2{}{}", ["a", "b"][panel], if few { "-paper" } else { "" }),
                section,
                title: ["(a) without a hierarchy", "(b) with a hierarchy"][panel].into(),
                subtitle: format!("Training: reward over steps of the last {WINDOW} trials."),
                area: PlotArea::SMALL,
                x: x.clone(),
                y: y.clone(),
                notes,
                ..Figure::default()
            };
            figures.push(figure.with_curves(curves, None));
        }
    }
    figures
}

/// Rows of the table that holds the two averages which Figure 2 may mean: reward over steps of all trials together, and
/// reward over steps of each trial.
pub fn averages(comparison: &Comparison<'_>, trainings: &[TrainingCurve]) -> Vec<Value> {
    let trained = comparison.leaders().filter_map(|series| of_series(trainings, series));
    let spans = trained.flat_map(|training| {
        let end = training.trials();
        let late = (end > LATE).then(|| (training, end - LATE));
        [Some((training, 0)), late].into_iter().flatten()
    });
    let row = |(training, from): (&TrainingCurve, u32)| {
        let sums = training.sums_by_seed(from);
        context! {
            arm => &training.arm,
            trials => format!("{} to {}", from + 1, training.trials()),
            seeds => sums.len(),
            together => pooled(&sums, Score::reward_and_steps, TABLE_RESAMPLES),
            apart => pooled(&sums, Score::ratios_and_trials, TABLE_RESAMPLES),
        }
    };
    spans.map(row).collect()
}

/// Training and tests of an arm's first seeds, without bands.
fn as_in_the_paper(series: &Series, trainings: &[TrainingCurve]) -> Vec<Curve> {
    let first: Vec<u32> = series.last().scores.iter().take(PAPER_SEEDS).map(|score| score.seed).collect();
    let point = |x: u32, y: f64| CurvePoint { x: f64::from(x), y: Estimate::exact(y) };
    let window = |window: &TrainingWindow| {
        let shown = window.sums.iter().filter(|sums| first.contains(&sums.seed));
        point(window.end, ratio(&shown.map(Score::reward_and_steps).collect::<Vec<_>>()))
    };
    let test = |test: &SeedScores| point(test.trials, mean(&test.values(Score::reward_per_step)[..first.len()]));
    let training = of_series(trainings, series).map(|training| training.windows.iter().map(window).collect());
    let training = Curve::new("training trials", training.unwrap_or_default());
    let tests = Curve::new("greedy tests", series.tests.iter().map(test).collect());
    [training, tests].into_iter().filter(|curve| !curve.points.is_empty()).collect()
}

fn with_band(training: &TrainingCurve) -> Curve {
    let point = |window: &TrainingWindow| CurvePoint {
        x: f64::from(window.end),
        y: pooled(&window.sums, Score::reward_and_steps, BAND_RESAMPLES),
    };
    Curve::new(&training.arm, training.windows.iter().map(point).collect())
}

/// Success and reinforcement of the tests, over trials and over actions: the main arm and the monolithic ones.
pub fn equal_cost(comparison: &Comparison<'_>) -> Vec<Figure> {
    if comparison.monolithic.is_empty() {
        return Vec::new();
    }
    let success = CurveMeasure { file: "success", ..SUCCESS };
    let reinforcement = CurveMeasure {
        file: "reinforcement",
        subtitle: "Reward per primitive step of greedy test trials.",
        y_title: Y_TITLE,
        percent: false,
        value: Score::reward_per_step,
        ..SUCCESS
    };
    let measures = [success, reinforcement].into_iter().flat_map(|measure| {
        [("by trials: unfair", false), ("by executed actions: equal cost", true)]
            .map(|(heading, against_actions)| CurveMeasure { heading, against_actions, ..measure })
    });
    let measures: Vec<_> = measures.collect();
    measures.par_iter().map(|measure| over_cost(comparison, measure)).collect()
}

/// What a series is paid for a success, if it is paid for nothing else.
fn pay(series: &Series) -> Option<f64> {
    let scores = || series.tests.iter().flat_map(|test| &test.scores);
    let amount = scores().find(|score| score.successes > 0).map_or(0.0, |score| score.reward / score.successes as f64);
    scores().all(|score| score.reward == amount * score.successes as f64).then_some(amount)
}

/// Whether two series' rewards can be drawn on one axis: punishment would stretch it.
fn comparable(series: &Series, other: &Series) -> bool {
    pay(other).is_none() || pay(series).is_some_and(|amount| amount == 0.0 || Some(amount) == pay(other))
}

fn over_cost(comparison: &Comparison<'_>, measure: &CurveMeasure) -> Figure {
    let main = comparison.hierarchical[0];
    let shown = std::iter::once(&main).chain(&comparison.monolithic).take(MOST);
    let drawn = shown.filter(|series| measure.percent || comparable(series, main));
    let curves: Vec<Curve> = drawn.map(|series| measure.curve(series, series.label.clone())).collect();
    let n = seeds(main.last().scores.len());
    let mut notes = vec![format!("Mean over n = {n}; bands: 95% percentile bootstrap interval.")];
    let all = comparison.monolithic.len() + 1;
    if all > curves.len() {
        let why = if measure.percent { "" } else { "; arms that are punished are left out" };
        notes.push(format!("{} of {all} arms{why}.", curves.len()));
    }
    let bound = comparison.skill.bound(&main.arm).map(|bound| (measure.value)(&bound.score));
    let (x, y) = axes(&curves, bound, (measure.x_title(), measure.y_title), measure.percent);
    let figure = Figure {
        name: format!("{}-by-{}", measure.file, if measure.against_actions { "actions" } else { "trials" }),
        section: "equal cost",
        title: format!("{} {}", if measure.percent { "Success" } else { "Reinforcement" }, measure.heading),
        subtitle: measure.subtitle.into(),
        area: PlotArea::SMALL,
        x,
        y,
        notes,
        ..Figure::default()
    };
    figure.with_curves(&curves, bound)
}
