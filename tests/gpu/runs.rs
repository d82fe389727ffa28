//! The same experiment leaves the same files on an adapter as on the CPU, however it is cut up.

use super::adapter::gpu;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Cuts an experiment down to seconds.
const CUTS: [&str; 6] = [
    "world=../tests/support/small.toml",
    "skill.dock.trials=4",
    "evaluate.at=[0, 2]",
    "evaluate.episodes=4",
    "teacher.eval_episodes=10",
    "teacher.lessons=16",
];

/// Files that say how and where a run was carried out.
const CIRCUMSTANCES: [&str; 4] = ["manifest.json", "report.html", ".lock", ".skilltree"];

/// Runs the program; every file that it leaves but for [`CIRCUMSTANCES`].
fn run(out: &Path, backend: &str, more: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skilltree"));
    command.current_dir(env!("CARGO_MANIFEST_DIR")).args(["run", "configs/docking.toml", "--seeds", "0..2"]);
    command.args(["--backend", backend, "--out"]).arg(out).args(CUTS.iter().flat_map(|cut| ["--set", *cut])).args(more);
    let output = command.output().expect("it starts");
    assert!(output.status.success(), "{backend} {more:?}: {}", String::from_utf8_lossy(&output.stderr));
    let (mut found, mut open) = (BTreeMap::new(), vec![out.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(out).expect("below").to_string_lossy().into_owned();
            if path.is_dir() {
                open.push(path);
            } else if !CIRCUMSTANCES.contains(&name.as_str()) {
                found.insert(name, fs::read(path).expect("a file"));
            }
        }
    }
    found
}

#[test]
fn no_backend_and_no_way_of_using_it_changes_a_byte() {
    let _alone = gpu();
    let parent = TempDir::new().expect("a folder");
    let expected = run(&parent.path().join("cpu"), "cpu", &[]);
    assert_eq!(expected.keys().filter(|name| name.ends_with(".safetensors")).count(), 10);
    for (number, (backend, more)) in [
        ("reference", &[][..]),
        ("gpu", &[]),
        ("gpu", &["--cohort", "3", "--iterations", "50"]),
        ("gpu", &["--set", "seed=7"]),
    ]
    .into_iter()
    .enumerate()
    {
        let found = run(&parent.path().join(number.to_string()), backend, more);
        let differing: Vec<&String> =
            expected.keys().chain(found.keys()).filter(|name| expected.get(*name) != found.get(*name)).collect();
        // Another key of the run must show.
        let other_run = more.contains(&"seed=7");
        assert_eq!(!differing.is_empty(), other_run, "{backend} {more:?}: these differ: {differing:?}");
    }
}
