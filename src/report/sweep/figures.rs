//! All figures of a sweep: maps of two axes, and what an axis does to all learners, not only to their mean: percentiles,
//! performance profiles, survival curves.

use super::maps;
use super::surface::{AxisLevel, CRITERION, ResponseSurface, SweepResults};
use crate::report::figure::axis::{PlotAxis, range_with_zero};
use crate::report::figure::color::{INK, SKY, VERMILION};
use crate::report::figure::curves::Curve;
use crate::report::figure::svg::Stroke;
use crate::report::figure::{Figure, PlotArea};
use crate::report::format::{file_word, limit, number, seeds};
use crate::report::statistics::{BAND_RESAMPLES, SurvivalCurve, TABLE_RESAMPLES, quantile, sorted};
use crate::report::step_plot::{learner_profile, profile_axes, survival, survival_axes};
use crate::run_folder::sweep::Design;
use rayon::prelude::*;

/// Arms whose figures are drawn; tables hold all.
pub(super) const MOST_ARMS: usize = 4;
/// Pairs of axes that are drawn for an arm.
const MOST_PAIRS: usize = 6;
/// Half of the widest box, in points.
const HALF_BOX: f64 = 22.0;

/// Draws all figures of a sweep: for each arm a map of each pair of axes, then what each axis does to all learners.
pub fn draw(swept: &SweepResults) -> Vec<Figure> {
    let drawn: Vec<&ResponseSurface> = swept.shown().take(MOST_ARMS).collect();
    drawn.into_par_iter().flat_map_iter(of_arm).collect()
}

fn of_arm(surface: &ResponseSurface) -> Vec<Figure> {
    let sweep = &surface.sweep;
    let key = |axis: usize| file_word(&sweep.axes[axis].key);
    let named = |name: String, figure: Figure| Figure {
        name: format!("sweep-{}-{name}", file_word(&surface.arm)),
        section: "sweep",
        about: surface.arm.clone(),
        ..figure
    };
    let axes = &surface.axes;
    let pairs = axes.iter().enumerate().flat_map(|(i, &x)| axes[i + 1..].iter().map(move |&y| (x, y)));
    let pairs: Vec<(usize, usize)> = pairs.take(MOST_PAIRS).collect();
    let name = |(x, y): (usize, usize)| format!("{}-{}", key(x), key(y));
    let mut figures: Vec<Figure> = match sweep.design {
        Design::Random => pairs.iter().map(|&pair| named(name(pair), maps::scatter(surface, pair))).collect(),
        Design::Grid => pairs.iter().map(|&pair| named(name(pair), maps::heatmap(surface, pair))).collect(),
    };
    if let (Some(&first), Design::Grid) = (pairs.first(), sweep.design) {
        let slices = maps::slices(surface, first).into_iter().enumerate();
        figures.extend(slices.map(|(i, figure)| named(format!("{}-slice-{}", name(first), i + 1), figure)));
    }
    let by_axis = |&axis: &usize| {
        let (levels, label) = (surface.levels(axis), &sweep.axes[axis].label);
        let kinds = of_axis(surface, label, &levels).into_iter();
        kinds.map(|(kind, figure)| named(format!("{kind}-{}", key(axis)), figure)).collect::<Vec<_>>()
    };
    figures.par_extend(axes.par_iter().flat_map_iter(by_axis));
    figures
}

/// The figures of an axis, with the kind of each for its file's name; profiles and survival only where success is measured.
fn of_axis(surface: &ResponseSurface, label: &str, levels: &[AxisLevel]) -> Vec<(&'static str, Figure)> {
    let mut figures = vec![("values", percentiles(surface, label, levels))];
    if surface.success {
        let shown = spread_out(levels);
        figures.push(("profile", profiles(surface, label, &shown, levels.len())));
        figures.push(("criterion", survivals(surface, label, &shown, levels.len())));
    }
    figures
}

/// As many levels as curves can be told apart, the first and the last among them.
fn spread_out(levels: &[AxisLevel]) -> Vec<&AxisLevel> {
    let most = PlotArea::SMALL.most_curves();
    if levels.len() <= most {
        return levels.iter().collect();
    }
    (0..most).map(|i| &levels[i * (levels.len() - 1) / (most - 1)]).collect()
}

/// `n = 32 seeds at 4 points per value`, for the levels of an axis.
fn counted<'a>(surface: &ResponseSurface, levels: impl IntoIterator<Item = &'a AxisLevel>) -> String {
    let counts: Vec<usize> = levels.into_iter().map(|level| level.points.len()).collect();
    let seeds = seeds(surface.seeds.len());
    match (counts.iter().min().unwrap_or(&0), counts.iter().max().unwrap_or(&0)) {
        (1, 1) => format!("n = {seeds} per value."),
        (least, most) if least == most => format!("n = {seeds} at {most} points per value."),
        (least, most) => format!("n = {seeds} at {least} to {most} points per value."),
    }
}

/// Percentiles of the learners at each value, and the mean with its interval.
fn percentiles(surface: &ResponseSurface, label: &str, levels: &[AxisLevel]) -> Figure {
    let all = || levels.iter().flat_map(|level| level.learners.iter().copied());
    let range = match surface.success {
        true => (0.0, 1.0),
        false => range_with_zero(all().fold(0.0, f64::min), all().fold(0.0, f64::max)),
    };
    let mut figure = Figure {
        title: format!("{}: by {label}", surface.arm),
        subtitle: format!("Each learner at its last test: {}.", surface.measure()),
        area: PlotArea::SMALL,
        x: PlotAxis::categories(label, levels.iter().map(|level| level.label.clone()).collect()),
        y: PlotAxis::linear(surface.measure(), range, surface.success).with_grid(),
        notes: vec![
            counted(surface, levels),
            "Boxes: 5th, 25th, 50th, 75th and 95th percentile of learners.".to_owned(),
            format!(
                "Dots: mean; bars: its 95% percentile bootstrap interval ({} resamples).",
                number(TABLE_RESAMPLES as f64)
            ),
        ],
        ..Figure::default()
    };
    let half = (HALF_BOX * levels.len() as f64 / figure.area.width).min(0.36);
    let mut means = Vec::new();
    for (i, level) in levels.iter().enumerate() {
        let x = i as f64 + 0.5;
        let learners = sorted(&level.learners);
        let at = |share: f64| quantile(&learners, share);
        figure.rectangle((x - half, at(0.05)), (x + half, at(0.95)), SKY, 0.35);
        figure.rectangle((x - half, at(0.25)), (x + half, at(0.75)), SKY, 0.9);
        figure.line(&[(x - half, at(0.5)), (x + half, at(0.5))], Stroke::solid(INK, 1.5));
        let mean = level.mean();
        figure.line(&[(x, mean.low), (x, mean.high)], Stroke::solid(VERMILION, 2.0));
        means.push((x, mean.value));
    }
    figure.line(&means, Stroke::solid(VERMILION, 1.2));
    means.into_iter().for_each(|at| figure.disc(at, 3.4, VERMILION));
    figure
}

/// Share of learners with more than each success.
fn profiles(surface: &ResponseSurface, label: &str, shown: &[&AxisLevel], all: usize) -> Figure {
    let curve = |level: &&AxisLevel| {
        let of_seed =
            |seed: usize| level.points.iter().map(|&point| surface.points[point].values[seed]).collect::<Vec<f64>>();
        learner_profile(level.label.clone(), &(0..surface.seeds.len()).map(of_seed).collect::<Vec<_>>())
    };
    let bands =
        format!("Bands: 95% percentile bootstrap interval over seeds ({} resamples).", number(BAND_RESAMPLES as f64));
    let figure = Figure {
        title: format!("{}: performance profile by {label}", surface.arm),
        subtitle: "Share of learners whose success at the last test exceeds x.".into(),
        notes: vec![some(surface, shown, all), bands],
        ..profile_axes("learners above")
    };
    figure.with_curves(&shown.iter().map(curve).collect::<Vec<_>>(), None)
}

/// Share of learners that have not reached the criterion yet.
fn survivals(surface: &ResponseSurface, label: &str, shown: &[&AxisLevel], all: usize) -> Figure {
    let seen: Vec<SurvivalCurve> = shown.iter().map(|level| SurvivalCurve::new(&level.seen)).collect();
    let longest = seen.iter().map(|curve| curve.end).fold(1.0, f64::max);
    let curves = shown.iter().zip(&seen).map(|(level, seen)| survival(&level.label, seen, longest));
    let figure = Figure {
        title: format!("{}: trials to criterion by {label}", surface.arm),
        subtitle: format!("Share of learners without a test at {} or more by then.", limit(CRITERION)),
        notes: vec![
            some(surface, shown, all),
            "Kaplan-Meier; bands: 95% log-log intervals, learners taken as independent.".into(),
            "In brackets: learners that got there; the others are censored.".into(),
        ],
        ..survival_axes("not there yet", longest)
    };
    figure.with_curves(&curves.collect::<Vec<Curve>>(), None)
}

/// How many seeds are behind a figure, and how many of the levels it shows.
fn some(surface: &ResponseSurface, shown: &[&AxisLevel], all: usize) -> String {
    let some = if shown.len() < all { format!(" {} of {all} values are shown.", shown.len()) } else { String::new() };
    counted(surface, shown.iter().copied()) + &some
}
