//! Statistics against NumPy, rliable, statsmodels, lifelines and published tables; coverage of intervals by simulation.
#![cfg(feature = "report")]

mod coverage;
mod intervals;
mod rliable;
mod selection;
mod survival;

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}
