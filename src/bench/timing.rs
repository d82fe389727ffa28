//! Time, and what is told of several measurements.

use serde::{Deserialize, Serialize};
use std::time::Instant;

/// How long something took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elapsed {
    /// Seconds on the wall.
    pub wall: f64,
    /// CPU-seconds of all threads of this process; seconds on the wall where the system does not tell.
    pub cpu: f64,
}

/// Calls and times.
pub fn timed<T>(call: impl FnOnce() -> T) -> (T, Elapsed) {
    let (before, begun) = (cpu_seconds(), Instant::now());
    let value = call();
    let wall = begun.elapsed().as_secs_f64().max(1.0e-9);
    let cpu = match (before, cpu_seconds()) {
        (Some(before), Some(after)) => (after - before).max(1.0e-9),
        _ => wall,
    };
    (value, Elapsed { wall, cpu })
}

/// CPU time of all threads of this process, ended ones included.
#[cfg(unix)]
fn cpu_seconds() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1.0e-9)
}

/// No clock of this kind in Rust's reach.
#[cfg(not(unix))]
fn cpu_seconds() -> Option<f64> {
    None
}

/// Some measurements of one thing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Half of them are below.
    pub median: f64,
    /// A quarter of them are below.
    pub low: f64,
    /// A quarter of them are above.
    pub high: f64,
}

impl Spread {
    /// Median and quartiles, interpolated between measurements; none of nothing.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |share: f64| {
            let place = share * last as f64;
            let (below, part) = (place.floor() as usize, place.fract());
            values[below] + part * (values[last.min(below + 1)] - values[below])
        };
        Some(Self { median: at(0.5), low: at(0.25), high: at(0.75) })
    }

    /// In another unit, with so many digits: `median [low, high]`.
    pub fn text(&self, factor: f64, digits: usize) -> String {
        let [median, low, high] = [self.median, self.low, self.high].map(|value| value * factor);
        format!("{median:.digits$} [{low:.digits$}, {high:.digits$}]")
    }
}

/// Cores that this process may use.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_are_interpolated() {
        let spread = Spread::of([4.0, 1.0, 3.0, 2.0]).expect("some");
        assert_eq!((spread.low, spread.median, spread.high), (1.75, 2.5, 3.25));
        assert_eq!(spread.text(2.0, 1), "5.0 [3.5, 6.5]");
        assert_eq!(Spread::of([7.0]), Some(Spread { median: 7.0, low: 7.0, high: 7.0 }));
        assert_eq!(Spread::of([]), None);
    }
}
