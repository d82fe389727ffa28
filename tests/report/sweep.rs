//! A sweep over a surface with a known optimum, against NumPy and lifelines on the same numbers.

use crate::{OFFICE, close, scratch};
use skilltree::record::sweep::{Axis, AxisValue, Design, FILE, Scale, write_sweep};
use skilltree::record::tables::write_evaluations;
use skilltree::record::{EvaluationRow, Names, Provenance, RunFolder, Sweep};
use skilltree::report::statistics::Survival;
use skilltree::report::summary::{Diverged, Summary, summarise};
use skilltree::report::sweep::{Surface, Swept, effect, levels, replays};
use skilltree::report::{text, write};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const COLUMNS: u32 = 6;
const ROWS: u32 = 5;
const SEEDS: u32 = 24;
const TESTS: [u32; 8] = [0, 25, 50, 100, 150, 200, 250, 300];

/// Successes of 40 at the last test: highest at column 2 and row 3, with noise, and every fourth seed is weak.
fn peak(column: u32, row: u32, seed: u32) -> u32 {
    let away = 2 * (i64::from(column) - 2).pow(2) + (i64::from(row) - 3).pow(2);
    let (i, j, s) = (i64::from(column), i64::from(row), i64::from(seed));
    let noise = (s * 7 + i * 13 + j * 29 + (s * s) % 11 * 3) % 19 - 9;
    let weak = if seed % 4 == 3 { 6 } else { 0 };
    (39 - away + noise - weak).clamp(0, 40) as u32
}

/// Rows of a sweep: `last` gives the successes of 40 at the last test of an arm, point and seed, and how many trials
/// half of the learning takes; none where there are no tests.
fn rows(arms: u32, points: u32, seeds: u32, last: impl Fn(u32, u32, u32) -> Option<(u32, u32)>) -> Vec<EvaluationRow> {
    let mut rows = Vec::new();
    for (arm, point, seed) in
        (0..arms).flat_map(|arm| (0..points).flat_map(move |point| (0..seeds).map(move |seed| (arm, point, seed))))
    {
        let Some((last, slow)) = last(arm, point, seed) else { continue };
        for trials in TESTS {
            let successes = last * trials * (300 + slow) / (300 * (trials + slow));
            let steps = 200 * 40 - 150 * successes;
            rows.push(EvaluationRow {
                arm,
                point,
                seed,
                skill: 0,
                trials,
                actions: 100 + 60 * trials,
                variant: 0,
                room: 0,
                episodes: 40,
                successes,
                steps,
                reward: f64::from(successes),
                returned: f64::from(successes),
                collisions: 0,
            });
        }
    }
    rows
}

fn names(arms: &[&str]) -> Names {
    let words = |list: &[&str]| list.iter().map(|word| (*word).to_owned()).collect();
    Names { arms: words(arms), skills: words(&["recharge"]), variants: words(&["trained"]), rooms: words(&["A"]) }
}

fn axis(key: &str, label: &str, scale: Scale, values: &[f64]) -> Axis {
    let values = values.iter().map(|value| AxisValue::Number(*value)).collect();
    Axis { key: key.into(), label: label.into(), scale, values }
}

/// All combinations, the last axis fastest.
fn grid(axes: Vec<Axis>) -> Sweep {
    let mut points = vec![Vec::new()];
    for axis in &axes {
        let longer = |point: &Vec<AxisValue>| {
            axis.values.iter().map(|value| point.iter().chain([value]).cloned().collect()).collect::<Vec<_>>()
        };
        points = points.iter().flat_map(longer).collect();
    }
    Sweep { design: Design::Grid, axes, points }
}

fn thresholds() -> Sweep {
    grid(vec![
        axis("skill.recharge.applicable.dock", "dock threshold", Scale::Log, &[0.01, 0.02, 0.05, 0.1, 0.2, 0.5]),
        axis("learning.rate", "rate", Scale::Linear, &[0.1, 0.2, 0.3, 0.4, 0.5]),
    ])
}

/// The arm `hierarchical` on the grid, and `monolithic`, which has none of its keys, at the first point alone.
fn known() -> (Names, Vec<EvaluationRow>) {
    let last = |arm: u32, point: u32, seed: u32| {
        let (column, row) = (point / ROWS, point % ROWS);
        (arm == 0 || point == 0).then(|| (peak(column, row, seed), 20 + 15 * column))
    };
    (names(&["hierarchical", "monolithic"]), rows(2, COLUMNS * ROWS, SEEDS, last))
}

fn summary(names: &Names, rows: &[EvaluationRow], seeds: u32, diverged: &[Diverged]) -> Summary {
    summarise(names, rows, &(0..seeds).collect::<Vec<_>>(), diverged)
}

fn swept() -> Swept {
    let (names, rows) = known();
    let seeds: Vec<u32> = (0..SEEDS).collect();
    Swept::new(thresholds(), &summary(&names, &rows, SEEDS, &[]), &seeds)
}

fn folder(dir: &Path, sweep: &Sweep, names: &Names, rows: &[EvaluationRow], seeds: u32) {
    let provenance = Provenance { backend: "cpu".into(), seeds: (0..seeds).collect(), ..Provenance::default() };
    let files = [
        ("evaluations.parquet".to_owned(), write_evaluations(rows, names).unwrap()),
        (FILE.to_owned(), write_sweep(sweep).unwrap()),
    ];
    RunFolder::open(dir, "", &[("world.toml", OFFICE)]).unwrap().finish(files, provenance).unwrap();
}

/// NumPy: 200,000 multinomial resamples of the seeds, shared by all points.
#[test]
fn the_optimum_and_its_uncertainty_are_found() {
    let swept = swept();
    let surface: &Surface = &swept.surfaces[0];
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
    let (columns, rows) = (levels(&swept.sweep, surface, 0), levels(&swept.sweep, surface, 1));
    let means =
        [0.6670833333333334, 0.78625, 0.8554166666666667, 0.794375, 0.656875, 0.4275].map(|mean: f64| (mean, 5));
    assert_eq!(columns.len(), 6);
    for (level, (mean, points)) in columns.iter().zip(means) {
        close(level.mean().0, mean, 1e-12);
        assert_eq!((level.points.len(), level.learners.len()), (points, points * SEEDS as usize));
    }
    assert_eq!(columns[2].label, "0.05");
    let (highest, lowest, difference, interval) = effect(&columns).unwrap();
    assert_eq!((highest, lowest), (2, 5));
    close(difference, 0.42791666666666667, 1e-12);
    close(interval.low, 0.40875, 0.0015);
    close(interval.high, 0.44854167, 0.0015);
    close(rows[3].mean().0, 0.7697916666666667, 1e-12);
    assert_eq!(effect(&rows).unwrap().1, 0);
    assert!(effect(&[]).is_none());
}

/// lifelines 0.30.3: KaplanMeierFitter on the same trials to criterion.
#[test]
fn trials_to_criterion_are_censored_at_the_last_test() {
    let swept = swept();
    let surface = &swept.surfaces[0];
    let best = Survival::new(&surface.best().seen);
    assert_eq!((best.count, best.reached, best.end), (24, 16, 300.0));
    let lifelines = [
        (200.0, 0.541667, 0.327120, 0.714341),
        (250.0, 0.500000, 0.290977, 0.677609),
        (300.0, 0.333333, 0.159025, 0.518707),
    ];
    assert_eq!(best.steps.len(), lifelines.len());
    for (step, (time, share, low, high)) in best.steps.iter().zip(lifelines) {
        assert_eq!(step.time, time);
        close(step.survival, share, 1e-6);
        close(step.band.low, low, 1e-6);
        close(step.band.high, high, 1e-6);
    }
    assert_eq!((best.quantile(0.5), best.quantile_interval(0.5)), (Some(250.0), (Some(200.0), None)));
    let column = Survival::new(&levels(&swept.sweep, surface, 0)[2].seen);
    assert_eq!((column.count, column.reached), (120, 59));
    close(column.steps.last().unwrap().survival, 0.508333, 1e-6);
}

#[test]
fn the_worst_learners_come_with_their_commands() {
    let swept = swept();
    let listed = replays(&swept, Path::new("runs/my sweep"));
    let at_best: Vec<_> =
        listed.iter().filter(|replay| replay.arm == "hierarchical" && replay.point == 12).take(5).collect();
    let seeds: Vec<u32> = at_best.iter().map(|replay| replay.seed).collect();
    assert_eq!(seeds, [23, 12, 14, 6, 11]);
    close(at_best[0].value.unwrap(), 0.6, 1e-12);
    assert_eq!(
        at_best[0].command,
        "skilltree run 'runs/my sweep/config.toml' --arm hierarchical --point 12 --seeds 23 --out \
         'runs/my sweep-hierarchical-p12-23'"
    );
    let each: BTreeSet<_> = listed.iter().map(|replay| (&replay.arm, replay.point, replay.seed)).collect();
    assert_eq!((each.len(), listed.len()), (20, 20));
    let here = replays(&swept, Path::new("runs/quick/"));
    assert!(here[0].command.ends_with("--out runs/quick-hierarchical-p12-23"), "{}", here[0].command);
}

#[test]
fn the_page_and_the_terminal_say_what_was_found() {
    let dir = scratch("report-sweep");
    let (names, rows) = known();
    folder(&dir, &thresholds(), &names, &rows, SEEDS);
    let written = write(&dir).unwrap();
    let files: Vec<_> = written.iter().map(|path| path.strip_prefix(&dir).unwrap().to_str().unwrap()).collect();
    for name in [
        "sweep-hierarchical-skill-recharge-applicable-dock-learning-rate",
        "sweep-hierarchical-values-learning-rate",
        "sweep-hierarchical-profile-skill-recharge-applicable-dock",
        "sweep-hierarchical-criterion-learning-rate",
    ] {
        assert!(files.contains(&format!("figures/{name}.svg").as_str()), "{name}: {files:?}");
    }
    assert!(!files.iter().any(|file| file.contains("sweep-monolithic")), "{files:?}");
    // Curves of one point of each arm, not of thirty.
    let curves = fs::read_to_string(dir.join("figures/learning-recharge.svg")).unwrap();
    assert!(curves.contains("hierarchical, point 0") && !curves.contains("point 1"));
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    for said in [
        "30 points, a grid, over 2 axes",
        "The highest mean is at point 12 (dock threshold 0.05, rate 0.3): 90.5% [",
        "monolithic, whose only point is 0",
        "n = 24 seeds",
        "percentile bootstrap",
        "--arm hierarchical --point 12 --seeds 23 --out report-sweep-hierarchical-p12-23",
        "<td>16 of 24</td><td>250 [200, more than 300]</td>",
        "each arm at its first point alone",
    ] {
        assert!(page.contains(said), "{said}");
    }
    assert!(!page.contains("NaN") && !page.contains("inf"));
    let said = text(&dir).unwrap();
    assert!(said.contains("best: point 12 (dock threshold 0.05, rate 0.3): 90.5% ["), "{said}");
    assert!(said.contains("dock threshold: from 42.7% at 0.5 to 85.5% at 0.05: +42.8 ["), "{said}");
    assert!(said.contains("16 of 24 seeds reach 90%; median trials 250 [200, more than 300]"), "{said}");
    assert_eq!(write(&dir).unwrap(), written);
    assert_eq!(fs::read_to_string(dir.join("report.html")).unwrap(), page);
}

/// Three axes: margins over the third for each pair, and slices of the first pair; one axis is of words.
#[test]
fn further_axes_are_margins_and_slices() {
    let dir = scratch("report-sweep-three");
    let worlds = Axis {
        key: "world".into(),
        label: "office".into(),
        scale: Scale::List,
        values: ["worlds/office.toml", "worlds/office-hard.toml"].map(|file| AxisValue::Text(file.into())).into(),
    };
    let mut axes = thresholds().axes;
    axes.push(worlds);
    let names = names(&["hierarchical"]);
    let rows = rows(1, 60, 8, |_, point, seed| {
        let (cell, hard) = (point / 2, point % 2);
        Some((peak(cell / ROWS, cell % ROWS, seed).saturating_sub(8 * hard), 40))
    });
    let sweep = grid(axes);
    folder(&dir, &sweep, &names, &rows, 8);
    let written = write(&dir).unwrap();
    let maps = |part: &str| written.iter().filter(|path| path.display().to_string().contains(part)).count();
    assert_eq!((maps("-slice-"), maps("applicable-dock-world."), maps("learning-rate-world.")), (4, 2, 2));
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(page.contains("At office office-hard.") && page.contains("mean over up to 2 points on the other axes"));
    assert!(text(&dir).unwrap().contains("Only 8 seeds"));
    let swept = Swept::new(sweep, &summary(&names, &rows, 8, &[]), &(0..8).collect::<Vec<_>>());
    let offices = levels(&swept.sweep, &swept.surfaces[0], 2);
    assert_eq!(offices.iter().map(|level| level.label.as_str()).collect::<Vec<_>>(), ["office", "office-hard"]);
    assert_eq!(offices[1].points.len(), 30);
}

/// Points drawn at random, one axis logarithmic: classes of equally many points, and a dot for each.
#[test]
fn random_points_are_put_into_classes() {
    let values: Vec<(f64, f64)> =
        (0..40).map(|i| (10_f64.powf(f64::from(i * 7 % 40) / 20.0 - 3.0), f64::from(i * 13 % 40) / 40.0)).collect();
    let ascending = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values
    };
    let sweep = Sweep {
        design: Design::Random,
        axes: vec![
            axis("learning.rate", "rate", Scale::Log, &ascending(values.iter().map(|point| point.0).collect())),
            axis("learning.lambda", "lambda", Scale::Linear, &ascending(values.iter().map(|point| point.1).collect())),
        ],
        points: values.iter().map(|(a, b)| vec![AxisValue::Number(*a), AxisValue::Number(*b)]).collect(),
    };
    let names = names(&["hierarchical"]);
    // Better the nearer the rate is to 0.01, whatever lambda is.
    let rows = rows(1, 40, 12, |_, point, seed| {
        let away = (values[point as usize].0.log10() + 2.0).abs();
        Some(((38.0 - 25.0 * away) as u32 - (seed + point) % 5, 30))
    });
    let swept = Swept::new(sweep.clone(), &summary(&names, &rows, 12, &[]), &(0..12).collect::<Vec<_>>());
    let rates = levels(&sweep, &swept.surfaces[0], 0);
    assert!(rates.len() == 5 && rates.iter().all(|level| level.points.len() == 8));
    assert_eq!(effect(&rates).unwrap().0, 2);
    let lambdas = levels(&sweep, &swept.surfaces[0], 1);
    // NumPy, on the same numbers.
    close(effect(&rates).unwrap().2, 0.44921875, 1e-12);
    close(effect(&lambdas).unwrap().2, 0.030468750000000044, 1e-12);
    let best = swept.surfaces[0].best().number as usize;
    assert!((values[best].0.log10() + 2.0).abs() < 0.11, "{}", values[best].0);
    let dir = scratch("report-sweep-random");
    folder(&dir, &sweep, &names, &rows, 12);
    write(&dir).unwrap();
    let svg = fs::read_to_string(dir.join("figures/sweep-hierarchical-learning-rate-learning-lambda.svg")).unwrap();
    // A rim and a fill for each point.
    assert!(svg.matches("<circle").count() >= 80);
    assert!(svg.contains(">\n0.001\n<") && svg.contains(">\n0.1\n<"));
}

fn diverged(point: u32, seed: u32) -> Diverged {
    Diverged { arm: "hierarchical".into(), point, seed, skill: "recharge".into(), trial: 60 }
}

/// One learner stops after its second test, at another point all do.
#[test]
fn learners_that_diverged_count_as_failed() {
    let (names, mut rows) = known();
    rows.retain(|row| !(row.arm == 0 && row.point == 12 && row.seed == 5 && row.trials > 25));
    rows.retain(|row| !(row.arm == 0 && row.point == 3 && row.trials > 50));
    let mut failures = vec![diverged(12, 5)];
    failures.extend((0..SEEDS).map(|seed| diverged(3, seed)));
    let summary = summary(&names, &rows, SEEDS, &failures);
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
    let cautions = summary.cautions();
    assert!(
        cautions.iter().any(|text| text.contains("25 learners diverged") && text.contains("20 more")),
        "{cautions:?}"
    );
    let series = &summary.skills[0].series[12];
    assert_eq!((series.point, series.cells.len()), (12, TESTS.len()));
    let score = series.last().scores[5];
    // As long as the longest mean trial of any test: 200 steps, where none was achieved.
    assert_eq!((score.seed, score.episodes, score.successes, score.steps), (5, 40, 0, 8_000));
    assert_eq!(score.actions, 100 + 60 * 25);
    assert_eq!(series.cells[1].scores[5].successes, u64::from(peak(2, 2, 5) * 25 * 350 / (300 * 75)));
    let seeds: Vec<u32> = (0..SEEDS).collect();
    let swept = Swept::new(thresholds(), &summary, &seeds);
    let surface = &swept.surfaces[0];
    assert_eq!((surface.points.len(), surface.selection.means[3]), (30, 0.0));
    close(surface.selection.means[12], 0.9052083333333334 - f64::from(peak(2, 2, 5)) / 40.0 / 24.0, 1e-12);
    let seen = surface.points[12].seen[5];
    assert_eq!((seen.time, seen.reached), (300.0, false));
    let listed = replays(&swept, Path::new("run"));
    assert_eq!(
        listed[0].command,
        "skilltree run run/config.toml --arm hierarchical --point 12 --seeds 5 --out run-hierarchical-p12-5"
    );
}

#[test]
fn failures_are_read_from_the_run() {
    let (names, mut rows) = known();
    rows.retain(|row| !(row.arm == 0 && row.point == 12 && row.seed == 5 && row.trials > 25));
    let dir = scratch("report-sweep-failures");
    let failures =
        r#"[{"arm":"hierarchical","point":12,"seed":5,"skill":"recharge","trial":31,"what":"a weight is NaN"}]"#;
    let provenance = Provenance { seeds: (0..SEEDS).collect(), ..Provenance::default() };
    let files = [
        ("evaluations.parquet".to_owned(), write_evaluations(&rows, &names).unwrap()),
        ("failures.json".to_owned(), failures.as_bytes().to_vec()),
        (FILE.to_owned(), write_sweep(&thresholds()).unwrap()),
    ];
    RunFolder::open(&dir, "", &[("world.toml", OFFICE)]).unwrap().finish(files, provenance).unwrap();
    let said = text(&dir).unwrap();
    assert!(said.contains("1 learner diverged") && said.contains("seed 5 in trial 31 of recharge"), "{said}");
    assert!(said.contains("    diverged\n      skilltree run "), "{said}");
}

#[test]
fn points_that_lack_seeds_are_left_out_and_named() {
    let (names, mut rows) = known();
    rows.retain(|row| !(row.arm == 0 && row.point == 12 && row.seed == 5));
    let dir = scratch("report-sweep-lacking");
    folder(&dir, &thresholds(), &names, &rows, SEEDS);
    write(&dir).unwrap();
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(page.contains("left out: hierarchical, point 12 (23 seeds have tests)"));
    assert!(page.contains("The highest mean is at point 8 "));
    assert!(text(&dir).unwrap().contains("left out, as seeds are missing: hierarchical, point 12 (23 seeds"));
}

/// Ten thousand learners: 100 points of four axes with 100 seeds.
#[test]
fn a_large_sweep_has_a_small_page() {
    let dir = scratch("report-sweep-large");
    let values = |count: u32| (0..count).map(|i| 0.1 * f64::from(i + 1)).collect::<Vec<_>>();
    let axes = [("a", 5), ("b", 5), ("c", 2), ("d", 2)];
    let sweep = grid(axes.iter().map(|&(key, count)| axis(key, key, Scale::Linear, &values(count))).collect());
    let names = names(&["hierarchical"]);
    let rows = rows(1, 100, 100, |_, point, seed| Some((peak(point / 20, point / 4 % 5, seed), 20 + point % 4)));
    assert_eq!(rows.len(), 10_000 * TESTS.len());
    folder(&dir, &sweep, &names, &rows, 100);
    write(&dir).unwrap();
    let bytes = fs::metadata(dir.join("report.html")).unwrap().len();
    assert!((200_000..5_000_000).contains(&bytes), "{bytes} bytes");
}
