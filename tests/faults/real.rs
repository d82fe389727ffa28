//! Disks that are really full or read-only, under the program itself.

use crate::support::{tiny, tree};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const MORE: [&str; 4] = ["--seeds", "0..3", "--set", "arms=['taught-adam']"];

/// The run's results and figures: the manifest and the page that shows it hold times.
fn results(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = tree(dir);
    files.retain(|name, _| !["manifest.json", "report.html", ".lock"].contains(&name.as_str()));
    files
}

fn undisturbed(desk: &Path) -> BTreeMap<String, Vec<u8>> {
    let out = desk.join("undisturbed/run");
    assert!(tiny(&out, &MORE).output().unwrap().status.success());
    results(&out)
}

fn refused(output: &Output, out: &Path) {
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("\nhint: ") && message.contains(&out.display().to_string()), "{message}");
    assert!(!message.contains("panicked"), "{message}");
}

/// Wraps a command in a shell script, which finds the command in its arguments.
fn within(shell: &[&str], script: &str, command: &Command) -> Command {
    let mut wrapped = Command::new(shell[0]);
    wrapped.args(&shell[1..]).args(["-c", script, "sh"]).arg(command.get_program()).args(command.get_args());
    wrapped.current_dir(command.get_current_dir().unwrap());
    wrapped
}

/// No file may grow beyond a limit of the operating system's: it writes what fits, then refuses, as a full disk does.
#[test]
fn files_that_may_not_grow() {
    let desk = TempDir::new().unwrap();
    let expected = undisturbed(desk.path());
    let out = desk.path().join("run");
    let mut refusals = Vec::new();
    // In blocks of 512 bytes, or 1024 with some shells.
    for blocks in [0, 1, 5, 10, 50, 100, 150, 180] {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$@\"");
        let output = within(&["sh"], &script, &tiny(&out, &MORE)).output().unwrap();
        if !output.status.success() {
            refused(&output, &out);
            let message = String::from_utf8_lossy(&output.stderr).into_owned();
            let place = message.split("error: ").nth(1).and_then(|text| text.split(": ").next()).map(str::to_owned);
            refusals.extend(place);
        }
        let whole = |(name, bytes): (&String, &Vec<u8>)| expected.get(name).is_none_or(|known| known == bytes);
        assert!(results(&out).iter().all(whole), "with {blocks} blocks");
    }
    refusals.dedup();
    eprintln!("the limits struck at {refusals:?}");
    assert!(refusals.len() >= 3, "the limits struck at {refusals:?} alone");
    assert!(tiny(&out, &MORE).output().unwrap().status.success());
    assert!(results(&out) == expected);
}

/// A small file system in memory, in a name space of its own: full, then read-only, then as it should be.
///
/// Where no such thing may be mounted, this test fails unless `SKILLTREE_TEST_NO_MOUNTS=1` says that it cannot be; the
/// same faults are injected call by call elsewhere.
#[cfg(target_os = "linux")]
#[test]
fn a_full_and_a_read_only_file_system() {
    let desk = TempDir::new().unwrap();
    let disk = desk.path().join("disk");
    std::fs::create_dir(&disk).unwrap();
    let shell = ["unshare", "--user", "--map-root-user", "--mount", "sh"];
    if std::env::var_os("SKILLTREE_TEST_NO_MOUNTS").is_some_and(|value| value == "1") {
        eprintln!("not tested: SKILLTREE_TEST_NO_MOUNTS=1");
        return;
    }
    let expected = undisturbed(desk.path());
    let (out, copy) = (disk.join("run"), desk.path().join("copy"));
    let command = tiny(&out, &MORE);
    let names = "disk=$1; copy=$2; shift 2";
    let arguments = |script: &str| {
        let mut wrapped = Command::new(shell[0]);
        wrapped.args(&shell[1..]).args(["-c", &format!("{names}; {script}"), "sh"]).args([&disk, &copy]);
        wrapped.arg(command.get_program()).args(command.get_args());
        wrapped.current_dir(command.get_current_dir().unwrap());
        wrapped.output().unwrap()
    };
    let mounted = arguments("mount -t tmpfs -o size=64k none \"$disk\"");
    let message = String::from_utf8_lossy(&mounted.stderr);
    assert!(mounted.status.success(), "nothing can be mounted here: {message}\nhint: SKILLTREE_TEST_NO_MOUNTS=1");
    for size in ["8k", "48k", "120k", "280k"] {
        let script = format!(
            "mount -t tmpfs -o size={size} none \"$disk\" || exit 90
            \"$@\" 2> \"$copy.full\"; echo $?
            mount -o remount,ro,size=64m \"$disk\" || exit 91
            \"$@\" 2> \"$copy.read-only\"; echo $?
            mount -o remount,rw \"$disk\" || exit 92
            \"$@\" > \"$copy.text\" || exit 93
            cp -a \"$disk/run\" \"$copy\""
        );
        let output = arguments(&script);
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{size}: {said}{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(said, "1\n1\n", "{size}: exit codes");
        for (ending, reason) in [("full", "No space left on device"), ("read-only", "Read-only file system")] {
            let message = std::fs::read_to_string(desk.path().join(format!("copy.{ending}"))).unwrap();
            assert!(message.contains(reason) && message.contains("\nhint: "), "{size}, {ending}: {message}");
            assert!(message.contains(&out.display().to_string()), "{size}, {ending}: {message}");
        }
        assert!(results(&copy) == expected, "{size}: other bytes");
        std::fs::remove_dir_all(&copy).unwrap();
    }
}
