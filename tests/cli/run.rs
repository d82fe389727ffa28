//! `skilltree run`: folders that cannot be, are others', or are damaged.

use super::fixture::{Sandbox, finished, shipped};
use super::support::{tiny, tree};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

#[test]
fn places_that_cannot_be_written_are_refused() {
    let sandbox = Sandbox::new();
    sandbox.write("thesis/chapter1.tex", "years of work");
    sandbox.write("file", "a file");
    let cases: [(&str, &str); 5] = [
        ("thesis", "chapter1.tex"),
        ("file", "file"),
        ("file/below", "file/below"),
        ("/proc/skilltree", "/proc/skilltree"),
        ("/dev/null", "/dev/null"),
    ];
    for (out, says) in cases {
        let tiny = ["--backend", "cpu", "--set", "teacher.lessons=10", "--set", "teacher.eval_episodes=1"];
        sandbox.refuses(&[&["run", "docking.toml", "--out", out], &tiny[..]].concat(), 1, &[says, "--out"][..1]);
    }
}

#[test]
fn another_experiments_folder_is_left_alone() {
    let sandbox = Sandbox::new();
    let run = sandbox.run("run");
    let line = ["run", "docking.toml", "--out", "run"];
    sandbox.refuses(&line, 1, &["another config.toml", "--out"]);
    let config = run.join("config.toml");
    let saved = fs::read(&config).unwrap();
    for (name, content, says) in [
        (".skilltree", "skilltree run folder, format 99\n", "format 99"),
        (".skilltree", "my own notes", ".skilltree"),
        ("manifest.json", "{", "config.toml"),
    ] {
        let before = fs::read(run.join(name)).unwrap();
        fs::write(run.join(name), content).unwrap();
        sandbox.refuses(&line, 1, &[says]);
        fs::write(run.join(name), before).unwrap();
    }
    fs::remove_file(&config).unwrap();
    sandbox.refuses(&line, 1, &["config.toml", "missing"]);
    fs::create_dir(&config).unwrap();
    sandbox.refuses(&line, 1, &["config.toml", "cannot read"]);
    fs::remove_dir(&config).unwrap();
    fs::write(&config, saved).unwrap();
    // Somebody is at work there.
    let lock = skilltree::run_folder::folder::lock(&skilltree::run_folder::file_system::OsFileSystem, &run).unwrap();
    sandbox.refuses(&line, 1, &["another skilltree process"]);
    sandbox.refuses(&["report", "run"], 1, &["another skilltree process"]);
    drop(lock);
}

/// The line that made [`finished`], for a folder on the sandbox.
pub(super) fn again(out: &Path) -> Command {
    tiny(out, &["--seeds", "0..2", "--set", "arms=['taught-adam']"])
}

#[test]
fn a_damaged_part_stops_the_run_and_says_which() {
    let sandbox = Sandbox::new();
    let out = sandbox.path().join("run");
    let plan = plan();
    let worlds = [("world.toml", plan.worlds[0].text.as_str())];
    let mut folder = skilltree::run_folder::RunFolder::open(&out, &plan.resolved, &worlds).unwrap();
    folder.commit_part("arm0-seed0_arm0-seed0", b"not the words of a learner").unwrap();
    drop(folder);
    let part = out.join("parts/arm0-seed0_arm0-seed0");
    let whole = fs::read(&part).unwrap();
    let mut flipped = whole.clone();
    flipped[60] ^= 1;
    for bytes in [&whole, &whole[..20], &[][..], &flipped] {
        fs::write(&part, bytes).unwrap();
        let before = tree(&out);
        let output = again(&out).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.contains("arm0-seed0_arm0-seed0") && message.contains("hint: remove this file"), "{message}");
        assert!(!message.contains("panicked"), "{message}");
        assert!(before == tree(&out), "{message}");
    }
    sandbox.refuses(&["report", "run"], 1, &["not complete", "goes on with it"]);
    // The hint helps.
    fs::remove_file(part).unwrap();
    assert!(again(&out).output().unwrap().status.success());
    assert!(results(&tree(&out)) == results(finished()));
}

/// The plan of [`finished`].
fn plan() -> skilltree::config::plan::Plan {
    let sandbox = Sandbox::new();
    sandbox.write("worlds/../world.toml", &finished()["world.toml"]);
    sandbox.write("config.toml", &finished()["config.toml"]);
    let set = vec![];
    let plan = skilltree::config::load(
        &sandbox.path().join("config.toml"),
        &skilltree::config::Overrides { set, ..Default::default() },
    );
    let mut plan = plan.unwrap();
    plan.resolved = String::from_utf8(finished()["config.toml"].clone()).unwrap();
    plan
}

/// All that two runs of the same experiment have in common, in whatever way they were carried out.
pub(super) fn results(tree: &BTreeMap<String, Vec<u8>>) -> BTreeMap<&String, &Vec<u8>> {
    tree.iter().filter(|(name, _)| *name != "manifest.json" && *name != "report.html").collect()
}

#[test]
fn every_world_that_a_config_names_is_kept_with_the_run() {
    let sandbox = Sandbox::new();
    let out = sandbox.path().join("run");
    let more = ["--seeds", "0..1", "--set", "arms=['taught-adam']"];
    let other = ["--set", "arm.taught-sgd.world=worlds/office-easy.toml"];
    let output = tiny(&out, &[&more[..], &other].concat()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("world:    small, office-easy\n"), "{message}");
    let kept = tree(&out);
    assert!(kept["worlds/office-easy.toml"] == shipped("worlds/office-easy.toml").into_bytes());
    let manifest: Value = serde_json::from_slice(&kept["manifest.json"]).unwrap();
    assert!(manifest["files"]["worlds/office-easy.toml"].is_object());
    // The run folder is all that it takes to do the same again.
    let output = sandbox.give(&["run", "run/config.toml", "--backend", "cpu", "--out", "again"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(results(&tree(&sandbox.path().join("again"))) == results(&kept));
    fs::remove_file(out.join("worlds/office-easy.toml")).unwrap();
    sandbox.refuses(&["report", "run"], 1, &["office-easy.toml", "missing"]);
}
