//! The sweep's part of a report: where in the space of its axes learning works best, how sure that is, and what each
//! axis does.
//!
//! An arm's root skill is judged by the last test: share of test trials achieved, or the discounted return of a skill
//! that never ends. Points of one arm share their seeds, so they are compared seed by seed.

mod distribution;
mod figures;
mod format;
mod heatmap;
mod main_effects;
mod rerun;
mod response_surface;
mod results;
mod scatter;
mod tables;

pub use figures::draw;
pub use main_effects::{AxisLevel, MainEffect, levels, main_effect};
pub use rerun::{Rerun, reruns};
pub use response_surface::{CRITERION, ResponseSurface, SurfacePoint, surfaces};
pub use results::SweepResults;
pub use tables::context;
