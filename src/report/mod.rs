//! Reports: figures, tables and one HTML page from a complete run folder, and from nothing else.
//!
//! The same folder always gives the same bytes. Nothing here reaches back into the simulation.
//!
//! Tables are read and summed ([`results`], [`summary`], [`training`]), judged ([`claims`]), and put into figures
//! ([`all_figures`], of which each makes a [`figure::Figure`]) and tables of numbers by name, which the templates in
//! `templates/` put into words ([`page`], [`mod@format`]). A new statistic is a function in [`statistics`], a field in
//! [`page`] and a column in `templates/page.html`.

pub mod all_figures;
pub mod bootstrap_rng;
pub mod claims;
pub mod comparison;
pub mod error;
pub mod figure;
pub mod figure2;
pub mod floor_plan;
pub mod format;
pub mod learning_curves;
pub mod page;
pub mod results;
pub mod rooms;
pub mod statistics;
pub mod step_plot;
pub mod summary;
pub mod sweep;
pub mod training;
pub mod trajectory_plot;
pub mod transfer;
mod write;

pub use error::ReportError;
pub use write::{PAGE, RenderedReport, WrittenReport, render, write, write_on};
