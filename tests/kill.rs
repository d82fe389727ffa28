//! Runs that are killed at random moments, and given again until they are complete: no committed part is lost, nothing
//! half-written is taken for a result, and the bytes are those of a run that nobody killed.
//!
//! `SKILLTREE_KILLS` is the number of kills, 12 if not set.
#![cfg(unix)]

mod support;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use support::{tiny, tree};
use tempfile::TempDir;

/// Twenty cohorts of one learner, each of them a part.
const MORE: [&str; 8] = [
    "--seeds",
    "0..10",
    "--set",
    "arms=['taught-adam', 'taught-sgd']",
    "--set",
    "skill.dock.trials=10",
    "--cohort",
    "1",
];

type Files = BTreeMap<String, Vec<u8>>;

fn start(out: &Path) -> Child {
    let mut command: Command = tiny(out, &MORE);
    command.args(["--threads", "1"]).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// What readers would look at. Of the manifest, what does not hold times; the page shows the manifest.
fn visible(out: &Path) -> Files {
    if !out.exists() {
        return Files::new();
    }
    let mut files = tree(out);
    files.retain(|name, _| !name.ends_with(".skilltree-tmp") && !name.ends_with('/') && name != ".lock");
    for (name, bytes) in &mut files {
        if name == "manifest.json" {
            let mut manifest: serde_json::Value = serde_json::from_slice(bytes).expect("a whole manifest");
            let entries = manifest.as_object_mut().unwrap();
            assert!(entries.remove("started").is_some() && entries.remove("finished").is_some());
            *bytes = manifest.to_string().into_bytes();
        }
        if name == "report.html" {
            let text = String::from_utf8(bytes.clone()).unwrap();
            let timeless = text.lines().filter(|line| !line.contains("<dt>started") && !line.contains("<dt>finished"));
            *bytes = timeless.collect::<Vec<_>>().join("\n").into_bytes();
        }
    }
    files
}

fn is_part(name: &str) -> bool {
    name.starts_with("parts/")
}

/// Moments, the same in every run (splitmix64).
struct StepRandom(u64);

impl StepRandom {
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// What was seen over all kills.
#[derive(Debug, Default)]
struct Tally {
    kills: u32,
    before_the_first_part: u32,
    between_parts: u32,
    after_the_last_part: u32,
    in_the_report: u32,
    leftovers: u32,
    runs_completed: u32,
    parts_seen: u64,
    parts_lost: u64,
}

/// Every part that was ever seen, by name: they have the same bytes each time.
fn check(files: &Files, expected: &Files, parts: &mut Files) {
    for (name, bytes) in files {
        let known = if is_part(name) { parts.entry(name.clone()).or_insert(bytes.clone()) } else { &expected[name] };
        assert!(known == bytes, "{name} is not what a run that nobody killed writes");
    }
}

/// Waits for the moment of the kill: a share of the time that a run takes, or, one time in three, a few milliseconds
/// after the tables begin to be written. None if the run ends before.
fn wait(child: &mut Child, out: &Path, random: &mut StepRandom, takes: Duration) -> Option<()> {
    let finishing = random.share() < 1.0 / 3.0;
    let mut until = Instant::now() + takes.mul_f64(1.1 * random.share());
    let mut armed = !finishing;
    loop {
        if child.try_wait().unwrap().is_some() {
            return None;
        }
        if !armed && out.join("trials.parquet").exists() {
            armed = true;
            until = Instant::now() + takes.mul_f64(0.5 * random.share());
        }
        if armed && Instant::now() >= until {
            return Some(());
        }
        std::thread::sleep(Duration::from_micros(500));
    }
}

#[test]
fn killed_runs_go_on_and_lose_nothing() {
    let wanted: u32 = std::env::var("SKILLTREE_KILLS").map_or(12, |text| text.parse().expect("SKILLTREE_KILLS"));
    let desk = TempDir::new().unwrap();
    // The page names the folder.
    let out = desk.path().join("undisturbed/run");
    let began = Instant::now();
    assert!(start(&out).wait().unwrap().success());
    let takes = began.elapsed();
    let (expected, mut parts) = (visible(&out), Files::new());
    assert!(expected.contains_key("report.html") && !expected.keys().any(|name| is_part(name)));
    let (mut random, mut tally) = (StepRandom(1993), Tally::default());
    let out = desk.path().join("run");
    while tally.kills < wanted {
        let before = visible(&out);
        let mut child = start(&out);
        // All that a complete run still has to do is its report. That is killed now and then, or there would be little else.
        let spared = before.contains_key("manifest.json") && random.share() < 0.7;
        let killed = !spared && wait(&mut child, &out, &mut random, takes).is_some();
        if !spared {
            child.kill().unwrap();
        }
        let output = child.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        let after = visible(&out);
        check(&after, &expected, &mut parts);
        let complete = after.contains_key("manifest.json");
        assert!(complete || !before.contains_key("manifest.json"), "the manifest is gone");
        let held = before.keys().filter(|name| is_part(name));
        tally.parts_lost += held.filter(|name| !complete && !after.contains_key(*name)).count() as u64;
        if let Some(code) = output.status.code() {
            assert!(code == 0, "exit code {code}: {message}");
            assert!(after == expected, "other files than those of a run that nobody killed");
            assert!(tree(&out).keys().all(|name| !name.ends_with("-tmp") && !is_part(name)), "leftovers");
            tally.runs_completed += 1;
            std::fs::remove_dir_all(&out).unwrap();
            continue;
        }
        assert!(killed, "ended by itself, without an exit code: {message}");
        let kept = after.keys().filter(|name| is_part(name)).count();
        tally.kills += 1;
        tally.parts_seen += kept as u64;
        tally.leftovers += u32::from(out.exists() && tree(&out).keys().any(|name| name.ends_with("-tmp")));
        match kept {
            _ if complete => tally.in_the_report += 1,
            0 => tally.before_the_first_part += 1,
            20 => tally.after_the_last_part += 1,
            _ => tally.between_parts += 1,
        }
        if tally.kills.is_multiple_of(50) {
            eprintln!("{:.0} s: {tally:?}", began.elapsed().as_secs_f64());
        }
    }
    // Whatever the last kill left is brought to its end.
    assert!(start(&out).wait().unwrap().success());
    assert!(visible(&out) == expected);
    eprintln!(
        "{:.0} s, an undisturbed run takes {:.2} s: {tally:?}",
        began.elapsed().as_secs_f64(),
        takes.as_secs_f64()
    );
    assert_eq!(tally.parts_lost, 0);
    assert!(tally.between_parts > 0, "no kill came between two parts: {tally:?}");
}
