//! What the tests of the program share: a tiny experiment, and folders as maps.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Cuts an experiment down to a fraction of a second.
const CUTS: [&str; 6] = [
    "world=../tests/support/small.toml",
    "skill.dock.trials=6",
    "evaluate.at=[0, 3]",
    "evaluate.episodes=5",
    "teacher.eval_episodes=20",
    "teacher.lessons=32",
];

/// The program, in a folder.
pub(crate) fn skilltree(dir: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skilltree"));
    command.current_dir(dir).env_remove("RUST_BACKTRACE");
    command
}

/// A tiny run of `configs/docking.toml` on the CPU.
pub(crate) fn tiny(out: &Path, more: &[&str]) -> Command {
    let mut command = skilltree(Path::new(env!("CARGO_MANIFEST_DIR")));
    command.args(["run", "configs/docking.toml", "--backend", "cpu", "--out"]).arg(out);
    for cut in CUTS {
        command.args(["--set", cut]);
    }
    command.args(more);
    command
}

/// Every file and folder below a folder: its path with `/`, and its bytes.
pub(crate) fn tree(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![(dir.to_path_buf(), String::new())];
    while let Some((folder, prefix)) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let entry = entry.unwrap();
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.file_type().unwrap().is_dir() {
                open.push((entry.path(), format!("{name}/")));
                found.insert(name + "/", Vec::new());
            } else {
                found.insert(name, fs::read(entry.path()).unwrap());
            }
        }
    }
    found
}
