//! One kind of figure for everything that a report draws: two axes, shapes in their units, a legend and notes.
//!
//! Learning curves, step plots, scatter plots, distributions, heatmaps, floor plans and trajectories differ in their
//! shapes alone.

pub mod axis;
pub mod color;
pub mod curves;
mod plot;
mod render;
pub mod svg;

pub use plot::{Figure, LegendEntry, PlotArea, Swatch};
pub use render::{render_svg, spread};
