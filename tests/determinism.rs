//! The same experiment leaves the same bytes, however it is carried out and however often it is killed.

mod support;

use skilltree::run_folder::tables::{EVALUATIONS, TRIALS, read_evaluations, read_trials};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use support::{skilltree, tiny, tree};
use tempfile::TempDir;

/// Longer than any step of a tiny run takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

fn run(out: &Path, more: &[&str]) {
    let output = tiny(out, more).output().unwrap();
    assert!(output.status.success(), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Every file but those that say how and where the run was carried out. What the manifest says of them must be true.
fn results(out: &Path) -> BTreeMap<String, Vec<u8>> {
    skilltree::run_folder::FinishedRun::read(out).unwrap();
    let mut files = tree(out);
    assert!(
        files.keys().all(|name| !["skilltree-tmp", "parts", "checkpoint"].iter().any(|kept| name.contains(kept))),
        "{:?}",
        files.keys()
    );
    for name in ["manifest.json", "report.html", ".lock", ".skilltree"] {
        assert!(files.remove(name).is_some(), "no {name}");
    }
    assert!([TRIALS, EVALUATIONS, "places.json", "config.toml"].iter().all(|name| files.contains_key(*name)));
    files
}

#[track_caller]
fn assert_same(left: &BTreeMap<String, Vec<u8>>, right: &BTreeMap<String, Vec<u8>>, what: &str) {
    let names: Vec<&String> = left.keys().chain(right.keys()).collect();
    let differing: Vec<_> = names.into_iter().filter(|name| left.get(*name) != right.get(*name)).collect();
    assert!(differing.is_empty(), "{what}: these differ: {differing:?}");
}

#[test]
fn no_way_of_carrying_it_out_changes_a_byte() {
    let dir = TempDir::new().unwrap();
    let base = dir.path().join("base");
    run(&base, &["--seeds", "0..3", "--threads", "2"]);
    let expected = results(&base);
    assert_eq!(expected.keys().filter(|name| name.ends_with(".safetensors")).count(), 15);
    for (number, way) in [
        &["--threads", "1"][..],
        &["--iterations", "1"],
        &["--iterations", "37", "--threads", "3"],
        &["--cohort", "1"],
        &["--cohort", "2"],
        &["--cohort", "15"],
    ]
    .iter()
    .enumerate()
    {
        let out = dir.path().join(number.to_string());
        run(&out, &[&["--seeds", "0..3"], *way].concat());
        assert_same(&expected, &results(&out), &format!("{way:?}"));
    }
    // The resolved config that a run folder holds gives the run again.
    let out = dir.path().join("resolved");
    let line = ["run", "base/config.toml", "--backend", "cpu", "--out"];
    assert!(skilltree(dir.path()).args(line).arg(&out).stderr(Stdio::null()).output().unwrap().status.success());
    assert_same(&expected, &results(&out), "from the resolved config");
}

/// All rows of both tables that pass, names written out, numbers to the last bit.
fn rows(out: &Path, keep: impl Fn(&str, u32) -> bool) -> Vec<String> {
    let (_, trials) = read_trials(&out.join(TRIALS)).unwrap();
    let trials = trials.iter().filter(|row| keep(&row.arm, row.seed));
    let mut rows: Vec<String> = trials.map(|row| format!("{} {row:?}", row.reward.to_bits())).collect();
    let (_, tests) = read_evaluations(&out.join(EVALUATIONS)).unwrap();
    let tests = tests.iter().filter(|row| keep(&row.arm, row.seed));
    rows.extend(tests.map(|row| format!("{} {row:?}", row.reward.to_bits())));
    rows
}

fn weights(out: &Path, arm: &str, seed: u32) -> Vec<u8> {
    fs::read(out.join(format!("skills/{arm}-{seed}.safetensors"))).unwrap()
}

#[test]
fn a_learner_alone_is_the_learner_among_others() {
    let dir = TempDir::new().unwrap();
    let (all, alone, few) = (dir.path().join("all"), dir.path().join("alone"), dir.path().join("few"));
    run(&all, &["--seeds", "0..16"]);
    run(&alone, &["--seeds", "5"]);
    run(&few, &["--seeds", "4,5,9..11", "--set", "arms=['untaught-sgd', 'taught-td0']"]);
    let arms = ["taught-adam", "taught-sgd", "taught-td0", "untaught-adam", "untaught-sgd"];
    let learner = |out: &Path| rows(out, |arm, seed| arms.contains(&arm) && seed == 5);
    // Six trials, taught lessons aside, and three tests per arm at the least.
    assert!(learner(&all).len() >= 5 * (6 + 3), "{}", learner(&all).len());
    assert_eq!(learner(&all), learner(&alone));
    for arm in arms {
        assert!(weights(&all, arm, 5) == weights(&alone, arm, 5), "{arm}");
        assert!(weights(&all, arm, 5) != weights(&all, arm, 6), "{arm}: two seeds, one net");
    }
    assert_ne!(
        rows(&all, |arm, seed| arm == arms[0] && seed == 5),
        rows(&all, |arm, seed| arm == arms[1] && seed == 5)
    );
    let chosen = ["taught-td0", "untaught-sgd"];
    for arm in chosen {
        for seed in [4, 5, 9, 10] {
            let own = |out: &Path| rows(out, |name, number| name == arm && number == seed);
            assert!(own(&all).len() > 8 && own(&all) == own(&few), "{arm} {seed}");
            assert!(weights(&all, arm, seed) == weights(&few, arm, seed), "{arm} {seed}");
        }
    }
    assert!(rows(&few, |arm, _| arm != "planner" && !chosen.contains(&arm)).is_empty());
    // The bound is the same for all.
    let bound = |out: &Path| rows(out, |arm, _| arm == "planner");
    assert!(!bound(&all).is_empty());
    assert_eq!(bound(&all), bound(&alone));
    assert_eq!(bound(&all), bound(&few));
}

/// A run that is going on.
struct Going {
    child: Child,
    out: PathBuf,
}

impl Going {
    fn start(out: &Path, more: &[&str]) -> Self {
        let child = tiny(out, more).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        Self { child, out: out.into() }
    }

    /// Waits until this holds, or the run ends.
    fn until(&mut self, holds: impl Fn(&Path) -> bool) {
        let begun = Instant::now();
        while !holds(&self.out) && self.child.try_wait().unwrap().is_none() {
            assert!(begun.elapsed() < PATIENCE, "the run hangs");
            sleep(Duration::from_micros(500));
        }
    }

    /// Kills it without warning; false if it had ended well before.
    fn kill(mut self) -> bool {
        self.child.kill().unwrap();
        let status = self.child.wait().unwrap();
        assert!(status.code().is_none_or(|code| code == 0), "{status}");
        !status.success()
    }
}

/// Committed parts, whole ones only.
fn parts(out: &Path) -> usize {
    let Ok(entries) = fs::read_dir(out.join("parts")) else { return 0 };
    entries.filter(|entry| !entry.as_ref().unwrap().file_name().to_string_lossy().starts_with('.')).count()
}

/// A small generator, so that the moments of the kills are always the same.
fn next(state: &mut u64) -> u64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    *state
}

const SEEDS: &str = "0..4";

#[test]
fn killed_ten_times_it_leaves_the_same_bytes() {
    let dir = TempDir::new().unwrap();
    let whole = dir.path().join("whole");
    let begun = Instant::now();
    run(&whole, &["--seeds", SEEDS]);
    // Some learners' time: kills keep to this machine's pace.
    let pace = 1 + begun.elapsed().as_micros() as u64 / 30;
    let expected = results(&whole);
    // The second time, every start is carried out in another way.
    let ways: [&[&[&str]]; 2] = [
        &[&["--cohort", "1"]],
        &[
            &["--cohort", "1", "--threads", "1"],
            &["--cohort", "2", "--iterations", "11"],
            &["--cohort", "3", "--threads", "2"],
        ],
    ];
    for (round, ways) in ways.into_iter().enumerate() {
        let out = dir.path().join(format!("killed-{round}"));
        let mut state = 0x9e37_79b9_7f4a_7c15_u64 + round as u64;
        let (mut before, mut between, mut finishing, mut after, mut ended) = (0, 0, 0, 0, 0);
        for number in 0..10 {
            let had = parts(&out);
            let way = ways[number % ways.len()];
            let mut going = Going::start(&out, &[&["--seeds", SEEDS], way].concat());
            match number {
                // While it plans, while it sets its folder up, in the first cohort; between commits; at the end.
                0 => {}
                1 => going.until(|out| out.exists()),
                2 => going.until(|out| out.join("world.toml").exists()),
                9 => going.until(|out| out.join("skills").exists()),
                _ => going.until(|out| parts(out) > had),
            }
            sleep(Duration::from_micros(if number < 9 { next(&mut state) % pace } else { 0 }));
            let killed = going.kill();
            let complete = out.join("manifest.json").exists();
            assert!(complete || parts(&out) >= had, "a committed part is gone");
            match (killed, complete, parts(&out)) {
                (false, ..) => ended += 1,
                (true, true, _) => after += 1,
                (true, false, 0) => before += 1,
                (true, false, _) if out.join("skills").exists() => finishing += 1,
                (true, false, _) => between += 1,
            }
        }
        let seen = format!(
            "killed {before} times before the first commit, {between} between commits, {finishing} while it wrote its \
             results, {after} after its manifest; {ended} had ended"
        );
        println!("{seen}");
        assert!(before >= 1 && between >= 3, "{seen}");
        run(&out, &["--seeds", SEEDS]);
        assert_same(&expected, &results(&out), &seen);
    }
}

#[test]
fn an_end_that_fails_can_be_repeated() {
    let dir = TempDir::new().unwrap();
    let (whole, out) = (dir.path().join("whole"), dir.path().join("run"));
    let seeds = ["--seeds", "0..2", "--cohort", "3"];
    run(&whole, &seeds);
    // Something stands where the second table belongs: the run ends between its results and its manifest.
    let mut going = Going::start(&out, &seeds);
    going.until(|out| parts(out) > 0);
    assert!(going.kill(), "10 learners in 4 cohorts ended with the first");
    fs::create_dir_all(out.join(EVALUATIONS).join("in the way")).unwrap();
    let output = tiny(&out, &seeds).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains(EVALUATIONS) && message.contains("hint: the earlier state is intact"), "{message}");
    assert!(out.join(TRIALS).exists() && !out.join("manifest.json").exists());
    fs::remove_dir_all(out.join(EVALUATIONS)).unwrap();
    let output = tiny(&out, &seeds).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("continued"), "{message}");
    assert!(!message.contains("learners trained"), "nothing was left to train: {message}");
    assert_same(&results(&whole), &results(&out), "after a failed end");
}

#[test]
fn a_complete_run_is_left_as_it_is() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    run(&out, &["--seeds", "0"]);
    let times = || {
        let name = |name: &&String| !name.starts_with("figures") && *name != "report.html" && !name.ends_with('/');
        let time = |name: &String| fs::metadata(out.join(name)).unwrap().modified().unwrap();
        tree(&out).keys().filter(name).map(|name| (name.clone(), time(name))).collect::<Vec<_>>()
    };
    let (files, modified) = (tree(&out), times());
    for way in [&["--seeds", "0"][..], &["--seeds", "0", "--cohort", "7", "--threads", "1", "--iterations", "3"]] {
        let output = tiny(&out, way).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{message}");
        assert!(message.contains("is complete: nothing is left to run"), "{message}");
        assert!(String::from_utf8_lossy(&output.stdout).contains("report.html"));
        assert_same(&files, &tree(&out), "run again");
        assert_eq!(modified, times());
    }
    // A run that was killed after its manifest gets its report.
    fs::remove_dir_all(out.join("figures")).unwrap();
    fs::remove_file(out.join("report.html")).unwrap();
    run(&out, &["--seeds", "0"]);
    assert_same(&files, &tree(&out), "report made again");
}

#[test]
fn two_at_once_do_not_disturb_each_other() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    let seeds = ["--seeds", "0..2", "--cohort", "1"];
    let start = || tiny(&out, &seeds).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let both = [start(), start()].map(|child| child.wait_with_output().unwrap());
    let codes = both.each_ref().map(|output| output.status.code());
    assert!(codes.contains(&Some(0)) && codes.iter().all(|code| matches!(code, Some(0 | 1))), "{codes:?}");
    for output in both.iter().filter(|output| !output.status.success()) {
        assert!(String::from_utf8_lossy(&output.stderr).contains("another skilltree process"));
    }
    let whole = dir.path().join("whole");
    run(&whole, &seeds);
    assert_same(&results(&whole), &results(&out), "two at once");
}
