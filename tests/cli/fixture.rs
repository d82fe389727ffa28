//! A folder with the shipped configs, to make mistakes in.

use super::support::{skilltree, tiny, tree};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;

pub(super) const SHIPPED: &str = env!("CARGO_MANIFEST_DIR");

/// A folder with the shipped config and world to make mistakes in.
pub(super) struct Sandbox(TempDir);

impl Sandbox {
    pub(super) fn new() -> Self {
        let sandbox = Self(TempDir::new().unwrap());
        sandbox.write("docking.toml", shipped("docking.toml"));
        sandbox.write("worlds/office.toml", shipped("worlds/office.toml"));
        sandbox
    }

    pub(super) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(super) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// A copy of a complete run.
    pub(super) fn run(&self, name: &str) -> PathBuf {
        for (file, bytes) in finished() {
            if file.ends_with('/') {
                fs::create_dir_all(self.path().join(name).join(file)).unwrap();
            } else {
                self.write(&format!("{name}/{file}"), bytes);
            }
        }
        self.path().join(name)
    }

    pub(super) fn give(&self, line: &[&str]) -> Output {
        skilltree(self.path()).args(line).stdin(Stdio::null()).output().unwrap()
    }

    /// The command fails with this code, says each of these in one message, and changes nothing.
    pub(super) fn refuses(&self, line: &[&str], code: i32, says: &[&str]) {
        let before = tree(self.path());
        let output = self.give(line);
        let after = tree(self.path());
        let what = format!("skilltree {}\n{}", line.join(" "), String::from_utf8_lossy(&output.stderr));
        let message = String::from_utf8(output.stderr).expect(&what);
        assert_eq!(output.status.code(), Some(code), "{what}");
        assert!(!message.contains("panicked") && !message.contains("bug in skilltree"), "{what}");
        assert_eq!(message.lines().filter(|line| line.starts_with("error: ")).count(), 1, "{what}");
        assert!(
            ["\nhint: ", "\nnote: ", "Usage:", "For more information"].iter().any(|hint| message.contains(hint)),
            "{what}"
        );
        for words in says {
            assert!(message.contains(words), "`{words}` is not in the answer to {what}");
        }
        assert!(output.stdout.is_empty(), "{what}{}", String::from_utf8_lossy(&output.stdout));
        let names = |tree: &BTreeMap<String, Vec<u8>>| tree.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&before), names(&after), "{what}");
        assert!(before == after, "a file changed: {what}");
    }
}

pub(super) fn shipped(name: &str) -> String {
    fs::read_to_string(Path::new(SHIPPED).join("configs").join(name)).unwrap()
}

/// A shipped file with one change.
pub(super) fn edited(name: &str, from: &str, to: &str) -> String {
    let text = shipped(name);
    assert_eq!(text.matches(from).count(), 1, "`{from}` in {name}");
    text.replace(from, to)
}

/// The files of a complete run with one arm and two seeds.
pub(super) fn finished() -> &'static BTreeMap<String, Vec<u8>> {
    static RUN: OnceLock<BTreeMap<String, Vec<u8>>> = OnceLock::new();
    RUN.get_or_init(|| {
        let dir = TempDir::new().unwrap();
        let out = dir.path().join("run");
        let output = tiny(&out, &["--seeds", "0..2", "--set", "arms=['taught-adam']"]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stderr).contains("2 of 2 learners"));
        let summary = String::from_utf8_lossy(&output.stdout);
        for name in ["taught-adam", "planner", "trials.parquet", "evaluations.parquet", "skills", "report.html"] {
            assert!(summary.contains(name), "{name} is not in {summary}");
        }
        tree(&out)
    })
}
