//! What `skilltree bench --json` prints and `--record` keeps: one [`Report`], as JSON.
//!
//! All rates are per second; a [`Spread`] has `median` and the quartiles `low` and `high` of the samples. Names of kinds,
//! limits and executors are lower-case words with `-` between. Fields are added, never changed in meaning, as long as
//! `format` stays.

use super::clock::Spread;
use super::cost::Cost;
use super::executor::About;
use super::limits::Limit;
use serde::{Deserialize, Serialize};

/// Version of the JSON's layout.
pub const FORMAT: u32 = 1;

/// Everything that one call of the benchmark found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`FORMAT`].
    pub format: u32,
    /// Who measured what, where and when.
    pub origin: Origin,
    /// Samples of everything, taken in turn.
    pub samples: u32,
    /// Who did the work.
    pub executors: Vec<About>,
    /// Who was left out, or what, and why.
    pub left_out: Vec<String>,
    /// Cores that were free for this process, by a control loop on all of them before each sample; at most the number
    /// of cores. Nothing on a machine with one core.
    pub free_cores: Option<Spread>,
    /// Limits of one core, measured in the same rounds as the work.
    pub limits: Vec<LimitRate>,
    /// The kinds of work.
    pub tasks: Vec<TaskReport>,
}

/// Circumstances of a measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Version of skilltree.
    pub version: String,
    /// Git commit, if known.
    pub commit: Option<String>,
    /// The command line.
    pub command: String,
    /// When it began, RFC 3339 in UTC.
    pub started: String,
    /// The CPU's name.
    pub cpu: String,
    /// Its cores, as the system offers them.
    pub cores: usize,
    /// Operating system and architecture.
    pub system: String,
}

/// A limit and its rate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LimitRate {
    /// Which.
    pub limit: Limit,
    /// Lane-operations or bytes per CPU-second of one thread.
    pub rate: Spread,
}

/// One kind of work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskReport {
    /// Its name.
    pub name: String,
    /// What a unit is.
    pub about: String,
    /// What a unit costs, if that is counted; see [`super::cost`].
    pub cost: Option<Cost>,
    /// One row per executor that did it. All left the same bytes.
    pub rows: Vec<Row>,
}

/// How fast one executor does one kind of work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the executor.
    pub executor: String,
    /// Units of one sample.
    pub units: u64,
    /// Units per second on the wall.
    pub per_second: Spread,
    /// Units per CPU-second of this process.
    pub per_cpu_second: Spread,
    /// Rate per CPU-second over that of the scalar reference, sample by sample; of a graphics card, rate per second.
    pub over_scalar: Option<Spread>,
    /// On several threads: rate per second over that on one, of the samples in which the cores were free.
    pub over_one_thread: Option<Spread>,
    /// Shares of limits, of executors on the CPU.
    pub shares: Vec<Share>,
}

/// Share of a limit that a row reaches: cost of a unit times units per CPU-second, over the limit's rate in the same
/// round.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// Which limit.
    pub limit: Limit,
    /// The share, 0 to 1.
    pub share: Spread,
}
