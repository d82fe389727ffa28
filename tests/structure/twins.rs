//! Every shader has its plain twin: the same functions with the same statements, and the same comments on why.

use crate::sources::{files, read, root, shipped};
use crate::statements::likeness;
use std::collections::BTreeSet;

/// How alike the statements of twins must be.
const ALIKE: f32 = 0.75;

/// Names of the functions that a file declares, in order.
fn functions(text: &str) -> Vec<&str> {
    text.lines()
        .map(|line| line.strip_prefix("    ").filter(|line| !line.starts_with(' ')).unwrap_or(line))
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

/// Comments of one twin alone: on workgroups, which Rust does not have.
const OWN_COMMENTS: &[(&str, &str)] = &[(
    "kernels/evaluate.wgsl",
    "// Results stand by the place of the learner in this dispatch: a test is read back part by part.",
)];

/// Functions of a shader alone, and why.
const SHADER_FUNCTIONS: &[(&str, &[&str])] =
    // The kernel binds the nets for reading only; the twin takes them by `qnet/weights`.
    &[("kernels/evaluate.wgsl", &["weights_offset", "row_stride", "weight"])];

/// What is wrong with a pair of twins.
fn breaches(path: &str, wgsl: &str, rust: &str) -> Vec<String> {
    let rust = shipped(rust);
    let mut found = Vec::new();
    let names = |text: &str| functions(text).into_iter().map(str::to_owned).collect::<BTreeSet<String>>();
    let (mut there, here) = (names(wgsl), names(rust));
    for name in SHADER_FUNCTIONS.iter().filter(|(file, _)| *file == path).flat_map(|(_, names)| *names) {
        assert!(there.remove(*name), "{path} has no `{name}`");
    }
    if there != here {
        found.push(format!("{path}: functions {there:?}, in Rust {here:?}"));
    }
    let own: Vec<&str> = OWN_COMMENTS.iter().filter(|(file, _)| *file == path).map(|(_, text)| *text).collect();
    let sorted = |text: &str| {
        let mut comments = comments(text);
        comments.retain(|comment| !own.contains(&comment.as_str()));
        comments.sort();
        comments
    };
    let (said, here) = (sorted(wgsl), sorted(rust));
    if said != here {
        found.push(format!("{path}: comments {said:#?}, in Rust {here:#?}"));
    }
    if purpose(wgsl) != purpose(rust) {
        found.push(format!("{path}: `{}`, in Rust `{}`", purpose(wgsl), purpose(rust)));
    }
    let alike = likeness(wgsl, rust);
    println!("{path}: {alike:.2}");
    if alike < ALIKE {
        found.push(format!("{path}: statements are alike by {alike:.2}"));
    }
    found
}

#[test]
fn every_shader_has_its_twin() {
    let mut found = Vec::new();
    for path in files("shaders", ".wgsl") {
        let twin = format!("src/{}", path.replace(".wgsl", ".rs"));
        if root().join(&twin).exists() {
            found.extend(breaches(&path, &read(format!("shaders/{path}")), &read(twin)));
        } else {
            found.push(format!("{path}: no {twin}"));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A twin that goes its own way is found out.
#[test]
fn a_twin_that_is_none_is_found() {
    let (wgsl, rust) = (read("shaders/env/sonar.wgsl"), read("src/env/sonar.rs"));
    assert!(breaches("env/sonar.wgsl", &wgsl, &rust).is_empty());
    let lanes = read("src/backend/cpu/lanes/sonar.rs");
    assert!(likeness(&wgsl, &lanes) < ALIKE, "the tuned form passes for the plain one");
    let renamed = rust.replace("fn crossing", "fn meeting");
    assert!(breaches("env/sonar.wgsl", &wgsl, &renamed).iter().any(|breach| breach.contains("functions")));
    let silent = rust.replace("        // Sides come from", "        // Sides do not come from");
    let silent = silent.replace("    // Sides come from", "    // Sides do not come from");
    assert!(breaches("env/sonar.wgsl", &wgsl, &silent).iter().any(|breach| breach.contains("comments")));
}

/// Rust files beside the twins that have no shader, and why.
const WITHOUT_SHADER: &[(&str, &str)] = &[
    ("env/segments.rs", "the CPU wants the segments as arrays; the GPU reads the plan"),
    ("env/workgroup.rs", "a workgroup's memory is declared beside the functions that use it"),
    ("kernels/plain.rs", "a table of the hot functions; a GPU has one form of each"),
    ("qnet/init.rs", "initial weights are made once, on the host, for all backends"),
];

#[test]
fn nothing_but_twins_stands_among_the_kernels() {
    let shaders: BTreeSet<String> = files("shaders", ".wgsl").into_iter().collect();
    for folder in ["math", "env", "policy", "qnet", "learn", "kernels"] {
        for file in files(&format!("src/{folder}"), ".rs") {
            let path = format!("{folder}/{file}");
            let listed = WITHOUT_SHADER.iter().any(|(listed, _)| *listed == path);
            let twin = shaders.contains(&path.replace(".rs", ".wgsl"));
            assert!(file.ends_with("mod.rs") || (listed != twin), "src/{path} has no shader, or is listed and has one");
        }
    }
}
