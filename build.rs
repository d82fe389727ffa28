//! Notes the git commit that is being built, for the manifests of run folders.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // The log grows with every commit, whatever the branch is called.
    if std::path::Path::new(".git/logs/HEAD").exists() {
        println!("cargo::rerun-if-changed=.git/logs/HEAD");
    }
    let commit = Command::new("git").args(["rev-parse", "HEAD"]).output();
    if let Ok(output) = commit
        && output.status.success()
        && let Ok(commit) = String::from_utf8(output.stdout)
    {
        println!("cargo::rustc-env=SKILLTREE_COMMIT={}", commit.trim());
    }
}
