//! All figures of a sweep.

use super::surface::{ResponseSurface, SweepResults};
use super::{axis_figures, maps};
use crate::report::figure::Figure;
use crate::report::format::file_word;
use crate::run_folder::sweep::Design;
use rayon::prelude::*;

/// Arms whose figures are drawn; tables hold all.
pub(super) const MOST_ARMS: usize = 4;
/// Pairs of axes that are drawn for an arm.
const MOST_PAIRS: usize = 6;

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
    let of_axis = |&axis: &usize| {
        let (levels, label) = (surface.levels(axis), &sweep.axes[axis].label);
        let kinds = axis_figures::draw(surface, label, &levels).into_iter();
        kinds.map(|(kind, figure)| named(format!("{kind}-{}", key(axis)), figure)).collect::<Vec<_>>()
    };
    figures.par_extend(axes.par_iter().flat_map_iter(of_axis));
    figures
}
