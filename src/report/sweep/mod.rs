//! The sweep's part of a report: where in the space of its axes learning works best, how sure that is, and what each
//! axis does.
//!
//! An arm's root skill is judged by the last test: share of test trials achieved, or the discounted return of a skill
//! that never ends. Points of one arm share their seeds, so they are compared seed by seed.

mod distribution;
mod levels;
mod map;
mod part;
mod plane;
mod replay;
mod scatter;
mod surface;
mod words;

pub use levels::{Level, effect, levels};
pub use part::{lines, part};
pub use replay::{Replay, replays};
pub use surface::{CRITERION, Point, Surface, surfaces};

use super::figures::Drawing;
use super::summary::{Diverged, Summary};
use crate::run_folder::Sweep;
use rayon::prelude::*;

/// Arms whose figures are drawn; tables hold all.
const MOST_ARMS: usize = 4;

/// A sweep and what it measured.
#[derive(Debug, Clone)]
pub struct Swept {
    /// Axes and points.
    pub sweep: Sweep,
    /// One for each arm with points that hold all seeds.
    pub surfaces: Vec<Surface>,
    /// Points left out because some seeds have no tests there: arm, point, seeds that have.
    pub lacking: Vec<(String, u32, usize)>,
    /// Learners that diverged.
    pub diverged: Vec<Diverged>,
}

impl Swept {
    /// What a run measured; `seeds` are those that it was to have.
    pub fn new(sweep: Sweep, summary: &Summary, seeds: &[u32]) -> Self {
        let (surfaces, lacking) = surfaces(&sweep, summary, seeds);
        Self { sweep, surfaces, lacking, diverged: summary.diverged.clone() }
    }

    /// Surfaces with more than one point, which alone have something to show.
    fn shown(&self) -> impl Iterator<Item = &Surface> {
        self.surfaces.iter().filter(|surface| !surface.axes.is_empty())
    }
}

/// Draws all figures of a sweep.
pub fn draw(swept: &Swept) -> Vec<Drawing> {
    let drawn: Vec<&Surface> = swept.shown().take(MOST_ARMS).collect();
    drawn
        .into_par_iter()
        .flat_map_iter(|surface| {
            let mut drawings = map::draw(&swept.sweep, surface);
            drawings.extend(distribution::draw(&swept.sweep, surface));
            drawings
        })
        .collect()
}
