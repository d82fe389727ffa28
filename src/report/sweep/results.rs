//! A sweep and what it measured.

use super::response_surface::{ResponseSurface, surfaces};
use crate::report::summary::{DivergedLearner, Summary};
use crate::run_folder::Sweep;

/// A sweep and what it measured.
#[derive(Debug, Clone)]
pub struct SweepResults {
    /// Axes and points.
    pub sweep: Sweep,
    /// One for each arm with points that hold all seeds.
    pub surfaces: Vec<ResponseSurface>,
    /// Points left out because some seeds have no tests there: arm, point, seeds that have.
    pub lacking: Vec<(String, u32, usize)>,
    /// Learners that diverged.
    pub diverged: Vec<DivergedLearner>,
}

impl SweepResults {
    /// What a run measured; `seeds` are those that it was to have.
    pub fn new(sweep: Sweep, summary: &Summary, seeds: &[u32]) -> Self {
        let (surfaces, lacking) = surfaces(&sweep, summary, seeds);
        Self { sweep, surfaces, lacking, diverged: summary.diverged.clone() }
    }

    /// Surfaces with more than one point, which alone have something to show.
    pub fn shown(&self) -> impl Iterator<Item = &ResponseSurface> {
        self.surfaces.iter().filter(|surface| !surface.axes.is_empty())
    }
}
