//! Reports: figures, tables and one HTML page from a complete run folder, and from nothing else.
//!
//! The same folder always gives the same bytes. Nothing here reaches back into the simulation.
//!
//! Tables are read and summed ([`results`], [`summary`], [`training`]), judged ([`claims`]), and put into figures
//! (each a [`figure::Figure`]) and tables of numbers by name, which the templates in `templates/` put into words
//! ([`page`], [`mod@format`]). A new statistic is a function in [`statistics`], a field in
//! [`page`] and a column in `templates/page.html`.

#[doc(hidden)]
pub mod bootstrap_rng;
#[doc(hidden)]
pub mod claims;
#[doc(hidden)]
pub mod comparison;
#[doc(hidden)]
pub mod figure;
#[doc(hidden)]
pub mod figure2;
#[doc(hidden)]
pub mod floor_plan;
#[doc(hidden)]
pub mod format;
#[doc(hidden)]
pub mod learning_curves;
#[doc(hidden)]
pub mod page;
#[doc(hidden)]
pub mod results;
#[doc(hidden)]
pub mod rooms;
#[doc(hidden)]
pub mod statistics;
#[doc(hidden)]
pub mod step_plot;
#[doc(hidden)]
pub mod summary;
#[doc(hidden)]
pub mod sweep;
#[doc(hidden)]
pub mod training;
#[doc(hidden)]
pub mod trajectory_plot;
#[doc(hidden)]
pub mod transfer;
mod write;

pub use results::ReportError;
pub use write::{PAGE, RenderedReport, WrittenReport, render, write, write_on};
