//! What is found in a sweep, against NumPy and lifelines on the same numbers.

use super::{ROWS, SEEDS, TESTS, known, peak, summary, swept, thresholds};
use crate::close;
use skilltree::report::statistics::SurvivalCurve;
use skilltree::report::summary::cautions;
use skilltree::report::sweep::{ResponseSurface, SweepResults, main_effect, reruns};
use skilltree::run_folder::{Divergence, EvaluationRow};
use std::collections::BTreeSet;
use std::path::Path;

/// NumPy: 200,000 multinomial resamples of the seeds, shared by all points.
#[test]
fn the_optimum_and_its_uncertainty_are_found() {
    let swept = swept();
    let surface: &ResponseSurface = &swept.surfaces[0];
    let selection = &surface.selection;
    assert_eq!((surface.points.len(), surface.axes.as_slice(), surface.best().number), (30, &[0, 1][..], 12));
    close(selection.means[12], 0.9052083333333334, 1e-12);
    close(selection.means[13], 0.8989583333333334, 1e-12);
    for (point, share) in [(8, 0.2493), (12, 0.3343), (13, 0.2720), (14, 0.1417), (18, 0.0013), (0, 0.0)] {
        // Three errors of 10,000 resamples.
        close(selection.chosen[point], share, 0.0145);
    }
    // The lower end for point 11 is 0.001, too close to 0 to ask.
    let undecided: BTreeSet<usize> = (0..30).filter(|&i| i != 11 && selection.indistinguishable(i)).collect();
    assert_eq!(undecided, BTreeSet::from([8, 12, 13, 14, 17, 19]));
    // Column 2, row 3, where the surface was made highest.
    assert!(undecided.contains(&(2 * ROWS as usize + 3)));
    close(selection.out_of_bag, 0.8765916862761131, 0.003);
    let monolithic = &swept.surfaces[1];
    assert_eq!((monolithic.arm.as_str(), monolithic.points.len(), monolithic.axes.len()), ("monolithic", 1, 0));
}

#[test]
fn effects_are_marginal_means() {
    let swept = swept();
    let surface = &swept.surfaces[0];
    let (columns, rows) = (surface.levels(0), surface.levels(1));
    let means =
        [0.6670833333333334, 0.78625, 0.8554166666666667, 0.794375, 0.656875, 0.4275].map(|mean: f64| (mean, 5));
    assert_eq!(columns.len(), 6);
    for (level, (mean, points)) in columns.iter().zip(means) {
        close(level.mean().value, mean, 1e-12);
        assert_eq!((level.points.len(), level.learners.len()), (points, points * SEEDS as usize));
    }
    assert_eq!(columns[2].label, "0.05");
    let effect = main_effect(&columns).unwrap();
    assert_eq!((effect.highest, effect.lowest), (2, 5));
    close(effect.difference.value, 0.42791666666666667, 1e-12);
    close(effect.difference.low, 0.40875, 0.0015);
    close(effect.difference.high, 0.44854167, 0.0015);
    close(rows[3].mean().value, 0.7697916666666667, 1e-12);
    assert_eq!(main_effect(&rows).unwrap().lowest, 0);
    assert!(main_effect(&[]).is_none());
}

/// lifelines 0.30.3: KaplanMeierFitter on the same trials to criterion.
#[test]
fn trials_to_criterion_are_censored_at_the_last_test() {
    let swept = swept();
    let surface = &swept.surfaces[0];
    let best = SurvivalCurve::new(&surface.best().seen);
    assert_eq!((best.count, best.reached, best.end), (24, 16, 300.0));
    let lifelines = [
        (200.0, 0.541667, 0.327120, 0.714341),
        (250.0, 0.500000, 0.290977, 0.677609),
        (300.0, 0.333333, 0.159025, 0.518707),
    ];
    assert_eq!(best.steps.len(), lifelines.len());
    for (step, (time, share, low, high)) in best.steps.iter().zip(lifelines) {
        assert_eq!(step.time, time);
        close(step.share.value, share, 1e-6);
        close(step.share.low, low, 1e-6);
        close(step.share.high, high, 1e-6);
    }
    assert_eq!((best.quantile(0.5), best.quantile_interval(0.5)), (Some(250.0), (Some(200.0), None)));
    let column = SurvivalCurve::new(&surface.levels(0)[2].seen);
    assert_eq!((column.count, column.reached), (120, 59));
    close(column.steps.last().unwrap().share.value, 0.508333, 1e-6);
}

#[test]
fn the_worst_learners_come_with_their_commands() {
    let swept = swept();
    let listed = reruns(&swept);
    let folder = Path::new("runs/my sweep");
    let at_best: Vec<_> =
        listed.iter().filter(|rerun| rerun.arm == "hierarchical" && rerun.point == 12).take(5).collect();
    let seeds: Vec<u32> = at_best.iter().map(|rerun| rerun.seed).collect();
    assert_eq!(seeds, [23, 12, 14, 6, 11]);
    close(at_best[0].values.unwrap().0, 0.6, 1e-12);
    assert_eq!(
        at_best[0].command(folder),
        "skilltree run 'runs/my sweep/config.toml' --arm hierarchical --point 12 --seeds 23 --out \
         'runs/my sweep-hierarchical-p12-23'"
    );
    let each: BTreeSet<_> = listed.iter().map(|rerun| (&rerun.arm, rerun.point, rerun.seed)).collect();
    assert_eq!((each.len(), listed.len()), (20, 20));
    let here = listed[0].command(Path::new("runs/quick/"));
    assert!(here.ends_with("--out runs/quick-hierarchical-p12-23"), "{here}");
}

fn diverged(point: u32, seed: u32) -> Divergence {
    let (arm, skill, what) = ("hierarchical".into(), "recharge".into(), "a weight is NaN".into());
    Divergence { arm, point, seed, skill, trial: 60, what, transition: None, weight: None }
}

/// One learner stops after its second test, at another point all do.
#[test]
fn learners_that_diverged_count_as_failed() {
    let (mut names, mut rows) = known();
    rows.retain(|row| !(row.arm == "hierarchical" && row.point == 12 && row.seed == 5 && row.trials > 25));
    rows.retain(|row| !(row.arm == "hierarchical" && row.point == 3 && row.trials > 50));
    names.variants.push("moved".into());
    let last = |row: &&EvaluationRow| (row.arm.as_str(), row.point, row.trials) == ("hierarchical", 12, 300);
    let moved: Vec<EvaluationRow> =
        rows.iter().filter(last).map(|row| EvaluationRow { variant: "moved".to_owned(), ..row.clone() }).collect();
    rows.extend(moved);
    let mut failures = vec![diverged(12, 5)];
    failures.extend((0..SEEDS).map(|seed| diverged(3, seed)));
    let summary = summary(&names, &rows, SEEDS, &failures);
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    let cautions = cautions(&summary);
    assert!(
        cautions.iter().any(|text| text.contains("25 learners diverged") && text.contains("20 more")),
        "{cautions:?}"
    );
    let series = &summary.skills[0].series[12];
    assert_eq!((series.point, series.tests.len()), (12, TESTS.len()));
    let score = series.last().scores[5];
    // As long as the longest mean trial of any test: 200 steps, where none was achieved.
    assert_eq!((score.seed, score.episodes, score.successes, score.steps), (5, 40, 0, 8_000));
    assert_eq!(score.actions, 100 + 60 * 25);
    assert_eq!(series.tests[1].scores[5].successes, u64::from(peak(2, 2, 5) * 25 * 350 / (300 * 75)));
    let moved = &series.transfer[0].scores;
    assert_eq!((moved.len(), moved[5].episodes, moved[5].successes), (SEEDS as usize, 40, 0));
    assert_eq!(moved[6].successes, u64::from(peak(2, 2, 6)));
    let seeds: Vec<u32> = (0..SEEDS).collect();
    let swept = SweepResults::new(thresholds(), &summary, &seeds);
    let surface = &swept.surfaces[0];
    assert_eq!((surface.points.len(), surface.selection.means[3]), (30, 0.0));
    close(surface.selection.means[12], 0.9052083333333334 - f64::from(peak(2, 2, 5)) / 40.0 / 24.0, 1e-12);
    let seen = surface.points[12].seen[5];
    assert_eq!((seen.time, seen.reached), (300.0, false));
    let listed = reruns(&swept);
    assert_eq!(
        listed[0].command(Path::new("run")),
        "skilltree run run/config.toml --arm hierarchical --point 12 --seeds 5 --out run-hierarchical-p12-5"
    );
}
