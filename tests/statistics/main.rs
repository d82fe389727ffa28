//! Statistics against NumPy, SciPy, rliable, lifelines and published tables; coverage of intervals by simulation.

mod coverage;
mod golden;
mod intervals;
mod selection;
mod survival;

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}
