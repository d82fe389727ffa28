//! The sweep in tables of the page, and in lines for a terminal.

use super::levels::{Level, effect, levels};
use super::replay::{Replay, replays};
use super::surface::{CRITERION, Point, Surface};
use super::{MOST_ARMS, Swept, words};
use crate::report::figures::{Drawing, Section};
use crate::report::numbers::{limit, number, percent, seeds};
use crate::report::rooms::low_quantile;
use crate::report::statistics::{
    Interval, Survival, TABLE_RESAMPLES, bootstrap, interquartile_mean, mean, share_below, sorted,
};
use crate::run_folder::Sweep;
use crate::run_folder::sweep::{Axis, Design, Scale};
use minijinja::{Value, context};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::path::Path;

/// Points of an arm in its table, best first.
const MOST_POINTS: usize = 20;
/// Seeds of an arm that do worst over all points.
const WORST_SEEDS: usize = 5;
/// Replays that the terminal shows.
const MOST_LINES: usize = 5;
/// Values of an axis that the list of axes names.
const MOST_VALUES: usize = 12;

/// What the template of the page is filled from. `figure` turns a figure into its part of the page; `folder` is how
/// commands name the run folder.
pub fn part(swept: &Swept, figures: &[Drawing], figure: impl Fn(&Drawing) -> Value, folder: &Path) -> Value {
    let sweep = &swept.sweep;
    let of = |arm: &str| -> Vec<Value> {
        let own = |drawing: &&Drawing| matches!(&drawing.section, Section::Sweep(name) if name == arm);
        figures.iter().filter(own).map(&figure).collect()
    };
    let shown: Vec<&Surface> = swept.shown().collect();
    let arms: Vec<Value> = shown.par_iter().map(|surface| arm_part(sweep, surface)).collect();
    let arms = shown.iter().zip(arms).map(|(surface, arm)| context! { figures => of(&surface.arm), ..arm });
    context! {
        design => match sweep.design { Design::Grid => "a grid", Design::Random => "drawn at random" },
        points => sweep.points.len(),
        axes => sweep.axes.iter().map(axis_part).collect::<Vec<_>>(),
        arms => arms.collect::<Vec<_>>(),
        alone => alone(swept),
        lacking => lacking(swept),
        drawn => (shown.len() > MOST_ARMS).then_some(MOST_ARMS),
        replays => replays(swept, folder).iter().map(|replay| replay_row(swept, replay)).collect::<Vec<_>>(),
        criterion => limit(CRITERION),
        resamples => number(TABLE_RESAMPLES as f64),
        first => first_points(swept),
    }
}

/// Which points the rest of the report shows.
fn first_points(swept: &Swept) -> String {
    let name = |surface: &Surface| {
        let number = surface.points[0].number;
        format!("{}: point {number} ({})", surface.arm, swept.sweep.describe(number as usize))
    };
    let named: Vec<String> = swept.surfaces.iter().take(MOST_ARMS).map(name).collect();
    let more = swept.surfaces.len().saturating_sub(MOST_ARMS);
    named.join("; ") + &if more > 0 { format!("; and {more} more arms likewise") } else { String::new() }
}

/// Arms with a single point, which have nothing to compare.
fn alone(swept: &Swept) -> Vec<String> {
    let single = swept.surfaces.iter().filter(|surface| surface.axes.is_empty());
    let line = |surface: &Surface| {
        let best = surface.best();
        let (mean, interval) = centre(&best.values);
        format!(
            "{}, whose only point is {} ({}): {} over {}.",
            surface.arm,
            best.number,
            swept.sweep.describe(best.number as usize),
            words::measured(surface, mean, interval),
            seeds(surface.seeds.len())
        )
    };
    single.map(line).collect()
}

fn lacking(swept: &Swept) -> Vec<String> {
    let line = |(arm, point, has): &(String, u32, usize)| format!("{arm}, point {point} ({} have tests)", seeds(*has));
    let mut lines: Vec<String> = swept.lacking.iter().take(MOST_POINTS).map(line).collect();
    if swept.lacking.len() > MOST_POINTS {
        lines.push(format!("and {} more", swept.lacking.len() - MOST_POINTS));
    }
    lines
}

fn axis_part(axis: &Axis) -> Value {
    let values: Vec<String> = axis.values.iter().map(words::value).collect();
    let all = match values.as_slice() {
        [first, .., last] if values.len() > MOST_VALUES => format!("{first} to {last}, {} values", values.len()),
        _ => values.join(", "),
    };
    context! {
        label => axis.label.as_str(),
        key => axis.key.as_str(),
        scale => match axis.scale { Scale::Linear => "linear", Scale::Log => "logarithmic", Scale::List => "list" },
        values => all,
    }
}

fn centre(values: &[f64]) -> (f64, Interval) {
    (mean(values), bootstrap(values, mean, TABLE_RESAMPLES))
}

fn arm_part(sweep: &Sweep, surface: &Surface) -> Value {
    let selection = &surface.selection;
    let mut order: Vec<usize> = (0..surface.points.len()).collect();
    order.sort_by(|&a, &b| selection.means[b].total_cmp(&selection.means[a]).then(a.cmp(&b)));
    let rows: Vec<Value> = order.par_iter().take(MOST_POINTS).map(|&i| point_row(sweep, surface, i)).collect();
    let axes: Vec<(usize, Vec<Level>)> =
        surface.axes.iter().map(|&axis| (axis, levels(sweep, surface, axis))).collect();
    let effects = axes.iter().filter_map(|(axis, levels)| effect_row(&sweep.axes[*axis].label, surface, levels));
    let by_value = axes
        .iter()
        .flat_map(|(axis, levels)| levels.iter().map(move |level| level_row(&sweep.axes[*axis].label, surface, level)));
    context! {
        name => surface.arm.as_str(),
        skill => surface.skill.as_str(),
        success => surface.success,
        measure => words::measure(surface),
        seeds => surface.seeds.len(),
        points => surface.points.len(),
        best => best_sentence(sweep, surface),
        rows => rows,
        omitted => surface.points.len().saturating_sub(MOST_POINTS),
        effects => effects.collect::<Vec<_>>(),
        values => by_value.collect::<Vec<_>>(),
        worst => worst_seeds(surface),
    }
}

fn best_sentence(sweep: &Sweep, surface: &Surface) -> String {
    let (selection, best) = (&surface.selection, surface.best());
    let (mean, interval) = centre(&best.values);
    let undecided = selection.undecided() - 1;
    let others = match undecided {
        0 => "It is told apart from all other points.".to_owned(),
        1 => "One other point is not told apart from it.".to_owned(),
        _ => format!("{undecided} of the {} other points are not told apart from it.", surface.points.len() - 1),
    };
    let held_out = match selection.out_of_bag.is_nan() {
        true => String::new(),
        false => format!(
            " Its mean promises too much, as it was chosen for being high: the point that a resample of the seeds would \
             choose has {} on the seeds outside the resample.",
            words::bare(surface, selection.out_of_bag)
        ),
    };
    format!(
        "The highest mean is at point {} ({}): {}. It is the best in {} of the resamples of the seeds. {others}{held_out}",
        best.number,
        words::point(sweep, surface, best.number),
        words::measured(surface, mean, interval),
        percent(selection.chosen[selection.best]),
    )
}

/// `240 [200, 290]` trials; an end that the learners never reached is more than all trials.
fn median(seen: &Survival) -> String {
    let or_more = |time: Option<f64>| time.map_or_else(|| format!("more than {}", number(seen.end)), number);
    let (low, high) = seen.quantile_interval(0.5);
    if low.is_none() {
        return or_more(None);
    }
    format!("{} [{}, {}]", or_more(seen.quantile(0.5)), or_more(low), or_more(high))
}

fn point_row(sweep: &Sweep, surface: &Surface, i: usize) -> Value {
    let (point, selection): (&Point, _) = (&surface.points[i], &surface.selection);
    let sorted = sorted(&point.values);
    let seen = Survival::new(&point.seen);
    let (behind, interval) = selection.behind[i];
    let best = i == selection.best;
    context! {
        number => point.number,
        values => words::point(sweep, surface, point.number),
        mean => words::measured(surface, selection.means[i], bootstrap(&sorted, mean, TABLE_RESAMPLES)),
        middle => words::measured(surface, interquartile_mean(&sorted), bootstrap(&sorted, interquartile_mean, TABLE_RESAMPLES)),
        low => words::bare(surface, low_quantile(&sorted)),
        chosen => percent(selection.chosen[i]),
        behind => if best { "best".to_owned() } else { words::difference(surface, -behind, negated(interval)) },
        undecided => selection.indistinguishable(i),
        reached => format!("{} of {}", seen.reached, seen.count),
        median => median(&seen),
    }
}

fn negated(interval: Interval) -> Interval {
    Interval { low: -interval.high, high: -interval.low }
}

fn effect_row(label: &str, surface: &Surface, levels: &[Level]) -> Option<Value> {
    let (highest, lowest, difference, interval) = effect(levels)?;
    let at =
        |level: usize| format!("{} at {}", words::bare(surface, mean(&levels[level].by_seed)), levels[level].label);
    Some(context! {
        axis => label,
        values => levels.len(),
        highest => at(highest),
        lowest => at(lowest),
        range => words::difference(surface, difference, interval),
    })
}

fn level_row(label: &str, surface: &Surface, level: &Level) -> Value {
    let (mean, interval) = level.mean();
    let seen = Survival::new(&level.seen);
    context! {
        axis => label,
        value => level.label.as_str(),
        points => level.points.len(),
        mean => words::measured(surface, mean, interval),
        failing => percent(share_below(&level.learners, 0.5)),
        reached => format!("{} of {}", seen.reached, seen.count),
        median => median(&seen),
    }
}

/// Seeds that do worst over all points of an arm.
fn worst_seeds(surface: &Surface) -> Vec<Value> {
    let of = |seed: usize| surface.points.iter().map(move |point| point.values[seed]).collect::<Vec<_>>();
    let mut means: Vec<(usize, f64)> = (0..surface.seeds.len()).map(|seed| (seed, mean(&of(seed)))).collect();
    means.sort_by(|a, b| a.1.total_cmp(&b.1));
    let row = |(seed, value): (usize, f64)| {
        context! {
            seed => surface.seeds[seed],
            mean => words::bare(surface, value),
            failing => percent(share_below(&of(seed), 0.5)),
            at_best => words::bare(surface, surface.best().values[seed]),
        }
    };
    means.into_iter().take(WORST_SEEDS).map(row).collect()
}

fn replay_row(swept: &Swept, replay: &Replay) -> Value {
    let surface = swept.surfaces.iter().find(|surface| surface.arm == replay.arm);
    let shown = |value: Option<f64>| match (value, surface) {
        (Some(value), Some(surface)) => words::bare(surface, value),
        _ => "none".to_owned(),
    };
    context! {
        reason => replay.reason.words(),
        arm => replay.arm.as_str(),
        point => replay.point,
        seed => replay.seed,
        value => shown(replay.value),
        mean => shown(replay.mean),
        command => replay.command.as_str(),
    }
}

/// The sweep for a terminal; `folder` is how commands name the run folder.
pub fn lines(swept: &Swept, folder: &Path) -> String {
    let sweep = &swept.sweep;
    let mut text = String::new();
    let labels: Vec<&str> = sweep.axes.iter().map(|axis| axis.label.as_str()).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "Sweep over {}: {} points. Means over seeds at the last test [95 % percentile bootstrap interval]",
        labels.join(", "),
        sweep.points.len()
    );
    for surface in swept.shown() {
        arm_lines(sweep, surface, &mut text);
    }
    for line in alone(swept) {
        let _ = writeln!(text, "  {line}");
    }
    for line in lacking(swept) {
        let _ = writeln!(text, "note: left out, as seeds are missing: {line}");
    }
    let replays = replays(swept, folder);
    if !replays.is_empty() {
        let _ = writeln!(text, "  learners worth a look, and how to train each alone with the same bytes:");
    }
    for replay in replays.iter().take(MOST_LINES) {
        let surface = swept.surfaces.iter().find(|surface| surface.arm == replay.arm);
        let value = replay.value.zip(surface).map(|(value, surface)| format!("{}, ", words::bare(surface, value)));
        let _ = writeln!(text, "    {}{}\n      {}", value.unwrap_or_default(), replay.reason.words(), replay.command);
    }
    let _ = writeln!(text, "  skills above and in the page's other sections: each arm's first point alone\n");
    text
}

fn arm_lines(sweep: &Sweep, surface: &Surface, text: &mut String) {
    let (selection, best) = (&surface.selection, surface.best());
    let (mean_of_best, interval) = centre(&best.values);
    let _ = writeln!(
        text,
        "  {} ({}), {} points, n = {}\n    best: point {} ({}): {}, best in {} of resamples; {} of {} points not told apart from it",
        surface.arm,
        surface.skill,
        surface.points.len(),
        seeds(surface.seeds.len()),
        best.number,
        words::point(sweep, surface, best.number),
        words::measured(surface, mean_of_best, interval),
        percent(selection.chosen[selection.best]),
        selection.undecided(),
        surface.points.len(),
    );
    if !selection.out_of_bag.is_nan() {
        let _ = writeln!(
            text,
            "    chosen on resampled seeds, tested on the others: {}",
            words::bare(surface, selection.out_of_bag)
        );
    }
    for &axis in &surface.axes {
        let levels = levels(sweep, surface, axis);
        if let Some((highest, lowest, difference, interval)) = effect(&levels) {
            let _ = writeln!(
                text,
                "    {}: from {} at {} to {} at {}: {}",
                sweep.axes[axis].label,
                words::bare(surface, mean(&levels[lowest].by_seed)),
                levels[lowest].label,
                words::bare(surface, mean(&levels[highest].by_seed)),
                levels[highest].label,
                words::difference(surface, difference, interval),
            );
        }
    }
    if surface.success {
        let seen = Survival::new(&best.seen);
        let _ = writeln!(
            text,
            "    at the best point {} of {} seeds reach {}; median trials {}",
            seen.reached,
            seen.count,
            limit(CRITERION),
            median(&seen)
        );
    }
}
