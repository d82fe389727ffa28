//! Runs that are stopped, killed or damaged go on to the same bytes; learners that fail are named and disturb nobody.
#![cfg(unix)]

mod failures;
#[path = "../support/mod.rs"]
mod support;
mod turns;

use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant, SystemTime};
use support::{skilltree, tiny, tree};
use tempfile::TempDir;

/// Longer than any step of a tiny run takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);
/// Some seconds of work in one cohort.
const LONG: [&str; 6] = ["--seeds", "0..4", "--set", "skill.dock.trials=100", "--set", "evaluate.at=[0, 30]"];

fn long(out: &Path, more: &[&str]) -> Command {
    tiny(out, &[&LONG, more].concat())
}

fn start(out: &Path, more: &[&str]) -> Child {
    long(out, more).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Waits until this holds, or the run ends.
fn until(child: &mut Child, holds: impl Fn() -> bool) {
    let begun = Instant::now();
    while !holds() && child.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "the run hangs");
        sleep(Duration::from_millis(2));
    }
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Every file but those that say how and where the run was carried out.
fn results(out: &Path) -> BTreeMap<String, Vec<u8>> {
    skilltree::run_folder::FinishedRun::read(out).unwrap();
    let mut files = tree(out);
    assert!(!files.contains_key("checkpoint") && !files.contains_key("parts/"), "{:?}", files.keys());
    for name in ["manifest.json", "report.html", ".lock", ".skilltree"] {
        assert!(files.remove(name).is_some(), "no {name}");
    }
    files.retain(|name, _| !name.starts_with("checkpoint.unused"));
    assert!(files.keys().filter(|name| name.ends_with(".safetensors")).count() == 20);
    files
}

#[track_caller]
fn assert_same(left: &BTreeMap<String, Vec<u8>>, right: &BTreeMap<String, Vec<u8>>) {
    let names: Vec<&String> = left.keys().chain(right.keys()).collect();
    let differing: Vec<_> = names.into_iter().filter(|name| left.get(*name) != right.get(*name)).collect();
    assert!(differing.is_empty(), "these differ: {differing:?}");
}

fn whole(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let out = dir.join("whole");
    let output = long(&out, &[]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    results(&out)
}

/// Stops a fresh run by a signal while its only cohort is in training.
fn stopped(out: &Path) {
    let mut child = start(out, &["--checkpoint", "0.05"]);
    until(&mut child, || out.join("checkpoint").exists());
    signal(&child, "TERM");
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(75), "{}", text(&output));
}

#[test]
fn signals_stop_a_run_that_goes_on_in_any_other_way() {
    let dir = TempDir::new().unwrap();
    let expected = whole(dir.path());
    let out = dir.path().join("run");
    let ways: [&[&str]; 4] = [
        &["--checkpoint", "0.2", "--threads", "1"],
        &["--threads", "1", "--iterations", "700"],
        &["--cohort", "3", "--threads", "2"],
        &["--checkpoint", "3600"],
    ];
    let mut stops = 0;
    for round in 0.. {
        assert!(round < 40, "it never ends");
        let mut child = start(&out, ways[round % 4]);
        until(&mut child, || out.join("config.toml").exists());
        // Longer and longer: on a busy machine the first ones come before the training has begun.
        sleep(Duration::from_millis(300 + 150 * round as u64));
        signal(&child, if round % 2 == 0 { "TERM" } else { "INT" });
        let asked = Instant::now();
        let output = child.wait_with_output().unwrap();
        let message = text(&output);
        match output.status.code() {
            Some(75) => {
                stops += 1;
                // A look comes every half second; the rest is the other programs' time.
                assert!(asked.elapsed() < Duration::from_secs(10), "{:?}", asked.elapsed());
                let command = format!("skilltree run {0}/config.toml --out {0}", out.display());
                assert!(message.contains("of 20 learners are finished") && message.contains(&command), "{message}");
                let trained = message.contains("20 of 20 learners");
                assert!(trained || out.join("checkpoint").exists() || out.join("skills").exists(), "{message}");
            }
            // It came when all was trained, or before it was listened for.
            Some(0) => break,
            None => {}
            other => panic!("{other:?}: {message}"),
        }
    }
    assert!(stops >= 2, "{stops}");
    assert_same(&expected, &results(&out));
}

#[test]
fn the_command_that_an_unfinished_folder_names_finishes_it() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    stopped(&out);
    let refused = skilltree(dir.path()).args(["report", "run"]).output().unwrap();
    let message = text(&refused);
    assert_eq!(refused.status.code(), Some(1));
    assert!(message.contains("not complete") && !out.join("report.html").exists(), "{message}");
    let command = message.split('`').nth(1).expect("a command").strip_prefix("skilltree ").expect("ours");
    let output = skilltree(dir.path()).args(command.split(' ')).args(["--backend", "cpu"]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    assert_same(&whole(dir.path()), &results(&out));
}

#[test]
fn a_second_signal_ends_it_at_once() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    let mut child = start(&out, &[]);
    until(&mut child, || out.join("config.toml").exists());
    sleep(Duration::from_millis(200));
    signal(&child, "INT");
    signal(&child, "INT");
    let output = child.wait_with_output().unwrap();
    // Killed by the signal, unless the first one was already obeyed.
    assert!(matches!(output.status.code(), None | Some(75)), "{:?}", output.status);
    let output = long(&out, &[]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
}

#[test]
fn a_kill_costs_little_more_than_an_interval() {
    let dir = TempDir::new().unwrap();
    let expected = whole(dir.path());
    let out = dir.path().join("run");
    let mut used = 0;
    for round in 0..4_u64 {
        let mut child = start(&out, &["--checkpoint", "0.2"]);
        let had = fs::metadata(out.join("checkpoint")).and_then(|data| data.modified()).ok();
        let newer = || fs::metadata(out.join("checkpoint")).and_then(|data| data.modified()).ok() > had;
        until(&mut child, newer);
        sleep(Duration::from_millis(150 * round));
        child.kill().unwrap();
        child.wait().unwrap();
        if let Ok(data) = fs::metadata(out.join("checkpoint")) {
            // An interval, a look, and the time that saving takes on a busy machine.
            let age = SystemTime::now().duration_since(data.modified().unwrap()).unwrap_or_default();
            assert!(age < Duration::from_secs(5), "{age:?}");
            used += 1;
        }
    }
    assert!(used >= 2, "{used}");
    let output = long(&out, &[]).output().unwrap();
    assert!(output.status.success(), "{}", text(&output));
    assert_same(&expected, &results(&out));
}

/// A file in the frame that the program uses, by whoever.
fn framed(maker: &str, content: &[u8]) -> Vec<u8> {
    let mut bytes = b"SKLPART3".to_vec();
    bytes.extend((maker.len() as u32).to_le_bytes());
    bytes.extend(maker.as_bytes());
    bytes.extend(content);
    let length = bytes.len() as u64;
    let hash = Sha256::digest(&bytes);
    bytes.extend(length.to_le_bytes());
    bytes.extend(hash);
    bytes
}

#[test]
fn a_checkpoint_that_cannot_be_used_is_set_aside_and_nothing_is_lost() {
    let dir = TempDir::new().unwrap();
    let expected = whole(dir.path());
    let out = dir.path().join("run");
    stopped(&out);
    let path = out.join("checkpoint");
    let sound = fs::read(&path).unwrap();
    let maker = String::from_utf8_lossy(&sound[12..12 + sound[8] as usize]).into_owned();
    assert!(maker.starts_with(&format!("skilltree {}", env!("CARGO_PKG_VERSION"))), "{maker}");
    let content = &sound[12 + maker.len()..sound.len() - 40];
    assert_eq!(framed(&maker, content), sound);
    let mut flipped = sound.clone();
    flipped[sound.len() / 2] ^= 1;
    let cases = [
        (sound[..sound.len() / 3].to_vec(), "damaged"),
        (flipped, "damaged"),
        (b"notes of mine".to_vec(), "damaged"),
        (framed(&maker, &content[..content.len() - 4]), "damaged"),
        (framed("skilltree 9.9.9, format 3, plan 0", content), "written by skilltree 9.9.9"),
    ];
    for (number, (bytes, said)) in cases.iter().enumerate() {
        fs::write(&path, bytes).unwrap();
        // Until the warning has come and the training has begun anew.
        let mut child = start(&out, &["--checkpoint", "0.05"]);
        let aside = out.join(format!("checkpoint.unused-{}", number + 1));
        until(&mut child, || aside.exists() && path.exists());
        signal(&child, "TERM");
        let message = text(&child.wait_with_output().unwrap());
        assert!(message.contains(said) && message.contains(&aside.display().to_string()), "{message}");
        assert_eq!(&fs::read(&aside).unwrap(), bytes);
    }
    fs::write(&path, &sound).unwrap();
    let output = long(&out, &[]).output().unwrap();
    assert!(output.status.success() && !text(&output).contains("warning"), "{}", text(&output));
    assert_same(&expected, &results(&out));
    assert!(out.join("checkpoint.unused-5").exists());
}

#[test]
fn parts_of_another_program_are_not_mixed_in() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    let mut child = start(&out, &["--cohort", "2"]);
    // What is being written has another name until it is whole.
    let parts = || {
        let names = fs::read_dir(out.join("parts")).into_iter().flatten().map(|entry| entry.unwrap().path());
        names.filter(|path| !path.to_string_lossy().ends_with("-tmp")).collect::<Vec<_>>()
    };
    until(&mut child, || parts().len() > 1);
    child.kill().unwrap();
    child.wait().unwrap();
    let refused = skilltree(dir.path()).args(["report", "run"]).output().unwrap();
    assert!(text(&refused).contains(" of 20 learners are finished"), "{}", text(&refused));
    let part = parts().remove(0);
    let own = fs::read(&part).unwrap();
    let content = &own[12 + own[8] as usize..own.len() - 40];
    fs::write(&part, framed("skilltree 0.0.9, format 3, plan 0", content)).unwrap();
    // What a killed process leaves half written is cleared away.
    let kept = || tree(&out).into_iter().filter(|(name, _)| !name.contains("skilltree-tmp")).collect::<Vec<_>>();
    let before = kept();
    let output = long(&out, &[]).output().unwrap();
    let message = text(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("written by skilltree 0.0.9") && message.contains("hint:"), "{message}");
    assert!(before == kept(), "nothing is touched");
    fs::write(&part, own).unwrap();
    assert!(long(&out, &[]).output().unwrap().status.success());
}

#[test]
fn what_is_no_interval_is_refused() {
    let dir = TempDir::new().unwrap();
    for wrong in ["0", "-1", "NaN", "soon", "1e9"] {
        let output = long(&dir.path().join("run"), &["--checkpoint", wrong]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{wrong}: {}", text(&output));
        assert!(!dir.path().join("run").exists());
    }
}
