//! What each axis does to all learners, not only to their mean: percentiles, performance profiles, survival curves.

use super::levels::{Level, levels};
use super::plane::every;
use super::surface::{CRITERION, Surface};
use super::words;
use crate::report::axes::{self, lower_end, ticks, upper_end};
use crate::report::canvas::{Anchor, Canvas, GREY, INK, PALE};
use crate::report::curves::{COLORS, MOST_SMALL};
use crate::report::figures::{Drawing, Section, file_word};
use crate::report::numbers::{limit, number, seeds};
use crate::report::stairs::{self, Stair, Staircase};
use crate::report::statistics::{BAND_RESAMPLES, Survival, TABLE_RESAMPLES, bootstrap, mean, quantile, sorted};
use crate::run_folder::Sweep;
use rayon::prelude::*;

/// Limits of a performance profile.
const LIMITS: usize = 50;
/// Share of the trials by which a survival curve is drawn on.
const BEYOND: f64 = 0.04;
/// The figure's size and the plot within it.
const WIDTH: f64 = 470.0;
const HEIGHT: f64 = 424.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 454.0;
const TOP: f64 = 62.0;
const BOTTOM: f64 = 322.0;

/// Three figures for each axis on which the arm's points differ; survival only where success is measured.
pub(super) fn draw(sweep: &Sweep, surface: &Surface) -> Vec<Drawing> {
    let figures = |&axis: &usize| {
        let levels = levels(sweep, surface, axis);
        let label = &sweep.axes[axis].label;
        let drawing = |kind: &str, svg: String| {
            let name = format!("sweep-{}-{kind}-{}", file_word(&surface.arm), file_word(&sweep.axes[axis].key));
            Drawing { name, section: Section::Sweep(surface.arm.clone()), svg }
        };
        let mut drawings = vec![drawing("values", percentiles(surface, label, &levels))];
        if surface.success {
            let shown = spread_out(&levels);
            drawings.push(drawing("profile", profiles(surface, label, &shown, levels.len())));
            drawings.push(drawing("criterion", survivals(surface, label, &shown, levels.len())));
        }
        drawings
    };
    surface.axes.par_iter().flat_map_iter(figures).collect()
}

/// As many levels as curves can be told apart, the first and the last among them.
fn spread_out(levels: &[Level]) -> Vec<&Level> {
    if levels.len() <= MOST_SMALL {
        return levels.iter().collect();
    }
    (0..MOST_SMALL).map(|i| &levels[i * (levels.len() - 1) / (MOST_SMALL - 1)]).collect()
}

/// `n = 32 seeds x 4 points`, for the levels of an axis.
fn counted(surface: &Surface, levels: &[&Level]) -> String {
    let points = || levels.iter().map(|level| level.points.len());
    let (least, most) = (points().min().unwrap_or(0), points().max().unwrap_or(0));
    let seeds = seeds(surface.seeds.len());
    match (least, most) {
        (1, 1) => format!("n = {seeds} per value"),
        (least, most) if least == most => format!("n = {seeds} at {most} points per value"),
        (least, most) => format!("n = {seeds} at {least} to {most} points per value"),
    }
}

/// Percentiles of the learners at each value, and the mean with its interval.
fn percentiles(surface: &Surface, label: &str, levels: &[Level]) -> String {
    let title = format!("{}: by {label}", surface.arm);
    let mut canvas = Canvas::new(WIDTH, HEIGHT, &title);
    canvas.text(&title, (16.0, 19.0), 15.0, INK, Anchor::Start);
    let subtitle = format!("Each learner at its last test: {}.", words::measure(surface));
    canvas.text(&subtitle, (16.0, TOP - 23.0), 11.5, GREY, Anchor::Start);
    let all = || levels.iter().flat_map(|level| level.learners.iter().copied());
    let range = match surface.success {
        true => (0.0, 1.0),
        false => (lower_end(all().fold(0.0, f64::min)), upper_end(all().fold(0.0, f64::max))),
    };
    let y =
        axes::Axis { title: words::measure(surface).into(), range, points: (BOTTOM, TOP), percent: surface.success };
    for value in ticks(y.range) {
        let at = y.place(value);
        canvas.line(&[(LEFT, at), (RIGHT, at)], PALE, 0.75);
        let text = if surface.success { format!("{:.0}%", 100.0 * value) } else { number(value) };
        canvas.text(&text, (LEFT - 8.0, at), 12.0, INK, Anchor::End);
    }
    canvas.line(&[(LEFT, BOTTOM), (RIGHT, BOTTOM)], GREY, 1.0);
    canvas.text(label, ((LEFT + RIGHT) / 2.0, BOTTOM + 38.0), 13.0, INK, Anchor::Middle);
    canvas.text_upwards(&y.title, (16.0, (TOP + BOTTOM) / 2.0), 13.0, INK);
    let slot = (RIGHT - LEFT) / levels.len() as f64;
    let half = (0.36 * slot).min(22.0);
    let widest = levels.iter().map(|level| 6.5 * level.label.chars().count() as f64).fold(24.0, f64::max);
    let step = every(levels.len(), RIGHT - LEFT, widest + 6.0);
    let mut means = Vec::new();
    for (i, level) in levels.iter().enumerate() {
        let x = LEFT + slot * (i as f64 + 0.5);
        let learners = sorted(&level.learners);
        let at = |share: f64| y.place(quantile(&learners, share));
        canvas.rectangle((x - half, at(0.05)), (x + half, at(0.95)), COLORS[5], 0.35);
        canvas.rectangle((x - half, at(0.25)), (x + half, at(0.75)), COLORS[5], 0.9);
        canvas.line(&[(x - half, at(0.5)), (x + half, at(0.5))], INK, 1.5);
        let (mean, interval) = level.mean();
        canvas.line(&[(x, y.place(interval.low)), (x, y.place(interval.high))], COLORS[1], 2.0);
        means.push((x, y.place(mean)));
        if i % step == 0 {
            canvas.text(&level.label, (x, BOTTOM + 15.0), 11.5, INK, Anchor::Middle);
        }
    }
    canvas.line(&means, COLORS[1], 1.2);
    means.iter().for_each(|&at| canvas.disc(at, 3.4, COLORS[1]));
    let notes = [
        format!("{}.", counted(surface, &levels.iter().collect::<Vec<_>>())),
        "Boxes: 5th, 25th, 50th, 75th and 95th percentile of learners.".to_owned(),
        format!(
            "Dots: mean; bars: its 95% percentile bootstrap interval ({} resamples).",
            number(TABLE_RESAMPLES as f64)
        ),
    ];
    for (i, note) in notes.iter().enumerate() {
        canvas.text(note, (16.0, BOTTOM + 64.0 + 15.0 * i as f64), 11.5, GREY, Anchor::Start);
    }
    canvas.finish()
}

/// Share of learners with more than each success.
fn profiles(surface: &Surface, label: &str, shown: &[&Level], all: usize) -> String {
    let limits: Vec<f64> = (0..LIMITS).map(|i| i as f64 / LIMITS as f64).collect();
    let curve = |level: &&Level| {
        let stair = |&limit: &f64| {
            // Each seed's share of the points: seeds are resampled with all of their points.
            let of_seed = |seed: usize| {
                let above = level.points.iter().filter(|&&point| surface.points[point].values[seed] > limit);
                above.count() as f64 / level.points.len() as f64
            };
            let shares: Vec<f64> = (0..surface.seeds.len()).map(of_seed).collect();
            Stair { x: limit, y: mean(&shares), band: bootstrap(&shares, mean, BAND_RESAMPLES) }
        };
        Staircase { label: level.label.clone(), stairs: limits.iter().map(stair).collect(), end: 1.0 }
    };
    stairs::draw(&stairs::Figure {
        title: format!("{}: performance profile by {label}", surface.arm),
        subtitle: "Share of learners whose success at the last test exceeds x.".into(),
        notes: notes(
            surface,
            shown,
            all,
            format!(
                "Bands: 95% percentile bootstrap interval over seeds ({} resamples).",
                number(BAND_RESAMPLES as f64)
            ),
        ),
        x_title: "success at the last test".into(),
        y_title: "learners above".into(),
        x_range: (0.0, 1.0),
        x_percent: true,
        curves: shown.iter().map(curve).collect(),
    })
}

/// Share of learners that have not reached the criterion yet.
fn survivals(surface: &Surface, label: &str, shown: &[&Level], all: usize) -> String {
    let mut curves: Vec<Staircase> = shown
        .iter()
        .map(|level| {
            let curve = Survival::new(&level.seen);
            let stairs = curve.steps.iter().map(|step| Stair { x: step.time, y: step.survival, band: step.band });
            let label = format!("{} ({} of {})", level.label, curve.reached, curve.count);
            Staircase { label, stairs: stairs.collect(), end: curve.end }
        })
        .collect();
    let longest = curves.iter().map(|curve| curve.end).fold(1.0, f64::max);
    // A little beyond the last test, so that its stair shows.
    curves.iter_mut().for_each(|curve| curve.end += BEYOND * longest);
    let mut lines =
        notes(surface, shown, all, "Kaplan-Meier; bands: 95% log-log intervals, learners taken as independent.".into());
    lines.push("In brackets: learners that got there; the others are censored.".into());
    stairs::draw(&stairs::Figure {
        title: format!("{}: trials to criterion by {label}", surface.arm),
        subtitle: format!("Share of learners without a test at {} or more by then.", limit(CRITERION)),
        notes: lines,
        x_title: "training trials".into(),
        y_title: "not there yet".into(),
        x_range: (0.0, (1.0 + BEYOND) * longest),
        x_percent: false,
        curves,
    })
}

fn notes(surface: &Surface, shown: &[&Level], all: usize, interval: String) -> Vec<String> {
    let some = if shown.len() < all { format!(" {} of {all} values are shown.", shown.len()) } else { String::new() };
    vec![format!("{}.{some}", counted(surface, shown)), interval]
}
