//! A [`BenchReport`] as people read it.

use super::result::{BenchReport, TaskReport};
use std::fmt::Write as _;

/// The whole report.
pub fn text(report: &BenchReport) -> String {
    let origin = &report.origin;
    let mut out = format!("{}, {} cores, {}\n", origin.cpu, origin.cores, origin.system);
    for executor in &report.executors {
        let _ = writeln!(out, "  {:<9} {}", executor.name, executor.device);
    }
    let _ = writeln!(out, "{} samples in turn: medians, and quartiles in brackets", report.samples);
    for task in &report.tasks {
        let _ = write!(out, "\n{}", task_text(task));
    }
    for reason in &report.left_out {
        let _ = write!(out, "\nleft out: {reason}");
    }
    out.trim_end().to_owned() + "\n"
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
