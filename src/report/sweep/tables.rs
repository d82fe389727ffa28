//! The sweep's tables, for the page and the terminal.

use super::figures::MOST_ARMS;
use super::rerun::{Rerun, reruns};
use super::surface::{AxisLevel, CRITERION, ResponseSurface, SweepResults, axis_value, main_effect};
use crate::report::format::median_trials;
use crate::report::rooms::low_quantile;
use crate::report::statistics::{
    SurvivalCurve, TABLE_RESAMPLES, bootstrap, interquartile_mean, mean, mean_of, share_below, sorted,
};
use crate::run_folder::sweep::{Axis, Design, Scale};
use minijinja::{Value, context};
use rayon::prelude::*;
use std::path::Path;

/// Points of an arm in its table, best first.
const MOST_POINTS: usize = 20;
/// Seeds of an arm that do worst over all points.
const WORST_SEEDS: usize = 5;
/// Values of an axis that the list of axes names.
const MOST_VALUES: usize = 12;

/// What the templates are filled from. Commands name the run folder `folder` on the page, and `here` in the terminal.
pub fn context(swept: &SweepResults, folder: &Path, here: &Path) -> Value {
    let sweep = &swept.sweep;
    let shown: Vec<&ResponseSurface> = swept.shown().collect();
    let alone = swept.surfaces.iter().filter(|surface| surface.axes.is_empty());
    let first = |surface: &ResponseSurface| {
        let number = surface.points[0].number;
        context! { arm => &surface.arm, number => number, values => sweep.describe(number as usize) }
    };
    let lacking = |(arm, point, seeds): &(String, u32, usize)| context! { arm => arm, point => point, seeds => seeds };
    context! {
        design => match sweep.design { Design::Grid => "a grid", Design::Random => "drawn at random" },
        points => sweep.points.len(),
        axes => sweep.axes.iter().map(axis_row).collect::<Vec<_>>(),
        arms => shown.par_iter().map(|surface| arm_part(surface)).collect::<Vec<_>>(),
        alone => alone.map(best).collect::<Vec<_>>(),
        lacking => swept.lacking.iter().take(MOST_POINTS).map(lacking).collect::<Vec<_>>(),
        more_lacking => swept.lacking.len().saturating_sub(MOST_POINTS),
        drawn => (shown.len() > MOST_ARMS).then_some(MOST_ARMS),
        reruns => reruns(swept).iter().map(|rerun| rerun_row(swept, rerun, folder, here)).collect::<Vec<_>>(),
        criterion => CRITERION,
        firsts => swept.surfaces.iter().take(MOST_ARMS).map(first).collect::<Vec<_>>(),
        more_firsts => swept.surfaces.len().saturating_sub(MOST_ARMS),
    }
}

fn axis_row(axis: &Axis) -> Value {
    let values: Vec<String> = axis.values.iter().map(axis_value).collect();
    let all = match values.as_slice() {
        [first, .., last] if values.len() > MOST_VALUES => format!("{first} to {last}, {} values", values.len()),
        _ => values.join(", "),
    };
    context! {
        label => &axis.label,
        key => &axis.key,
        scale => match axis.scale { Scale::Linear => "linear", Scale::Log => "logarithmic", Scale::List => "list" },
        values => all,
    }
}

fn arm_part(surface: &ResponseSurface) -> Value {
    let means = &surface.selection.means;
    let mut order: Vec<usize> = (0..surface.points.len()).collect();
    order.sort_by(|&a, &b| means[b].total_cmp(&means[a]).then(a.cmp(&b)));
    let rows: Vec<Value> = order.par_iter().take(MOST_POINTS).map(|&i| point_row(surface, i)).collect();
    let axes: Vec<(&str, Vec<AxisLevel>)> =
        surface.axes.iter().map(|&axis| (surface.sweep.axes[axis].label.as_str(), surface.levels(axis))).collect();
    let effects = axes.iter().filter_map(|(label, levels)| effect_row(label, levels));
    let by_value = axes.iter().flat_map(|(label, levels)| levels.iter().map(move |level| level_row(label, level)));
    context! {
        skill => &surface.skill,
        measure => surface.measure(),
        points => surface.points.len(),
        rows => rows,
        omitted => surface.points.len().saturating_sub(MOST_POINTS),
        effects => effects.collect::<Vec<_>>(),
        values => by_value.collect::<Vec<_>>(),
        worst => worst_seeds(surface),
        ..best(surface),
    }
}

/// The best point of an arm, and how sure it is.
fn best(surface: &ResponseSurface) -> Value {
    let (selection, point_of_best) = (&surface.selection, surface.best());
    let seen = SurvivalCurve::new(&point_of_best.seen);
    context! {
        name => &surface.arm,
        success => surface.success,
        seeds => surface.seeds.len(),
        best => context! {
            number => point_of_best.number,
            values => surface.words(&surface.axes, selection.best),
            all_values => surface.sweep.describe(point_of_best.number as usize),
            mean => mean_of(&point_of_best.values),
            chosen => selection.chosen[selection.best],
            undecided => selection.undecided(),
            held_out => (!selection.out_of_bag.is_nan()).then_some(selection.out_of_bag),
            reached => seen.reached,
            median => median_trials(&seen),
        },
    }
}

fn point_row(surface: &ResponseSurface, i: usize) -> Value {
    let (point_here, selection) = (&surface.points[i], &surface.selection);
    let seen = SurvivalCurve::new(&point_here.seen);
    context! {
        number => point_here.number,
        values => surface.words(&surface.axes, i),
        mean => mean_of(&point_here.values),
        middle => bootstrap(&point_here.values, interquartile_mean, TABLE_RESAMPLES),
        low => low_quantile(&sorted(&point_here.values)),
        chosen => selection.chosen[i],
        minus_best => (i != selection.best).then(|| -selection.behind[i]),
        undecided => selection.indistinguishable(i),
        reached => format!("{} of {}", seen.reached, seen.count),
        median => median_trials(&seen),
    }
}

fn effect_row(label: &str, levels: &[AxisLevel]) -> Option<Value> {
    let effect = main_effect(levels)?;
    let level = |level: usize| context! { mean => mean(&levels[level].by_seed), value => &levels[level].label };
    Some(context! {
        axis => label,
        values => levels.len(),
        highest => level(effect.highest),
        lowest => level(effect.lowest),
        difference => effect.difference,
    })
}

fn level_row(label: &str, level: &AxisLevel) -> Value {
    let seen = SurvivalCurve::new(&level.seen);
    context! {
        axis => label,
        value => &level.label,
        points => level.points.len(),
        mean => level.mean(),
        failing => share_below(&level.learners, 0.5),
        reached => format!("{} of {}", seen.reached, seen.count),
        median => median_trials(&seen),
    }
}

/// Seeds that do worst over all points of an arm.
fn worst_seeds(surface: &ResponseSurface) -> Vec<Value> {
    let of = |seed: usize| surface.points.iter().map(move |point| point.values[seed]).collect::<Vec<_>>();
    let mut means: Vec<(usize, f64)> = (0..surface.seeds.len()).map(|seed| (seed, mean(&of(seed)))).collect();
    means.sort_by(|a, b| a.1.total_cmp(&b.1));
    let row = |(seed, mean): (usize, f64)| {
        context! {
            seed => surface.seeds[seed],
            mean => mean,
            failing => share_below(&of(seed), 0.5),
            at_best => surface.best().values[seed],
        }
    };
    means.into_iter().take(WORST_SEEDS).map(row).collect()
}

fn rerun_row(swept: &SweepResults, rerun: &Rerun, folder: &Path, here: &Path) -> Value {
    let surface = swept.surfaces.iter().find(|surface| surface.arm == rerun.arm);
    context! {
        reason => rerun.reason,
        arm => &rerun.arm,
        point => rerun.point,
        seed => rerun.seed,
        value => rerun.values.map(|(value, _)| value),
        mean => rerun.values.map(|(_, mean)| mean),
        success => surface.is_none_or(|surface| surface.success),
        command => rerun.command(folder),
        command_here => rerun.command(here),
    }
}
