//! Learners worth a closer look, each with the command that trains it again, alone and with the same bytes.

use super::surface::{ResponseSurface, SweepResults};
use crate::report::statistics::mean;
use std::path::Path;

/// Worst learners at the best point of each arm.
const AT_BEST: usize = 5;
/// Learners furthest below the mean of their point.
const FURTHEST: usize = 10;
/// Learners that diverged.
const DIVERGED: usize = 10;

/// A learner and how to train it again.
#[derive(Debug, Clone, PartialEq)]
pub struct Rerun {
    /// Why it is listed.
    pub reason: &'static str,
    /// Its arm.
    pub arm: String,
    /// Its point.
    pub point: u32,
    /// Its seed.
    pub seed: u32,
    /// What it achieves at its last test, and the mean over the seeds of its point; none if it was never tested.
    pub values: Option<(f64, f64)>,
}

impl Rerun {
    /// The command that trains the learner again, into a folder beside the run's; to be given where the path of the run
    /// folder holds.
    pub fn command(&self, folder: &Path) -> String {
        let Self { arm, point, seed, .. } = self;
        let quoted = |text: String| shlex::try_quote(&text).map(|quoted| quoted.into_owned()).unwrap_or(text);
        let config = quoted(folder.join(crate::run_folder::folder::CONFIG).display().to_string());
        let beside = folder.file_name().map_or_else(|| "rerun".to_owned(), |name| name.to_string_lossy().into_owned());
        let out = folder.with_file_name(format!("{beside}-{arm}-p{point}-{seed}"));
        let out = quoted(out.display().to_string());
        format!("skilltree run {config} --arm {} --point {point} --seeds {seed} --out {out}", quoted(arm.clone()))
    }
}

/// The learners that the report lists: each once, for the first reason.
pub fn reruns(swept: &SweepResults) -> Vec<Rerun> {
    let mut listed: Vec<Rerun> = Vec::new();
    let mut list = |reason: &'static str, (arm, point, seed): (&str, u32, u32), values: Option<(f64, f64)>| {
        if listed.iter().any(|known| (known.arm.as_str(), known.point, known.seed) == (arm, point, seed)) {
            return false;
        }
        listed.push(Rerun { reason, arm: arm.to_owned(), point, seed, values });
        true
    };
    for learner in swept.diverged.iter().take(DIVERGED) {
        list("diverged", (&learner.arm, learner.point, learner.seed), None);
    }
    for surface in &swept.surfaces {
        let mut learners = learners(surface, &[surface.selection.best]);
        learners.sort_by(|a, b| a.2.0.total_cmp(&b.2.0));
        for (point, seed, values) in learners.into_iter().take(AT_BEST) {
            list("among the worst at the best point", (&surface.arm, point, seed), Some(values));
        }
    }
    let mut all: Vec<_> = swept
        .surfaces
        .iter()
        .flat_map(|surface| {
            let every: Vec<usize> = (0..surface.points.len()).collect();
            learners(surface, &every).into_iter().map(move |learner| (surface, learner))
        })
        .filter(|(_, (_, _, (value, mean)))| value < mean)
        .collect();
    all.sort_by(|(_, a), (_, b)| (a.2.0 - a.2.1).total_cmp(&(b.2.0 - b.2.1)));
    let mut far = 0;
    for (surface, (point, seed, values)) in all {
        if far == FURTHEST {
            break;
        }
        far += usize::from(list("far below its point's mean", (&surface.arm, point, seed), Some(values)));
    }
    listed
}

/// Number of the point, seed, and what the learner and its peers achieve.
fn learners(surface: &ResponseSurface, points: &[usize]) -> Vec<(u32, u32, (f64, f64))> {
    let of = |&point: &usize| {
        let point = &surface.points[point];
        let mean = mean(&point.values);
        surface.seeds.iter().zip(&point.values).map(move |(&seed, &value)| (point.number, seed, (value, mean)))
    };
    points.iter().flat_map(of).collect()
}
