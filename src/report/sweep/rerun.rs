//! Learners worth a closer look, each with the command that trains it again, alone and with the same bytes.

use super::surface::{ResponseSurface, SweepResults};
use crate::report::statistics::mean;
use crate::run_folder::Divergence;
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
    pub reason: &'static str,
    pub arm: String,
    pub point: u32,
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
    let diverged = swept.diverged.iter().take(DIVERGED).map(|Divergence { arm, point, seed, .. }| Rerun {
        reason: "diverged",
        arm: arm.clone(),
        point: *point,
        seed: *seed,
        values: None,
    });
    let worst = swept.surfaces.iter().flat_map(|surface| {
        let mut worst = learners(surface, &[surface.selection.best], "among the worst at the best point");
        worst.sort_by(|(a, _), (b, _)| a.0.total_cmp(&b.0));
        worst.into_iter().take(AT_BEST).map(|(_, learner)| learner)
    });
    let all = |surface: &ResponseSurface| (0..surface.points.len()).collect::<Vec<_>>();
    let every =
        swept.surfaces.iter().flat_map(|surface| learners(surface, &all(surface), "far below its point's mean"));
    let mut far: Vec<_> = every.filter(|((value, mean), _)| value < mean).collect();
    far.sort_by(|(a, _), (b, _)| (a.0 - a.1).total_cmp(&(b.0 - b.1)));
    let mut listed: Vec<Rerun> = Vec::new();
    let is_new = |listed: &[Rerun], learner: &Rerun| {
        let same = |known: &Rerun| (&known.arm, known.point, known.seed) == (&learner.arm, learner.point, learner.seed);
        !listed.iter().any(same)
    };
    for learner in diverged.chain(worst) {
        if is_new(&listed, &learner) {
            listed.push(learner);
        }
    }
    let far = far.into_iter().map(|(_, learner)| learner).filter(|learner| is_new(&listed, learner)).take(FURTHEST);
    let far: Vec<Rerun> = far.collect();
    listed.extend(far);
    listed
}

/// The learners of some points, each with what it and its peers achieve.
fn learners(surface: &ResponseSurface, points: &[usize], reason: &'static str) -> Vec<((f64, f64), Rerun)> {
    let of = |&point: &usize| {
        let point = &surface.points[point];
        let mean = mean(&point.values);
        surface.seeds.iter().zip(&point.values).map(move |(&seed, &value)| {
            let (arm, values) = (surface.arm.clone(), (value, mean));
            (values, Rerun { reason, arm, point: point.number, seed, values: Some(values) })
        })
    };
    points.iter().flat_map(of).collect()
}
