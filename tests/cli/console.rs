//! Help, and outputs that take nothing.

use super::fixture::{SHIPPED, Sandbox, finished};
use super::run::{again, results};
use super::support::{skilltree, tree};
use std::fs;
use std::path::Path;
use std::process::Stdio;

#[test]
fn a_closed_or_full_output_is_no_panic() {
    let sandbox = Sandbox::new();
    let run = sandbox.run("run");
    let lines: [Vec<&str>; 5] = [
        vec!["probe", "docking.toml", "--at", "L2", "--json", "--actions", "turn+15,turn+15"],
        vec!["probe", "docking.toml", "--at", "L2"],
        vec!["report", run.to_str().unwrap()],
        vec!["devices"],
        vec!["devices", "--json"],
    ];
    // Without a driver: what adapters there are is none of this test's business.
    let skilltree = |dir: &Path| {
        let mut command = skilltree(dir);
        command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
        command
    };
    for line in &lines {
        let full = fs::File::options().write(true).open("/dev/full");
        if let Ok(full) = full {
            let output = skilltree(sandbox.path()).args(line).stdout(full).stderr(Stdio::piped()).output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{message}");
            assert!(message.contains("standard output") && message.contains("hint: "), "{message}");
        }
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = skilltree(sandbox.path()).args(line).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    // With both closed, a run goes on to its end.
    let out = sandbox.path().join("again");
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let status = again(&out).stdout(writer.try_clone().unwrap()).stderr(writer).status().unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(results(&tree(&out)) == results(finished()));
    // A message that nobody reads still has its exit code.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    assert_eq!(
        skilltree(sandbox.path()).args(["run", "nowhere.toml"]).stderr(writer).status().unwrap().code(),
        Some(2)
    );
}

#[test]
fn help_teaches() {
    let sandbox = Sandbox::new();
    for (line, says) in [
        (&["--help"][..], &["run", "report", "probe", "Start with:", "configs/quick.toml"][..]),
        (&["run", "--help"], &["Examples:", "--seeds 0..256", "--set", "--backend", "--threads", "--out", "continues"]),
        (&["report", "--help"], &["Example:", "runs/quick", "report.html"]),
        (&["devices", "--help"], &["Examples:", "--parity", "--learners", "--json", "exit code 1"]),
        (&["probe", "--help"], &["Examples:", "--at L2", "--at 60,60,225", "--json", "bumpers", "counter-clockwise"]),
    ] {
        let output = sandbox.give(line);
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line:?}");
        assert!(output.stderr.is_empty());
        for words in says.iter().chain(&["Exit codes: 0 done; 2 wrong usage or config; 75"]) {
            assert!(text.contains(words), "`{words}` is not in {line:?}:\n{text}");
        }
    }
    // The examples of `probe` work as they stand.
    let help = String::from_utf8(sandbox.give(&["probe", "--help"]).stdout).unwrap();
    let examples: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  skilltree ")).collect();
    assert_eq!(examples.len(), 2, "{help}");
    for example in examples {
        let output = skilltree(Path::new(SHIPPED)).args(example.split_whitespace()).output().unwrap();
        assert!(output.status.success(), "{example}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let version = sandbox.give(&["--version"]);
    assert_eq!(String::from_utf8_lossy(&version.stdout), format!("skilltree {}\n", env!("CARGO_PKG_VERSION")));
    // Without a command, the help goes where mistakes go.
    let bare = sandbox.give(&[]);
    assert_eq!(bare.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bare.stderr).contains("Usage:") && bare.stdout.is_empty());
}
