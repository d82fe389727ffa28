//! The paper's Figure 2: average reinforcement per primitive step against trials, without and with a hierarchy; and the
//! same learning against executed actions.

use super::comparison::Comparison;
use super::curves::{self, Curve, Ends, Figure, MOST_SMALL, Point};
use super::figures::{Drawing, Measure, SUCCESS, Section, curve};
use super::numbers::{seeds, with};
use super::statistics::{BAND_RESAMPLES, Interval, TABLE_RESAMPLES, mean};
use super::summary::{Cell, Score, Series};
use super::training::{self, Tally, Training, WINDOW, Window, pooled};
use minijinja::{Value, context};
use rayon::prelude::*;

/// Runs behind each curve of the paper.
pub const PAPER_SEEDS: usize = 7;
/// Last trials that the table of averages also shows alone; a multiple of [`WINDOW`].
const LATE: u32 = 50;
const Y_TITLE: &str = "reinforcement per step";

/// The panels with the paper's number of seeds, then those with all.
pub fn draw(comparison: &Comparison<'_>, trainings: &[Training]) -> Vec<Drawing> {
    let kinds = [&comparison.monolithic, &comparison.hierarchical].map(Vec::as_slice);
    let headings = ["(a) without a hierarchy", "(b) with a hierarchy"];
    let as_paper = kinds.map(|kind| kind.first().map_or_else(Vec::new, |series| as_in_the_paper(series, trainings)));
    let all = kinds.map(|kind| {
        let shown: Vec<_> = kind.iter().filter_map(|series| training::of(trainings, series)).take(MOST_SMALL).collect();
        shown.into_par_iter().map(with_band).collect::<Vec<_>>()
    });
    let mut drawings = Vec::new();
    for (section, curves) in [(Section::Paper, as_paper), (Section::All, all)] {
        let ends = Ends::of(curves.iter().flatten(), false);
        for (panel, curves) in curves.into_iter().enumerate().filter(|(_, curves)| !curves.is_empty()) {
            let few = section == Section::Paper;
            let trained = kinds[panel].iter().filter(|series| training::of(trainings, series).is_some()).count();
            let mut notes = vec![match few {
                true => {
                    format!("Mean over the first n = {}; no interval.", seeds(PAPER_SEEDS.min(count(kinds[panel]))))
                }
                false => {
                    format!("Sums over n = {}; bands: 95% percentile bootstrap interval.", seeds(count(kinds[panel])))
                }
            }];
            if !few && trained > MOST_SMALL {
                notes.push(format!("The first {MOST_SMALL} of {trained} arms with training trials."));
            }
            let figure = Figure {
                title: headings[panel].to_owned(),
                subtitle: format!("Training: reward over steps of the last {WINDOW} trials."),
                notes,
                x_title: "trials".into(),
                y_title: Y_TITLE.into(),
                percent: false,
                bound: None,
                curves,
                small: true,
                ends: Some(ends),
            };
            let name = format!("figure-2{}{}", ["a", "b"][panel], if few { "-paper" } else { "" });
            drawings.push(Drawing { name, section: section.clone(), svg: curves::draw(&figure) });
        }
    }
    drawings
}

/// Rows of the table that holds the two averages which Figure 2 may mean: reward over steps of all trials together, and
/// reward over steps of each trial.
pub fn averages(comparison: &Comparison<'_>, trainings: &[Training]) -> Vec<Value> {
    let trained = comparison.leaders().filter_map(|series| training::of(trainings, series));
    let spans = trained.flat_map(|training| {
        let end = training.trials();
        let late = (end > LATE).then(|| (training, end - LATE));
        [Some((training, 0)), late].into_iter().flatten()
    });
    let row = |(training, from): (&Training, u32)| {
        let tallies = training.tallies(from);
        let average = |of| {
            let (mean, interval) = pooled(&tallies, of, TABLE_RESAMPLES);
            with(mean, interval, 3)
        };
        context! {
            arm => training.arm.as_str(),
            trials => format!("{} to {}", from + 1, training.trials()),
            seeds => tallies.len(),
            together => average(Tally::reward_and_steps),
            apart => average(Tally::ratios_and_trials),
        }
    };
    spans.map(row).collect()
}

fn count(series: &[&Series]) -> usize {
    series.first().map_or(0, |series| series.last().scores.len())
}

/// Training and tests of an arm's first seeds, without bands.
fn as_in_the_paper(series: &Series, trainings: &[Training]) -> Vec<Curve> {
    let first: Vec<u32> = series.last().scores.iter().take(PAPER_SEEDS).map(|score| score.seed).collect();
    let bare = |x: u32, y: f64| Point { x: f64::from(x), y, band: Interval { low: y, high: y } };
    let window = |window: &Window| {
        let tallies: Vec<Tally> = window.tallies.iter().filter(|tally| first.contains(&tally.seed)).copied().collect();
        bare(window.end, pooled(&tallies, Tally::reward_and_steps, 0).0)
    };
    let test = |cell: &Cell| bare(cell.trials, mean(&cell.values(Score::reward_per_step)[..first.len()]));
    let training = training::of(trainings, series);
    let training = training.map(|training| training.windows.iter().map(window).collect::<Vec<_>>());
    let curves =
        [("training trials", training.unwrap_or_default()), ("greedy tests", series.cells.iter().map(test).collect())];
    curves
        .into_iter()
        .filter(|(_, points)| !points.is_empty())
        .map(|(label, points)| Curve { label: label.into(), points })
        .collect()
}

fn with_band(training: &Training) -> Curve {
    let point = |window: &Window| {
        let (y, band) = pooled(&window.tallies, Tally::reward_and_steps, BAND_RESAMPLES);
        Point { x: f64::from(window.end), y, band }
    };
    Curve { label: training.arm.clone(), points: training.windows.iter().map(point).collect() }
}

/// Success and reinforcement of the tests, over trials and over actions: [`MAIN`](super::comparison::MAIN) and the
/// monolithic arms.
pub fn budget(comparison: &Comparison<'_>) -> Vec<Drawing> {
    let main = comparison.hierarchical.iter().take(1);
    let shown: Vec<&Series> = main.chain(&comparison.monolithic).take(MOST_SMALL).copied().collect();
    if comparison.monolithic.is_empty() {
        return Vec::new();
    }
    let reinforcement = Measure {
        file: "reinforcement",
        subtitle: "Reward per primitive step of greedy test trials.",
        y_title: Y_TITLE,
        percent: false,
        value: Score::reward_per_step,
        ..SUCCESS
    };
    let success = Measure { file: "success", ..SUCCESS };
    let pairs = [success, reinforcement].into_iter().flat_map(|measure| {
        [false, true].map(|against_actions| {
            let heading = if against_actions { "by executed actions: equal cost" } else { "by trials: unfair" };
            Measure { heading, against_actions, ..measure }
        })
    });
    pairs.collect::<Vec<_>>().into_par_iter().map(|measure| draw_budget(comparison, &shown, &measure)).collect()
}

/// What a series is paid for a success, if it is paid for nothing else.
fn pay(series: &Series) -> Option<f64> {
    let scores = || series.cells.iter().flat_map(|cell| &cell.scores);
    let amount = scores().find(|score| score.successes > 0).map_or(0.0, |score| score.reward / score.successes as f64);
    scores().all(|score| score.reward == amount * score.successes as f64).then_some(amount)
}

/// Whether two series' rewards can be drawn on one axis: punishment would stretch it.
fn comparable(series: &Series, other: &Series) -> bool {
    pay(other).is_none() || pay(series).is_some_and(|amount| amount == 0.0 || Some(amount) == pay(other))
}

fn draw_budget(comparison: &Comparison<'_>, shown: &[&Series], measure: &Measure) -> Drawing {
    let drawn = shown.iter().filter(|series| measure.percent || comparable(series, shown[0]));
    let curves: Vec<Curve> = drawn.map(|series| curve(series, measure)).collect();
    let of = if measure.percent { "Success" } else { "Reinforcement" };
    let mut notes = vec![format!("Mean over n = {}; bands: 95% percentile bootstrap interval.", seeds(count(shown)))];
    let all = comparison.monolithic.len() + 1;
    if all > curves.len() {
        let why = if measure.percent { "" } else { "; arms that are punished are left out" };
        notes.push(format!("{} of {all} arms{why}.", curves.len()));
    }
    let bound = comparison.skill.bound(&shown[0].arm);
    let figure = Figure {
        title: format!("{of} {}", measure.heading),
        subtitle: measure.subtitle.into(),
        notes,
        x_title: if measure.against_actions { "executed actions" } else { "training trials" }.into(),
        y_title: measure.y_title.into(),
        percent: measure.percent,
        bound: bound.map(|bound| ("planner (bound)".into(), (measure.value)(&bound.score))),
        ends: None,
        curves,
        small: true,
    };
    let against = if measure.against_actions { "actions" } else { "trials" };
    Drawing { name: format!("{}-by-{against}", measure.file), section: Section::Budget, svg: curves::draw(&figure) }
}
