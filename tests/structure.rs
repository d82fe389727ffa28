//! The two rules that keep the code in shape: twins, and one direction.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files with this ending below a folder, as paths relative to it, sorted.
fn files(folder: &Path, ending: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(open) = folders.pop() {
        for entry in std::fs::read_dir(&open).unwrap_or_else(|error| panic!("{}: {error}", open.display())) {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(ending) {
                found.push(path.strip_prefix(folder).expect("below").to_string_lossy().into_owned());
            }
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A Rust file without its tests.
fn shipped(text: &str) -> &str {
    text.split("#[cfg(test)]").next().unwrap_or(text)
}

/// Names of the functions that a file declares, in order.
fn functions(text: &str) -> Vec<&str> {
    text.lines()
        .map(|line| line.strip_prefix("pub ").unwrap_or(line))
        .map(|line| line.strip_prefix("const ").unwrap_or(line))
        .filter_map(|line| line.strip_prefix("fn "))
        .filter_map(|rest| rest.split(['(', '<']).next())
        .collect()
}

/// Comments within functions. One that stands before a barrier has no counterpart: Rust has no barriers.
fn comments(text: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with(' ')).map(str::trim).collect();
    let mut found = Vec::new();
    let mut block = Vec::new();
    for line in lines {
        if line.starts_with("//") && !line.starts_with("///") {
            block.push(line.to_owned());
        } else {
            if !line.ends_with("Barrier();") {
                found.append(&mut block);
            }
            block.clear();
        }
    }
    found
}

/// The first sentence of the comment that opens a file.
fn purpose(text: &str) -> String {
    let lines = text.lines().take_while(|line| line.starts_with("//"));
    let header: Vec<&str> = lines.map(|line| line.trim_start_matches(['/', '!']).trim()).collect();
    let header = header.join(" ");
    header.split_inclusive(". ").next().unwrap_or_default().trim().to_owned()
}

/// Comments of one twin alone: on workgroups, which Rust does not have, and on Rust's compiler.
const OWN_COMMENTS: &[(&str, &str)] = &[
    (
        "kernels/evaluate.wgsl",
        "// Results stand by the place of the learner in this dispatch: a test is read back part by part.",
    ),
    ("qnet/backward.wgsl", "// A lane without a hidden unit has no rows."),
    ("qnet/forward.wgsl", "// The last one stands in for who is missing beside it."),
    (
        "env/observe.wgsl",
        "// Behind `black_box` the compiler does not keep the keys of `draw_step` in memory on every step for this one.",
    ),
];

/// Functions of a Rust twin alone, and why.
const OWN_FUNCTIONS: &[(&str, &str)] = &[
    // Lanes that meet in memory have no sum by value.
    ("math/reduce.wgsl", "lanes_sum"),
    ("math/reduce.wgsl", "folded"),
    // A lane has one unit's sum and weights.
    ("qnet/forward.wgsl", "added"),
    ("qnet/forward.wgsl", "bits_of"),
    ("qnet/backward.wgsl", "units"),
    ("qnet/backward.wgsl", "turn"),
    ("qnet/forward.wgsl", "rows_of"),
    // A workgroup draws a lane's words in that lane, which is the bearing's own.
    ("math/rng.wgsl", "draws"),
    ("math/rng.wgsl", "place_of"),
    // A lane looks at its own bit.
    ("policy/features.wgsl", "shown"),
    // They are made when the program is compiled; a lane turns its own ray and sets its own bit.
    ("env/sonar.wgsl", "ray_table"),
    ("env/observe.wgsl", "bits"),
    // A workgroup has one robot.
    ("kernels/step.wgsl", "turn"),
    ("kernels/step.wgsl", "terms_of"),
    ("kernels/step.wgsl", "stream_of"),
    // A workgroup's lanes write their words themselves.
    ("env/observe.wgsl", "packed"),
];

/// Functions of a shader alone, and why.
const SHADER_FUNCTIONS: &[(&str, &[&str])] = &[
    // Weights in replay lie in a workgroup's own memory; the CPU's cache is that of the nets' copy (`Desk`).
    ("kernels/train.wgsl", &["weights_of", "stride_of", "weight", "put_weight", "hold", "let_go"]),
    // The same functions serve tests, where all nets lie in storage.
    ("kernels/evaluate.wgsl", &["weights_of", "stride_of", "weight"]),
];

#[test]
fn every_shader_has_its_twin() {
    let mut breaches = Vec::new();
    for path in files(&root().join("shaders"), ".wgsl") {
        let twin = root().join("src").join(path.replace(".wgsl", ".rs"));
        if !twin.exists() {
            breaches.push(format!("{path}: no {}", twin.display()));
            continue;
        }
        let (wgsl, rust) = (read(&root().join("shaders").join(&path)), read(&twin));
        let rust = shipped(&rust);
        let mut here = functions(rust);
        here.retain(|name| !OWN_FUNCTIONS.contains(&(path.as_str(), *name)));
        let mut there = functions(&wgsl);
        let own = SHADER_FUNCTIONS.iter().filter(|(file, _)| *file == path).flat_map(|(_, names)| *names);
        for name in own {
            assert!(there.contains(name), "{path} has no `{name}`");
            there.retain(|found| found != name);
        }
        if there != here {
            breaches.push(format!("{path}: functions {there:?}, in Rust {here:?}"));
        }
        let own: Vec<_> = OWN_COMMENTS.iter().filter(|(file, _)| *file == path).map(|(_, text)| *text).collect();
        let [mut said, mut here] = [comments(&wgsl), comments(rust)];
        for comments in [&mut said, &mut here] {
            comments.retain(|comment| !own.contains(&comment.as_str()));
        }
        if said != here {
            breaches.push(format!("{path}: comments {said:#?}, in Rust {here:#?}"));
        }
        if purpose(&wgsl) != purpose(rust) {
            breaches.push(format!("{path}: `{}`, in Rust `{}`", purpose(&wgsl), purpose(rust)));
        }
    }
    assert!(breaches.is_empty(), "{}", breaches.join("\n"));
}

/// Rust files beside the twins that have no shader, and why.
const WITHOUT_SHADER: &[(&str, &str)] = &[
    ("qnet/init.rs", "initial weights are made once, on the host, for both backends"),
    ("env/workgroup.rs", "a workgroup's memory is declared beside the functions that use it"),
    ("env/segments.rs", "the CPU wants the segments as arrays; the GPU reads the plan"),
];

#[test]
fn nothing_but_twins_stands_among_the_kernels() {
    let shaders: BTreeSet<String> = files(&root().join("shaders"), ".wgsl").into_iter().collect();
    for folder in ["math", "env", "policy", "qnet", "learn", "kernels"] {
        for file in files(&root().join("src").join(folder), ".rs") {
            let path = format!("{folder}/{file}");
            let listed = WITHOUT_SHADER.iter().any(|(listed, _)| *listed == path);
            let twin = shaders.contains(&path.replace(".rs", ".wgsl"));
            assert!(file == "mod.rs" || (listed != twin), "src/{path} has no shader, or is listed and has one");
        }
    }
}

/// Parts that a text names as `crate::part`.
fn uses(text: &str) -> BTreeSet<String> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let names = code.flat_map(|line| line.split("crate::").skip(1));
    let names = names.filter_map(|rest| rest.split(|c: char| !c.is_ascii_lowercase() && c != '_').next());
    names.filter(|name| !name.is_empty()).map(str::to_owned).collect()
}

/// A node of `uses` that uses itself, by way of others: what is left once all that uses nothing has been taken away.
fn circle(mut uses: BTreeMap<String, BTreeSet<String>>) -> Vec<String> {
    while let Some(free) = uses.iter().find(|(_, uses)| uses.is_empty()).map(|(name, _)| name.clone()) {
        uses.remove(&free);
        for others in uses.values_mut() {
            others.remove(&free);
        }
    }
    uses.into_keys().collect()
}

#[test]
fn modules_have_one_order() {
    let mut imports: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files(&root().join("src"), ".rs").into_iter().filter(|file| file.contains('/')) {
        let module = file.split('/').next().unwrap_or_default().to_owned();
        let mut used = uses(shipped(&read(&root().join("src").join(&file))));
        used.remove(&module);
        imports.entry(module).or_default().extend(used);
    }
    assert_eq!(circle(imports.clone()), [""; 0]);
    imports.get_mut("layout").expect("the ground floor").insert("cli".to_owned());
    assert!(circle(imports).contains(&"backend".to_owned()), "a use of `cli` by `layout` closes circles");
}

/// Where no Vulkan is installed, everything but the GPU backend must work.
#[test]
fn only_the_gpu_backend_knows_wgpu() {
    for file in files(&root().join("src"), ".rs") {
        let gpu = file.starts_with("backend/gpu/") || file == "cli/devices.rs";
        let text = read(&root().join("src").join(&file));
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        let named = code.filter(|line| line.contains("wgpu") || line.contains("naga")).count();
        assert!(gpu || named == 0, "src/{file} names wgpu or naga");
    }
}

/// Files that touch something that is not of a run folder: what the user wrote, the machine's memory, what the
/// benchmark leaves.
const READ_BY_THEMSELVES: &[&str] = &[
    "backend/memory.rs",
    "bench/archive.rs",
    "bench/export.rs",
    "bench/mod.rs",
    "bench/run.rs",
    "run_folder/file_system.rs",
    "toml/files.rs",
];

/// Tests make each call on a disk fail: one that bypasses `run_folder::file_system` would escape them.
#[test]
fn run_folders_are_reached_through_the_disk_alone() {
    let calls = ["fs::", "File::", ".exists()", ".is_file()", ".is_dir()", ".try_exists()", "read_dir("];
    let mut found = BTreeSet::new();
    for file in files(&root().join("src"), ".rs") {
        let text = read(&root().join("src").join(&file));
        let mut code = shipped(&text).lines().filter(|line| !line.trim_start().starts_with("//"));
        if code.any(|line| calls.iter().any(|call| line.contains(call))) {
            found.insert(file);
        }
    }
    assert_eq!(found, READ_BY_THEMSELVES.iter().map(|file| file.to_string()).collect());
}
