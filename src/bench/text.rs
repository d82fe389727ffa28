//! A [`Report`] as people read it.

use super::clock::Spread;
use super::result::{Report, Row, TaskReport};
use std::fmt::Write as _;

/// The whole report.
pub fn text(report: &Report) -> String {
    let origin = &report.origin;
    let mut out = format!("{}, {} cores, {}\n", origin.cpu, origin.cores, origin.system);
    for executor in &report.executors {
        let _ = writeln!(out, "  {:<8} {}", executor.name, executor.device);
    }
    let _ = writeln!(out, "{} samples in turn: medians, and quartiles in brackets", report.samples);
    if let Some(free) = &report.free_cores {
        let _ = writeln!(out, "cores that were free: {}", figure(free, 2));
    }
    out.push_str("\nlimits of one core, per CPU-second\n");
    for limit in &report.limits {
        let unit = limit.limit.unit().trim_end_matches("/s");
        let _ = writeln!(out, "  {:<24} {:>22} G {unit}", limit.limit.text(), figure(&scaled(&limit.rate, 1.0e-9), 1));
    }
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
    if let Some(cost) = &task.cost {
        let bytes = if cost.bytes > 0.0 { format!(" and {:.0} bytes of nets", cost.bytes) } else { String::new() };
        let _ = writeln!(out, "  {:.0} lane-operations{bytes} each", cost.lane_operations);
    }
    let most = task.rows.iter().map(|row| row.per_second.median.max(row.per_cpu_second.median)).fold(0.0, f64::max);
    let (factor, letter) = if most >= 1.0e5 { (1.0e-6, "M ") } else { (1.0, "") };
    for row in &task.rows {
        let rate = |rate: &Spread| format!("{:>24}", figure(&scaled(rate, factor), 3));
        let _ = writeln!(
            out,
            "  {:<8} {} {letter}per CPU-second {} {letter}per second{}",
            row.executor,
            rate(&row.per_cpu_second),
            rate(&row.per_second),
            ratios(row)
        );
    }
    out
}

fn ratios(row: &Row) -> String {
    let mut out = String::new();
    if let Some(ratio) = &row.over_scalar {
        let _ = write!(out, ", {:.1} x scalar", ratio.median);
    }
    if let Some(ratio) = &row.over_one_thread {
        let _ = write!(out, ", {:.2} x one thread", ratio.median);
    }
    for share in &row.shares {
        let _ = write!(out, ", {:.0} % of `{}`", 100.0 * share.share.median, share.limit.text());
    }
    out
}

fn scaled(spread: &Spread, factor: f64) -> Spread {
    Spread { median: spread.median * factor, low: spread.low * factor, high: spread.high * factor }
}

fn figure(spread: &Spread, digits: usize) -> String {
    format!("{:.digits$} [{:.digits$}, {:.digits$}]", spread.median, spread.low, spread.high)
}
