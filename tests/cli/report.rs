//! `skilltree report`: of damaged and of forged runs.

use super::fixture::{Sandbox, finished};
use super::support::tree;
use serde_json::Value;
use std::fs;

#[test]
fn reports_of_damaged_runs_say_which_file() {
    let sandbox = Sandbox::new();
    let run = sandbox.run("run");
    sandbox.write("file", "a file");
    fs::create_dir(sandbox.path().join("empty")).unwrap();
    sandbox.refuses(&["report", "nowhere"], 1, &["nowhere", "no such folder"]);
    sandbox.refuses(&["report", "file"], 1, &["file", "it is a file"]);
    sandbox.refuses(&["report", "empty"], 1, &["empty"]);
    sandbox.refuses(&["report", "worlds"], 1, &["office.toml"]);
    for name in [
        "manifest.json",
        "trials.parquet",
        "evaluations.parquet",
        "skills/taught-adam-1.safetensors",
        "places.json",
        "world.toml",
    ] {
        let path = run.join(name);
        let whole = fs::read(&path).unwrap();
        let mut flipped = whole.clone();
        let middle = whole.len() / 2;
        flipped[middle] = flipped[middle].wrapping_add(1) | 0x80;
        for bytes in [&whole[..middle], &[][..], &flipped] {
            fs::write(&path, bytes).unwrap();
            sandbox.refuses(&["report", "run"], 1, &[name, "damaged"]);
        }
        fs::remove_file(&path).unwrap();
        sandbox.refuses(&["report", "run"], 1, &[if name == "manifest.json" { "not complete" } else { name }]);
        fs::create_dir(&path).unwrap();
        sandbox.refuses(&["report", "run"], 1, &[name]);
        fs::remove_dir(&path).unwrap();
        fs::write(&path, whole).unwrap();
    }
    let figures = run.join("figures");
    fs::rename(&figures, sandbox.path().join("away")).unwrap();
    fs::write(&figures, "in the way").unwrap();
    sandbox.refuses(&["report", "run"], 1, &["figures"]);
    fs::remove_file(&figures).unwrap();
    fs::rename(sandbox.path().join("away"), &figures).unwrap();
    assert!(sandbox.give(&["report", "run"]).status.success());
    assert!(tree(&run) == *finished());
}

/// A file that the manifest vouches for may still make no sense: another program may have written both.
#[test]
fn reports_of_vouched_nonsense_do_not_panic() {
    let sandbox = Sandbox::new();
    let run = sandbox.run("run");
    let manifest = String::from_utf8(finished()["manifest.json"].clone()).unwrap();
    for (name, says) in [("evaluations.parquet", 1), ("places.json", 1), ("world.toml", 1)] {
        let whole = &finished()[name];
        for bytes in [whole[..whole.len() / 2].to_vec(), vec![], b"PAR1 nonsense PAR1".to_vec(), vec![0xff; 5000]] {
            let mut value: Value = serde_json::from_str(&manifest).unwrap();
            let digest = skilltree::run_folder::manifest::FileDigest::of(&bytes);
            value["files"][name] = serde_json::to_value(&digest).unwrap();
            fs::write(run.join("manifest.json"), value.to_string()).unwrap();
            fs::write(run.join(name), bytes).unwrap();
            sandbox.refuses(&["report", "run"], says, &[name]);
        }
        fs::write(run.join(name), whole).unwrap();
    }
}
