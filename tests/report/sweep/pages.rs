//! Pages of sweeps of several designs.

use super::{ROWS, SEEDS, TESTS, axis, folder, grid, known, names, peak, rows, summary, thresholds};
use crate::{OFFICE, close, scratch};
use skilltree::report::sweep::{SweepResults, main_effect};
use skilltree::report::write;
use skilltree::run_folder::sweep::{Axis, AxisValue, Design, Scale};
use skilltree::run_folder::tables::write_table;
use skilltree::run_folder::{JsonFile, Provenance, RunFolder, Sweep};
use std::fs;

#[test]
fn the_page_and_the_terminal_say_what_was_found() {
    let dir = scratch("report-sweep");
    let (_, rows) = known();
    folder(&dir, &thresholds(), &rows, SEEDS);
    let written = write(&dir).unwrap();
    let files: Vec<_> = written.files.iter().map(|path| path.strip_prefix(&dir).unwrap().to_str().unwrap()).collect();
    for name in [
        "sweep-hierarchical-skill-recharge-applicable-dock-learning-learning_rate",
        "sweep-hierarchical-values-learning-learning_rate",
        "sweep-hierarchical-profile-skill-recharge-applicable-dock",
        "sweep-hierarchical-criterion-learning-learning_rate",
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
    let said = &written.summary;
    assert!(said.contains("best: point 12 (dock threshold 0.05, rate 0.3): 90.5% ["), "{said}");
    assert!(said.contains("dock threshold: from 42.7% at 0.5 to 85.5% at 0.05: +42.8 ["), "{said}");
    assert!(said.contains("16 of 24 seeds reach 90%; median trials 250 [200, more than 300]"), "{said}");
    // The page names the run folder alone, the terminal its path.
    let command = format!("skilltree run {}/config.toml --arm hierarchical --point 12 --seeds 23", dir.display());
    assert!(said.contains(&command) && !page.contains(&command), "{said}");
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
    folder(&dir, &sweep, &rows, 8);
    let written = write(&dir).unwrap();
    let maps = |part: &str| written.files.iter().filter(|path| path.display().to_string().contains(part)).count();
    assert_eq!((maps("-slice-"), maps("applicable-dock-world."), maps("learning_rate-world.")), (2, 1, 1));
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(page.contains("At office office-hard.") && page.contains("mean over up to 2 points on the other axes"));
    assert!(written.summary.contains("Only 8 seeds"));
    let swept = SweepResults::new(sweep, &summary(&names, &rows, 8, &[]), &(0..8).collect::<Vec<_>>());
    let offices = swept.surfaces[0].levels(2);
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
            axis(
                "learning.learning_rate",
                "rate",
                Scale::Log,
                &ascending(values.iter().map(|point| point.0).collect()),
            ),
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
    let swept = SweepResults::new(sweep.clone(), &summary(&names, &rows, 12, &[]), &(0..12).collect::<Vec<_>>());
    let rates = swept.surfaces[0].levels(0);
    assert!(rates.len() == 5 && rates.iter().all(|level| level.points.len() == 8));
    assert_eq!(main_effect(&rates).unwrap().highest, 2);
    let lambdas = swept.surfaces[0].levels(1);
    // NumPy, on the same numbers.
    close(main_effect(&rates).unwrap().difference.value, 0.44921875, 1e-12);
    close(main_effect(&lambdas).unwrap().difference.value, 0.030468750000000044, 1e-12);
    let best = swept.surfaces[0].best().number as usize;
    assert!((values[best].0.log10() + 2.0).abs() < 0.11, "{}", values[best].0);
    let dir = scratch("report-sweep-random");
    folder(&dir, &sweep, &rows, 12);
    write(&dir).unwrap();
    let svg =
        fs::read_to_string(dir.join("figures/sweep-hierarchical-learning-learning_rate-learning-lambda.svg")).unwrap();
    // A rim and a fill for each point.
    assert!(svg.matches("<circle").count() >= 80);
    assert!(svg.contains(">0.001<") && svg.contains(">0.1<"));
}

#[test]
fn failures_are_read_from_the_run() {
    let (_, mut rows) = known();
    rows.retain(|row| !(row.arm == "hierarchical" && row.point == 12 && row.seed == 5 && row.trials > 25));
    let dir = scratch("report-sweep-failures");
    let failures =
        r#"[{"arm":"hierarchical","point":12,"seed":5,"skill":"recharge","trial":31,"what":"a weight is NaN"}]"#;
    let provenance = Provenance { seeds: (0..SEEDS).collect(), ..Provenance::default() };
    let files = [
        ("evaluations.parquet".to_owned(), write_table(&rows).unwrap()),
        ("failures.json".to_owned(), failures.as_bytes().to_vec()),
        (Sweep::NAME.to_owned(), thresholds().to_bytes().unwrap()),
    ];
    RunFolder::open(&dir, "", &[("world.toml", OFFICE)]).unwrap().finish(files, provenance).unwrap();
    let said = write(&dir).unwrap().summary;
    assert!(said.contains("1 learner diverged") && said.contains("seed 5 in trial 31 of recharge"), "{said}");
    assert!(said.contains("    diverged\n      skilltree run "), "{said}");
}

#[test]
fn points_that_lack_seeds_are_left_out_and_named() {
    let (_, mut rows) = known();
    rows.retain(|row| !(row.arm == "hierarchical" && row.point == 12 && row.seed == 5));
    let dir = scratch("report-sweep-lacking");
    folder(&dir, &thresholds(), &rows, SEEDS);
    let said = write(&dir).unwrap().summary;
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(page.contains("left out: hierarchical, point 12 (23 seeds have tests)"));
    assert!(page.contains("The highest mean is at point 8 "));
    assert!(said.contains("left out, as seeds are missing: hierarchical, point 12 (23 seeds"));
}

/// Ten thousand learners: 100 points of four axes with 100 seeds.
#[test]
fn a_large_sweep_has_a_small_page() {
    let dir = scratch("report-sweep-large");
    let values = |count: u32| (0..count).map(|i| 0.1 * f64::from(i + 1)).collect::<Vec<_>>();
    let axes = [("a", 5), ("b", 5), ("c", 2), ("d", 2)];
    let sweep = grid(axes.iter().map(|&(key, count)| axis(key, key, Scale::Linear, &values(count))).collect());
    let rows = rows(1, 100, 100, |_, point, seed| Some((peak(point / 20, point / 4 % 5, seed), 20 + point % 4)));
    assert_eq!(rows.len(), 10_000 * TESTS.len());
    folder(&dir, &sweep, &rows, 100);
    write(&dir).unwrap();
    let bytes = fs::metadata(dir.join("report.html")).unwrap().len();
    assert!((200_000..5_000_000).contains(&bytes), "{bytes} bytes");
}
