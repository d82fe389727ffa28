//! Hostile files: whatever a reader is given, it accepts or refuses it. It never panics, hangs, or asks for memory out
//! of all proportion. Each test is one reader; `campaign.rs` says how long they take.

mod campaign;
#[path = "../support/memory.rs"]
mod memory;
mod meter;
mod mutate;
mod records;
mod texts;
mod vouched;
#[path = "../support/within.rs"]
mod within;

use campaign::campaign;
use memory::Memory;
use skilltree::run_folder::file_system::FileSystem;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use within::{Experiment, folder};

/// A tiny experiment.
fn experiment() -> &'static Experiment {
    static EXPERIMENT: OnceLock<Experiment> = OnceLock::new();
    EXPERIMENT.get_or_init(Experiment::tiny)
}

/// The files of its complete run.
fn files() -> &'static BTreeMap<PathBuf, Vec<u8>> {
    static FILES: OnceLock<BTreeMap<PathBuf, Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let memory = Arc::new(Memory::default());
        let disk: Arc<dyn FileSystem> = memory.clone();
        experiment().run(&disk, &folder()).unwrap();
        memory.files()
    })
}

fn file(name: &str) -> Vec<u8> {
    files()[&folder().join(name)].clone()
}

/// Readers that are wrong on purpose: a campaign sees each kind of fault.
#[test]
fn faults_are_found() {
    let seeds = [b"a = 1\nb = 22\n".to_vec()];
    let found = |read: fn(&[u8]) -> Result<bool, String>| {
        let findings = campaign("broken", |random| mutate::text(random, &seeds), read).findings;
        findings.into_keys().collect::<String>()
    };
    let panics = found(|input| {
        assert!(!input.starts_with(b"b"), "a line was lost");
        Ok(true)
    });
    assert!(panics.contains("panic: ") && panics.contains("a line was lost"), "{panics}");
    let wastes = found(|input| Ok(vec![1_u8; if input.len() > 40 { 80 << 20 } else { 9 }].len() > 20));
    assert!(wastes.contains("memory: more than 64 MB"), "{wastes}");
    let errs = found(|input| if input.is_empty() { Err("nothing is something".to_owned()) } else { Ok(true) });
    assert!(errs.contains("nothing is something"), "{errs}");
    let sleeps = meter::watch(0, || std::thread::sleep(std::time::Duration::from_millis(30)));
    assert!(sleeps.time.as_millis() >= 30);
}

/// A path for messages.
fn somewhere() -> &'static Path {
    Path::new("somewhere")
}
