//! Reports: figures with ink in them, a page that stands alone.
#![cfg(feature = "report")]

mod claims;
mod comparison;
mod drawing;
mod hand_made_tables;
mod pages;
mod sweep;

use glam::Vec2;
use skilltree::report::bootstrap_rng::BootstrapRng;
use skilltree::report::figure::spread;
use skilltree::report::summary::summarise;
use skilltree::report::{ReportError, write};
use skilltree::run_folder::tables::write_table;
use skilltree::run_folder::{EvaluationRow, JsonFile, Names, PlaceReading, Provenance, RecordError, RunFolder, Sums};
use skilltree::world::{Pose, World, load};
use std::fs;
use std::path::{Path, PathBuf};

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

const OFFICE: &str = include_str!("../../configs/worlds/office.toml");
const ARMS: [&str; 5] = ["hierarchical", "monolithic", "no-persistence", "no-teaching", "fixed-switch"];
const SKILLS: [&str; 2] = ["dock", "recharge"];
const MOMENTS: [u32; 13] = [0, 10, 25, 50, 75, 100, 125, 150, 175, 200, 225, 250, 300];

/// Five arms that learn at different speeds, tested 13 times from three rooms, all but `monolithic` in docking first;
/// the planner last.
fn synthetic(seeds: u32) -> (Names, Vec<EvaluationRow>) {
    let words = |list: &[&str]| list.iter().map(|word| word.to_string()).collect::<Vec<_>>();
    let (variants, rooms) = (words(&["trained"]), words(&["A", "B", "C"]));
    let mut names = Names { arms: words(&ARMS), skills: words(&SKILLS), variants, rooms };
    let mut draws = BootstrapRng::new(1);
    let mut rows = Vec::new();
    for (arm, skill, seed) in (0..5).flat_map(|a| (0..2).flat_map(move |k| (0..seeds).map(move |s| (a, k, s)))) {
        if (arm, skill) == (1, 0) {
            continue;
        }
        let speed = [30.0, 110.0, 45.0, 90.0, 38.0][arm as usize] * (0.6 + draws.index(100) as f64 / 125.0);
        for (trials, room) in MOMENTS.iter().flat_map(|&trials| (0..3).map(move |room| (trials, room))) {
            let skilled = 0.97 * (1.0 - (-f64::from(trials) / speed).exp());
            let successes = (0..40).filter(|_| (draws.index(1000) as f64) < 1000.0 * skilled).count() as u32;
            let steps = 40 * 200 - successes * (200 - 34 - 5 * room);
            rows.push(EvaluationRow {
                arm: ARMS[arm as usize].to_owned(),
                point: 0,
                seed,
                skill: SKILLS[skill].to_owned(),
                trials,
                actions: 400 + trials * (30 + 60 * arm) + seed,
                variant: "trained".to_owned(),
                room: names.rooms[room as usize].clone(),
                episodes: 40,
                successes,
                steps,
                reward: f64::from(successes) * 100.0,
                r#return: f64::from(successes) * 40.0,
                collisions: steps / 25,
            });
        }
    }
    names.arms.push("planner".into());
    for (skill, room) in [(0, 0), (1, 0), (1, 1), (1, 2)] {
        let steps = 27_500 + room * 900;
        let sums = Sums { episodes: 1000, successes: 998, steps, collisions: 0, reward: 99_800.0, returned: 40_000.0 };
        let row = EvaluationRow {
            arm: "planner".to_owned(),
            skill: SKILLS[skill].to_owned(),
            variant: "trained".to_owned(),
            room: names.rooms[room as usize].clone(),
            ..EvaluationRow::default()
        };
        rows.push(row.with_sums(sums));
    }
    (names, rows)
}

/// Sonar by plain ray casting; light in a cone ahead.
fn readings(world: &World) -> Vec<PlaceReading> {
    let ray = |from: Vec2, degrees: f32| {
        let direction = Vec2::from_angle(degrees.to_radians());
        let hits = world.segments.iter().filter_map(|wall| {
            let (along, gap) = (wall.b - wall.a, wall.a - from);
            let cross = direction.perp_dot(along);
            let (t, u) = (gap.perp_dot(along) / cross, gap.perp_dot(direction) / cross);
            (t > 0.0 && (0.0..=1.0).contains(&u)).then_some(t)
        });
        hits.fold(127.0, f32::min) as u32
    };
    let reading = |(name, pose): &(String, Pose)| PlaceReading {
        place: name.clone(),
        x: pose.x,
        y: pose.y,
        heading: pose.heading,
        sonar: std::array::from_fn(|i| ray(Vec2::new(pose.x, pose.y), pose.heading + 15.0 * i as f32)),
        light: std::array::from_fn(|i| u8::from(!(3..=21).contains(&i))),
    };
    world.places.iter().map(reading).collect()
}

fn run_folder(dir: &Path, seeds: u32) {
    let (_, rows) = synthetic(seeds);
    let world = load::parse(OFFICE, Path::new("world.toml")).unwrap();
    let config = "title = \"Synthetic: five <arms> & a planner\"\nseeds = \"0..31\"\n";
    let provenance = Provenance {
        version: "0.1.0".into(),
        commit: Some("0123456789ab".into()),
        backend: "cpu".into(),
        seeds: (0..seeds).collect(),
        started: Some("2026-11-22T08:00:00Z".into()),
        ..Provenance::default()
    };
    let files = [
        ("evaluations.parquet".to_owned(), write_table(&rows).unwrap()),
        ("places.json".to_owned(), readings(&world).to_bytes().unwrap()),
    ];
    RunFolder::open(dir, config, &[("world.toml", OFFICE)]).unwrap().finish(files, provenance).unwrap();
}

/// Lies in the build folder, so that one can look at it after the test.
fn scratch(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&dir);
    dir
}

#[test]
fn a_report_is_complete_and_the_same_every_time() {
    let dir = scratch("report-32");
    run_folder(&dir, 32);
    let written = write(&dir).unwrap();
    let names: Vec<_> = written.files.iter().map(|path| path.strip_prefix(&dir).unwrap().to_str().unwrap()).collect();
    for name in [
        "profile-dock",
        "learning-dock",
        "steps-dock",
        "actions-recharge",
        "figure-2b-paper",
        "world",
        "sonar-L1",
        "light-L2",
    ] {
        assert!(names.contains(&format!("figures/{name}.svg").as_str()), "{names:?}");
    }
    // Figure 2 (only its tests), equal cost, rooms; two skills; the world and its places.
    assert_eq!((names.len(), names.last()), (2 + 4 + 2 + 2 * 4 + 1 + 3 * 2 + 1, Some(&"report.html")));
    let bytes: Vec<_> = written.files.iter().map(|path| fs::read(path).unwrap()).collect();
    assert_eq!(write(&dir).unwrap(), written);
    for (path, bytes) in written.files.iter().zip(&bytes) {
        assert!(fs::read(path).unwrap() == *bytes, "{}", path.display());
        if path.extension().is_some_and(|ending| ending == "svg") {
            drawing::check(&String::from_utf8_lossy(bytes), path);
        }
    }
}

#[test]
fn the_page_stands_alone_and_says_what_it_must() {
    let dir = scratch("report-7");
    run_folder(&dir, 7);
    write(&dir).unwrap();
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    for fetch in ["http:", "https:", "src=", "href=", "@import", "url("] {
        assert!(!page.contains(fetch), "{fetch}");
    }
    for said in [
        "Synthetic: five &lt;arms&gt; &amp; a planner",
        "Only 7 seeds",
        "0 to 6 (7 seeds)",
        "hierarchical minus monolithic",
        "commit 0123456789ab",
        "n = 7 seeds",
        "performance profile",
        "percentile bootstrap",
        "planner (bound)",
        "until 80% of a seed",
    ] {
        assert!(page.contains(said), "{said}");
    }
    assert!(!page.contains("NaN") && !page.contains("<arms>"));
}

#[test]
fn seeds_that_are_missing_are_said_not_averaged_over() {
    let (names, mut rows) = synthetic(4);
    rows.retain(|row| !(row.arm == ARMS[0] && row.skill == SKILLS[0] && row.trials == 150 && row.seed == 2));
    rows.retain(|row| !(row.arm == ARMS[1] && row.seed == 3));
    let summary = summarise(&names, &rows, &[0, 1, 2, 3], &[]);
    let (dock, recharge) = (&summary.skills[0], &summary.skills[1]);
    assert_eq!((dock.name.as_str(), dock.series.len()), ("dock", 4));
    assert!(dock.series[0].tests.iter().all(|cell| cell.trials != 150 && cell.scores.len() == 4));
    assert_eq!((recharge.series[1].label.as_str(), recharge.series[1].last().scores.len()), ("monolithic", 3));
    assert_eq!(dock.bounds[0].score.episodes, 1000);
    assert_eq!(recharge.bounds[0].score.episodes, 3000);
    assert!(
        summary.warnings.iter().any(|text| text.contains("after 150 trials, where 3 of 4")),
        "{:?}",
        summary.warnings
    );
    assert!(summary.warnings.iter().any(|text| text.contains("1 of 4 seeds have no tests")), "{:?}", summary.warnings);
    let reached = dock.series[0].trials_to(0.8);
    assert!(
        reached.len() == 4 && reached.iter().all(|trials| trials.is_some_and(|trials| trials <= 175)),
        "{reached:?}"
    );
    assert_eq!(summary.skills[0].series[0].trials_to(1.01), [None; 4]);
    let by_hand: u32 = rows
        .iter()
        .filter(|row| row.arm == ARMS[4] && row.skill == SKILLS[1] && row.trials == 300 && row.seed == 2)
        .map(|row| row.successes)
        .sum();
    close(recharge.series[4].last().scores[2].success(), f64::from(by_hand) / 120.0, 1e-15);
}

#[test]
fn sweep_points_are_series_of_their_own() {
    let (names, mut rows) = synthetic(2);
    rows.retain(|row| row.arm == ARMS[0]);
    let mut second = rows.clone();
    second.iter_mut().for_each(|row| row.point = 1);
    rows.extend(second);
    let labels: Vec<_> =
        summarise(&names, &rows, &[0, 1], &[]).skills[0].series.iter().map(|series| series.label.clone()).collect();
    assert_eq!(labels, ["hierarchical, point 0", "hierarchical, point 1"]);
}

#[test]
fn runs_that_cannot_be_reported_say_why() {
    let dir = scratch("report-wrong");
    let missing = write(&dir).unwrap_err().to_string();
    assert!(missing.contains("report-wrong"), "{missing}");
    drop(RunFolder::open(&dir, "", &[("world.toml", OFFICE)]).unwrap());
    assert!(matches!(write(&dir), Err(ReportError::Record(RecordError::Unfinished { .. }))));
    let run = RunFolder::open(&dir, "", &[("world.toml", OFFICE)]).unwrap();
    run.finish([], Provenance::default()).unwrap();
    write(&dir).unwrap();
    assert!(fs::read_to_string(dir.join("report.html")).unwrap().contains("The run holds no tests"));
    let dir = scratch("report-worldless");
    RunFolder::open(&dir, "", &[("world.toml", "size = 3\n")]).unwrap().finish([], Provenance::default()).unwrap();
    let refused = write(&dir).unwrap_err().to_string();
    assert!(refused.contains("world.toml") && refused.contains("size"), "{refused}");
}

#[test]
fn labels_keep_their_distance() {
    let placed = spread(&[10.0, 11.0, 12.0, 80.0, 99.0, 100.0], 10.0, (0.0, 100.0));
    assert!(placed.windows(2).all(|pair| pair[1] - pair[0] >= 10.0 - 1e-9), "{placed:?}");
    assert!(placed[0] >= 0.0 && placed[5] <= 100.0, "{placed:?}");
    assert_eq!(spread(&[5.0, 50.0], 10.0, (0.0, 100.0)), [5.0, 50.0]);
    assert!(spread(&[], 10.0, (0.0, 100.0)).is_empty());
}
