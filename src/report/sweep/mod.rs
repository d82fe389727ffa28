//! The sweep's part of a report: where in the space of its axes learning works best, how sure that is, and what each
//! axis does.
//!
//! An arm's root skill is judged by the last test: share of test trials achieved, or the discounted return of a skill
//! that never ends. Points of one arm share their seeds, so they are compared seed by seed.

mod figures;
mod maps;
mod rerun;
mod surface;
mod tables;

pub use figures::draw;
pub use rerun::{Rerun, reruns};
pub use surface::{AxisLevel, CRITERION, MainEffect, ResponseSurface, SurfacePoint, SweepResults, main_effect};
pub use tables::context;
