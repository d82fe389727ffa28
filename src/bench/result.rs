//! What `skilltree bench --json` prints and `--record` keeps: one [`BenchReport`], as JSON.
//!
//! All rates are per second; a [`Spread`] has `median` and the quartiles `low` and `high` of the samples. Names are
//! lower-case words with `-` between. Fields are added, never changed in meaning, as long as `format` stays.

use super::executor::ExecutorInfo;
use super::timing::{Spread, cores};
use super::{BenchError, make_folder, write_file};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Version of the JSON's layout.
pub const FORMAT: u32 = 2;
/// Where results are kept, below the working directory.
pub const FOLDER: &str = "benches/runs";

/// Everything that one call of the benchmark found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BenchReport {
    /// [`FORMAT`].
    pub format: u32,
    /// Who measured what, where and when.
    pub origin: BenchOrigin,
    /// Samples of everything, taken in turn.
    pub samples: u32,
    /// Who did the work.
    pub executors: Vec<ExecutorInfo>,
    /// Who was left out, or what, and why.
    pub left_out: Vec<String>,
    /// The kinds of work.
    pub tasks: Vec<TaskReport>,
}

/// Circumstances of a measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BenchOrigin {
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

/// One kind of work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskReport {
    /// Its name.
    pub name: String,
    /// What a unit is.
    pub about: String,
    /// One row per executor that did it. All left the same bytes.
    pub rows: Vec<RateRow>,
}

/// How fast one executor does one kind of work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RateRow {
    /// Name of the executor.
    pub executor: String,
    /// Units of one sample.
    pub units: u64,
    /// Units per second on the wall.
    pub per_second: Spread,
    /// Units per CPU-second of this process.
    pub per_cpu_second: Spread,
    /// Rate per CPU-second over that of the reference, sample by sample; of a graphics card, rate per second.
    pub over_reference: Option<Spread>,
}

impl BenchOrigin {
    /// Here and now, by this command.
    pub fn new(command: &str) -> Self {
        let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        let model = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("SKILLTREE_COMMIT").map(str::to_owned),
            command: command.to_owned(),
            started: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            cpu: model.map_or_else(|| "unknown CPU".to_owned(), |(_, name)| name.trim().to_owned()),
            cores: cores(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

impl BenchReport {
    /// As JSON, ending with a line feed.
    pub fn json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// As people read it.
    pub fn text(&self) -> String {
        let origin = &self.origin;
        let mut out = format!("{}, {} cores, {}\n", origin.cpu, origin.cores, origin.system);
        for executor in &self.executors {
            let _ = writeln!(out, "  {:<9} {}", executor.name, executor.device);
        }
        let _ = writeln!(out, "{} samples in turn: medians, and quartiles in brackets", self.samples);
        for task in &self.tasks {
            let _ = write!(out, "\n{}", task_text(task));
        }
        for reason in &self.left_out {
            let _ = write!(out, "\nleft out: {reason}");
        }
        out.trim_end().to_owned() + "\n"
    }

    /// Writes it into `folder` as `DATE-MACHINE.json`, with a number where that is taken, and hands back the path.
    ///
    /// # Errors
    /// Where the folder or the file cannot be written.
    pub fn record(&self, folder: &Path) -> Result<PathBuf, BenchError> {
        make_folder(folder)?;
        let day = self.origin.started.split('T').next().unwrap_or_default();
        let words = format!("{day} {} {} cores", self.origin.cpu, self.origin.cores).to_lowercase();
        let words: Vec<&str> =
            words.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let stem = words.join("-");
        let (mut path, mut number) = (folder.join(format!("{stem}.json")), 1);
        while path.exists() {
            number += 1;
            path = folder.join(format!("{stem}-{number}.json"));
        }
        write_file(&path, self.json().as_bytes())?;
        Ok(path)
    }
}

fn task_text(task: &TaskReport) -> String {
    let mut out = format!("{}: {}\n", task.name, task.about);
    let most = task.rows.iter().map(|row| row.per_second.median.max(row.per_cpu_second.median)).fold(0.0, f64::max);
    let (factor, letter) = if most >= 1.0e5 { (1.0e-6, "M ") } else { (1.0, "") };
    for row in &task.rows {
        let ratio = row.over_reference.as_ref().map(|ratio| format!(", {:.1} x reference", ratio.median));
        let _ = writeln!(
            out,
            "  {:<9} {:>24} {letter}per CPU-second {:>24} {letter}per second{}",
            row.executor,
            row.per_cpu_second.text(factor, 3),
            row.per_second.text(factor, 3),
            ratio.unwrap_or_default()
        );
    }
    out
}
