//! Where there is no GPU, asking for one is refused with a hint, and nothing is left behind.

use super::support::{skilltree, tiny, tree};
use tempfile::TempDir;

/// Exit code where a GPU is asked for: a build without that backend is the wrong program for the command.
const NO_GPU: i32 = if cfg!(feature = "gpu") { 1 } else { 2 };
const WHY: &str =
    if cfg!(feature = "gpu") { "no graphics adapter" } else { "this build of skilltree has no GPU backend" };

#[test]
fn a_gpu_that_is_not_there_is_refused() {
    let dir = TempDir::new().unwrap();
    let out = dir.path().join("run");
    let mut line = skilltree(std::path::Path::new(env!("CARGO_MANIFEST_DIR")));
    line.args(["run", "configs/docking.toml", "--backend", "gpu", "--out"]).arg(&out);
    let output = line
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .args(["--set", "skill.dock.trials=1", "--seeds", "0"])
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(NO_GPU), "{message}");
    assert!(message.contains("error: ") && message.contains("\nhint: "), "{message}");
    assert!(!message.contains("panicked"), "{message}");
    assert!(output.stdout.is_empty() && tree(dir.path()).is_empty(), "{message}");
    // The CPU backend does not look for one.
    let mut line = tiny(&out, &["--seeds", "0", "--set", "arms=['untaught-sgd']"]);
    let output = line.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A comparison of nothing is not a success.
#[test]
fn parity_without_an_adapter_is_an_error() {
    let mut line = skilltree(std::path::Path::new(env!("CARGO_MANIFEST_DIR")));
    line.args(["devices", "--parity", "configs/docking.toml"]);
    line.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    let output = line.output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(NO_GPU), "{message}");
    assert!(message.contains(WHY) && message.contains("\nhint: "), "{message}");
    assert!(output.stdout.is_empty());
}
