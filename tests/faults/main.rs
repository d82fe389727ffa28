//! Each call that a run or a report makes on the disk fails once, in each way that disks fail. The answer is a clean
//! error or the right results, nothing half-written is taken for a result, and the same command without the fault
//! leaves the bytes of a run that was never disturbed.

mod faulty;
#[path = "../support/memory.rs"]
mod memory;
#[cfg(unix)]
mod real;
#[cfg(unix)]
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/within.rs"]
mod within;

use faulty::{Fault, Faulty, Plan};
use memory::Memory;
use skilltree::cli::CliError;
use skilltree::report;
use skilltree::run_folder::file_system::FileSystem;
use skilltree::run_folder::{Manifest, RecordError};
use skilltree::train::run::RunError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use within::{Experiment, folder};

type Files = BTreeMap<PathBuf, Vec<u8>>;

fn experiment() -> &'static Experiment {
    static EXPERIMENT: OnceLock<Experiment> = OnceLock::new();
    EXPERIMENT.get_or_init(Experiment::tiny)
}

/// Files but for the lock and leftovers that the next run removes. The manifest says when the run ended.
fn visible(files: Files) -> Files {
    let hidden = |path: &Path| {
        let name = path.file_name().unwrap().to_string_lossy();
        name == ".lock" || name.ends_with(".skilltree-tmp")
    };
    files
        .into_iter()
        .filter(|(path, _)| !hidden(path))
        .map(|(path, bytes)| {
            let bytes = if path.ends_with(Manifest::NAME) { timeless(&bytes, &path) } else { bytes };
            (path, bytes)
        })
        .collect()
}

fn timeless(bytes: &[u8], path: &Path) -> Vec<u8> {
    let mut manifest = Manifest::parse(bytes, path).unwrap();
    manifest.provenance.finished = None;
    manifest.to_bytes().unwrap()
}

/// What an undisturbed run leaves, the parts that it removed at its end, and its calls.
struct Reference {
    files: Files,
    parts: Files,
    log: Vec<(&'static str, PathBuf)>,
}

fn undisturbed() -> &'static Reference {
    static REFERENCE: OnceLock<Reference> = OnceLock::new();
    REFERENCE.get_or_init(|| {
        let disk = Faulty::new(Memory::default(), None);
        experiment().run(&(Arc::new(disk.clone()) as Arc<dyn FileSystem>), &folder()).unwrap();
        let log = disk.log();
        // Where the parts can no longer be removed, they are still there.
        let call = log.iter().position(|(what, path)| *what == "remove file" && in_parts(path)).unwrap();
        let kept = Faulty::new(Memory::default(), Some(Plan { call, lasting: true, fault: Fault::Device }));
        experiment().run(&(Arc::new(kept.clone()) as Arc<dyn FileSystem>), &folder()).unwrap();
        let parts: Files = kept.memory.files().into_iter().filter(|(path, _)| in_parts(path)).collect();
        assert_eq!(parts.len(), 2);
        let files = visible(disk.memory.files());
        let names = ["manifest.json", "trials.parquet", "evaluations.parquet", "skills/taught-adam-1.safetensors"];
        assert!(
            names.iter().all(|name| files.contains_key(&folder().join(name)))
                && !files.keys().any(|path| in_parts(path))
        );
        Reference { files, parts, log }
    })
}

fn in_parts(path: &Path) -> bool {
    path.parent().is_some_and(|parent| parent.ends_with("parts"))
}

/// Every file that a reader would look at is one that an undisturbed run writes, whole.
fn nothing_half_written(files: &Files, what: &str) {
    for (path, bytes) in files {
        let whole = undisturbed().files.get(path).or_else(|| undisturbed().parts.get(path));
        assert!(whole == Some(bytes), "{what}: {} is not what an undisturbed run writes", path.display());
    }
}

/// What the user sees, and the exit code. The path is the call's own, or one in the run folder.
fn clean(failure: &CliError, call: &(&str, PathBuf), what: &str) {
    let message = failure.to_string();
    assert_eq!(failure.code(), 1, "{what}: {message}");
    let path = message.split_once(": ").map(|(path, _)| Path::new(path));
    assert!(path.is_some_and(|path| path == call.1 || path.starts_with("/runs")), "{what}: {message}");
    assert!(message.contains("\nhint: "), "{what}: {message}");
    assert!(!message.contains("bug in skilltree"), "{what}: {message}");
}

/// The error says whether the file is there.
fn told_apart(failure: &CliError, call: &(&str, PathBuf), before: &Files, after: &Files, what: &str) {
    let CliError::Record(error) = failure else { return };
    match error {
        RecordError::DurabilityUnknown { path, .. } => {
            assert_eq!((call.0, &call.1), ("sync folder", path), "{what}");
        }
        RecordError::NotCommitted { path, .. } => {
            assert_ne!(call.0, "sync folder", "{what}");
            assert_eq!(before.get(path), after.get(path), "{what}");
        }
        _ => assert!(!["create", "write", "sync", "rename", "sync folder"].contains(&call.0), "{what}: {error}"),
    }
}

/// One run with a fault, and what it leaves; then the same without.
fn disturbed(plan: Plan) {
    let call = &undisturbed().log[plan.call];
    let what = format!("{plan:?}, {} of {}", call.0, call.1.display());
    let disk = Faulty::new(Memory::default(), Some(plan));
    let outcome = experiment().run(&(Arc::new(disk.clone()) as Arc<dyn FileSystem>), &folder());
    assert_eq!(&disk.log()[plan.call], call, "{what}: the calls come in another order");
    let left = visible(disk.memory.files());
    nothing_half_written(&left, &what);
    let harmless = matches!(plan.fault, Fault::Short | Fault::Interrupted);
    // Nothing hangs on what is only tidied up.
    let tidying = call.0.starts_with("remove") || call.0 == "list" && left.contains_key(&folder().join(Manifest::NAME));
    // A result of an earlier attempt is only looked at to save the writing of it again.
    let given = ["config.toml", "world.toml", Manifest::NAME].map(|name| folder().join(name));
    let result = undisturbed().files.contains_key(&call.1) && !in_parts(&call.1) && !given.contains(&call.1);
    let sparing = ["open", "read"].contains(&call.0) && result;
    match outcome {
        Ok(()) => {
            assert!(harmless || tidying || sparing, "{what}: no error");
            let results: Files = left.into_iter().filter(|(path, _)| !in_parts(path)).collect();
            assert!(results == undisturbed().files, "{what}: other results");
        }
        Err(error) => {
            assert!(!harmless && (plan.lasting || !tidying), "{what}: {error}");
            let failure = CliError::from(error);
            clean(&failure, call, &what);
            if !plan.lasting {
                told_apart(&failure, call, &Files::new(), &left, &what);
            }
        }
    }
    experiment().run(&disk.repaired(), &folder()).unwrap_or_else(|error| panic!("{what}: not repaired: {error}"));
    let repaired = disk.memory.files();
    assert!(!repaired.keys().any(|path| path.to_string_lossy().ends_with("-tmp")), "{what}: leftovers");
    assert!(visible(repaired) == undisturbed().files, "{what}: other bytes after the repair");
}

#[test]
fn a_run_survives_every_fault_of_every_call() {
    let log = &undisturbed().log;
    let asked: Vec<&str> = log.iter().map(|(what, _)| *what).collect();
    for what in
        ["make folder", "create", "write", "sync", "open", "read", "rename", "sync folder", "list", "kind", "lock"]
    {
        assert!(asked.contains(&what), "no call of `{what}`");
    }
    assert!(asked.contains(&"remove file") && asked.contains(&"remove folder"));
    let mut runs = 0;
    for (call, (what, _)) in log.iter().enumerate() {
        for fault in Fault::ERRORS {
            disturbed(Plan { call, lasting: false, fault });
        }
        // A disk that fails for good: one way in turn.
        disturbed(Plan { call, lasting: true, fault: Fault::ERRORS[call % 4] });
        runs += 5;
        if ["read", "write"].contains(what) {
            for fault in [Fault::Short, Fault::Interrupted] {
                disturbed(Plan { call, lasting: false, fault });
                runs += 1;
            }
        }
        if *what == "write" {
            disturbed(Plan { call, lasting: false, fault: Fault::Torn });
            runs += 1;
        }
    }
    eprintln!("{} calls, {runs} runs with a fault", log.len());
}

/// Told to stop, and then to go on: a checkpoint lies in between.
fn stopped_and_gone_on(disk: &Arc<dyn FileSystem>) -> Result<(), RunError> {
    match experiment().stop(disk, &folder()) {
        Err(RunError::Stopped { .. }) => experiment().run(disk, &folder()),
        other => other,
    }
}

#[test]
fn a_stopped_run_survives_a_fault_of_every_call() {
    let whole = Faulty::new(Memory::default(), None);
    stopped_and_gone_on(&(Arc::new(whole.clone()) as Arc<dyn FileSystem>)).unwrap();
    assert!(visible(whole.memory.files()) == undisturbed().files);
    let log = whole.log();
    let checkpoint = folder().join("checkpoint");
    for what in ["rename", "read", "remove file"] {
        assert!(log.contains(&(what, checkpoint.clone())), "no call of `{what}` for the checkpoint");
    }
    for (call, asked) in log.iter().enumerate() {
        let plan = Plan { call, lasting: call / 4 % 2 == 0, fault: Fault::ERRORS[call % 4] };
        let what = format!("{plan:?}, {asked:?}");
        let disk = Faulty::new(Memory::default(), Some(plan));
        let outcome = stopped_and_gone_on(&(Arc::new(disk.clone()) as Arc<dyn FileSystem>));
        let mut left = visible(disk.memory.files());
        left.remove(&checkpoint);
        nothing_half_written(&left, &what);
        if let Err(error) = outcome {
            clean(&CliError::from(error), asked, &what);
        }
        stopped_and_gone_on(&disk.repaired()).unwrap_or_else(|error| panic!("{what}: not repaired: {error}"));
        assert!(visible(disk.memory.files()) == undisturbed().files, "{what}: other bytes after the repair");
    }
}

/// A disk that keeps nothing but what it was asked to keep loses its power at every call.
#[test]
fn a_run_survives_a_power_cut_at_every_call() {
    let mut with_parts = 0;
    for call in 0..undisturbed().log.len() {
        let what = format!("power cut at call {call}, {:?}", undisturbed().log[call]);
        let disk = Faulty::new(Memory::default(), Some(Plan { call, lasting: true, fault: Fault::Device }));
        // It fails, or its last word is that it is complete.
        let outcome = experiment().run(&(Arc::new(disk.clone()) as Arc<dyn FileSystem>), &folder());
        let seen = disk.memory.files();
        let memory = disk.memory.after_a_power_cut();
        let kept = visible(memory.files());
        nothing_half_written(&kept, &what);
        // The folder of a part is synced last: if another call followed, the part had been committed.
        let synced = |(what, path): &(&str, PathBuf)| *what == "sync folder" && path.ends_with("parts");
        let committed = undisturbed().log[..call].iter().filter(|call| synced(call)).count();
        let complete = kept.contains_key(&folder().join(Manifest::NAME));
        let parts = kept.keys().filter(|path| in_parts(path)).count();
        assert!(complete || parts >= committed, "{what}: {parts} parts of {committed}, of {} seen", seen.len());
        assert!(outcome.is_err() || complete, "{what}");
        with_parts += usize::from(parts > 0);
        let disk: Arc<dyn FileSystem> = Arc::new(memory);
        experiment().run(&disk, &folder()).unwrap_or_else(|error| panic!("{what}: {error}"));
    }
    assert!(with_parts > 10, "no power cut while there were parts");
}

/// A report on a disk; its folder holds a complete run.
fn reported(disk: Arc<dyn FileSystem>) -> Result<(), CliError> {
    report::write_on(disk, &folder()).map(drop).map_err(CliError::Report)
}

#[test]
fn a_report_survives_a_fault_of_every_call() {
    let run = || {
        let disk = Arc::new(Memory::default());
        experiment().run(&(disk.clone() as Arc<dyn FileSystem>), &folder()).unwrap();
        disk.files()
    };
    let run = run();
    let whole = Faulty::new(Memory::of(&run), None);
    reported(Arc::new(whole.clone())).unwrap();
    let (expected, log) = (visible(whole.memory.files()), whole.log());
    assert!(expected.contains_key(&folder().join("report.html")) && expected.len() > run.len());
    for (call, asked) in log.iter().enumerate() {
        let fault = Fault::ERRORS[call % 4];
        let plan = Plan { call, lasting: call / 4 % 2 == 0, fault };
        let what = format!("{plan:?}, {asked:?}");
        let disk = Faulty::new(Memory::of(&run), Some(plan));
        let failure = reported(Arc::new(disk.clone())).expect_err(&what);
        clean(&failure, asked, &what);
        let left = visible(disk.memory.files());
        assert!(left.iter().all(|(path, bytes)| expected.get(path) == Some(bytes)), "{what}");
        // Redrawing takes a while: one repair in eight is looked at.
        if call % 8 == 0 {
            reported(disk.repaired()).unwrap();
            assert!(visible(disk.memory.files()) == expected, "{what}");
        }
    }
    eprintln!("{} calls, each with a fault", log.len());
}
