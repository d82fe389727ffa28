//! Results that are kept: `benches/runs/DATE-MACHINE.json`.

use super::result::Report;
use super::{BenchError, put};
use std::path::{Path, PathBuf};

/// Where results are kept, below the working directory.
pub const FOLDER: &str = "benches/runs";

/// Writes a report into `folder`, under a name that is not taken yet, and says which.
///
/// # Errors
/// Where the folder or the file cannot be written.
pub fn keep(report: &Report, folder: &Path) -> Result<PathBuf, BenchError> {
    std::fs::create_dir_all(folder).map_err(|source| BenchError::File { path: folder.to_owned(), source })?;
    let stem = stem(report);
    let names = (1_u32..).map(|number| if number == 1 { stem.clone() } else { format!("{stem}-{number}") });
    let mut paths = names.map(|name| folder.join(name + ".json"));
    let path = paths.find(|path| !path.exists()).unwrap_or_else(|| folder.join("bench.json"));
    put(&path, json(report)?.as_bytes())?;
    Ok(path)
}

/// The report as JSON, ending with a line feed.
///
/// # Errors
/// Where a figure has no JSON form.
pub fn json(report: &Report) -> Result<String, BenchError> {
    let text = serde_json::to_string_pretty(report);
    let failed =
        |error: serde_json::Error| BenchError::Tensors { path: "bench.json".into(), message: error.to_string() };
    Ok(text.map_err(failed)? + "\n")
}

/// Day and machine, of letters, digits and `-` only.
fn stem(report: &Report) -> String {
    let day = report.origin.started.split('T').next().unwrap_or_default();
    let machine: String = format!("{day} {} {} cores", report.origin.cpu, report.origin.cores)
        .to_lowercase()
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { ' ' })
        .collect();
    machine.split_whitespace().collect::<Vec<_>>().join("-")
}
