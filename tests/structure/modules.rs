//! One order of modules, and one of files: whoever reads from below never meets what he has not read.

use crate::sources::{code, files, read, shipped};
use std::collections::{BTreeMap, BTreeSet};

/// Who uses whom.
type Uses = BTreeMap<String, BTreeSet<String>>;

/// Those who use one another by way of others, circle by circle.
fn circles(uses: &Uses) -> BTreeSet<BTreeSet<String>> {
    let reached = |from: &String| {
        let mut found = BTreeSet::new();
        let mut open = vec![from];
        while let Some(next) = open.pop() {
            open.extend(uses.get(next).into_iter().flatten().filter(|used| found.insert((*used).clone())));
        }
        found
    };
    let reached: Uses = uses.keys().map(|name| (name.clone(), reached(name))).collect();
    let circle = |(name, found): (&String, &BTreeSet<String>)| -> BTreeSet<String> {
        found.iter().filter(|other| reached.get(*other).is_some_and(|back| back.contains(name))).cloned().collect()
    };
    reached.iter().map(circle).filter(|circle| !circle.is_empty()).collect()
}

/// Words and double colons of a text's code, and the braces and commas between them.
fn words(text: &str) -> Vec<String> {
    let text = code(shipped(text)).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    let mut rest = text.as_str();
    while let Some(first) = rest.chars().next() {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let length = if word(first) {
            rest.find(|c| !word(c)).unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        found.push(rest[..length].to_owned());
        rest = rest[length..].trim_start();
    }
    found
}

/// The paths that begin at word `at`, with what stands in braces taken apart. Returns the word behind them.
fn paths_at(words: &[String], at: usize, before: &[String], found: &mut Vec<Vec<String>>) -> usize {
    let mut path = before.to_vec();
    let mut at = at;
    loop {
        if words.get(at).is_some_and(|word| word == "{") {
            at += 1;
            while words.get(at).is_some_and(|word| word != "}") {
                at = paths_at(words, at, &path, found);
                if words.get(at).is_some_and(|word| word == ",") {
                    at += 1;
                }
            }
            return at + 1;
        }
        let Some(word) = words.get(at) else { break };
        path.push(word.clone());
        at += 1;
        if words.get(at).is_none_or(|word| word != "::") {
            break;
        }
        at += 1;
    }
    if words.get(at).is_some_and(|word| word == "as") {
        at += 2;
    }
    found.push(path);
    at
}

/// The modules' files as paths of names, such as `["backend", "gpu", "device"]`; a `mod.rs` is its folder.
fn module_of(file: &str) -> Vec<String> {
    let path = file.trim_end_matches(".rs");
    let path = path.strip_suffix("/mod").unwrap_or(path);
    path.split('/').map(str::to_owned).collect()
}

/// Absolute paths that a file names, and whether each is only handed on by `pub use`.
fn named(module: &[String], is_folder: bool, text: &str, children: &BTreeSet<String>) -> Vec<(Vec<String>, bool)> {
    let words = words(text);
    let mut out = Vec::new();
    for at in 0..words.len() {
        let inside = at > 0 && words[at - 1] == "::";
        let own = is_folder && children.contains(&words[at]) && words.get(at + 1).is_some_and(|next| next == "::");
        // A visibility is no path.
        let visibility = words.get(at + 1).is_some_and(|next| next == ")");
        if inside || visibility || !(matches!(words[at].as_str(), "crate" | "super" | "self") || own) {
            continue;
        }
        let handed_on = at >= 2
            && words[at - 1] == "use"
            && words[..at - 1].iter().rev().take(5).any(|w| w == "pub")
            && matches!(words[at - 2].as_str(), "pub" | ")");
        let mut found = Vec::new();
        paths_at(&words, at, &[], &mut found);
        for path in found {
            let mut place = match path[0].as_str() {
                "crate" => Vec::new(),
                "super" if is_folder => module[..module.len() - 1].to_vec(),
                "super" => module[..module.len() - 1].to_vec(),
                _ => module.to_vec(),
            };
            let ups = path.iter().take_while(|word| *word == "super").count();
            place.truncate(place.len().saturating_sub(ups.saturating_sub(1)));
            let skip = if own { 0 } else { ups.max(1) };
            place.extend(path[skip..].iter().cloned());
            out.push((place, handed_on));
        }
    }
    out
}

/// All files of `src` but the two that only name the others, and which of them uses which.
fn file_uses() -> Uses {
    let names_others = |file: &str| ["lib.rs", "main.rs"].contains(&file);
    let all: Vec<String> = files("src", ".rs").into_iter().filter(|file| !names_others(file)).collect();
    let modules: BTreeSet<Vec<String>> = all.iter().map(|file| module_of(file)).collect();
    let folder = |file: &str| file.ends_with("/mod.rs");
    let children = |module: &[String]| -> BTreeSet<String> {
        let below = modules.iter().filter(|other| other.len() == module.len() + 1 && other.starts_with(module));
        below.filter_map(|other| other.last().cloned()).collect()
    };
    // What a folder hands on from its files.
    let mut handed: BTreeMap<Vec<String>, Vec<String>> = BTreeMap::new();
    let texts: Vec<(Vec<String>, bool, String)> =
        all.iter().map(|file| (module_of(file), folder(file), read(format!("src/{file}")))).collect();
    let longest = |path: &[String]| {
        (1..=path.len()).rev().map(|length| path[..length].to_vec()).find(|path| modules.contains(path))
    };
    for (module, is_folder, text) in &texts {
        for (path, handed_on) in named(module, *is_folder, text, &children(module)) {
            if handed_on && let (Some(name), Some(file)) = (path.last(), longest(&path)) {
                handed.insert([module.as_slice(), std::slice::from_ref(name)].concat(), file);
            }
        }
    }
    let mut uses = Uses::new();
    for (module, is_folder, text) in &texts {
        let own = uses.entry(module.join("/")).or_default();
        for (path, handed_on) in named(module, *is_folder, text, &children(module)) {
            let target = (1..=path.len()).rev().find_map(|length| handed.get(&path[..length])).cloned();
            let Some(target) = target.or_else(|| longest(&path)) else { continue };
            if !handed_on && target != *module {
                own.insert(target.join("/"));
            }
        }
    }
    uses
}

/// The same with whole rooms.
fn room_uses(files: &Uses) -> Uses {
    let room = |file: &str| file.split('/').next().unwrap_or_default().to_owned();
    let mut uses = Uses::new();
    for (file, used) in files {
        let own = uses.entry(room(file)).or_default();
        own.extend(used.iter().map(|used| room(used)).filter(|used| *used != room(file)));
    }
    uses
}

#[test]
fn modules_have_one_order() {
    let mut uses = room_uses(&file_uses());
    assert_eq!(circles(&uses), BTreeSet::new());
    uses.get_mut("layout").expect("the ground floor").insert("cli".to_owned());
    assert!(
        circles(&uses).iter().any(|circle| circle.contains("backend")),
        "a use of `cli` by `layout` closes circles"
    );
}

/// A room uses those above it in the table of `src/lib.rs`, and nobody is left out of it.
#[test]
fn the_table_of_rooms_is_in_order() {
    let text = read("src/lib.rs");
    let table = text.split("# Rooms").nth(1).expect("the table").split("# How to add").next().expect("the table");
    let row = |line: &str| Some(line.strip_prefix("//! | ")?.split('`').nth(1)?.trim_start_matches("mod@").to_owned());
    let rooms: Vec<String> = table.lines().filter_map(row).collect();
    let uses = room_uses(&file_uses());
    assert_eq!(rooms.iter().collect::<BTreeSet<_>>(), uses.keys().collect());
    for (at, room) in rooms.iter().enumerate() {
        let later: Vec<&String> = uses[room].iter().filter(|used| !rooms[..at].contains(used)).collect();
        assert!(later.is_empty(), "{room} uses {later:?}, which stand below it");
    }
}

#[test]
fn files_have_one_order() {
    let mut uses = file_uses();
    assert_eq!(circles(&uses), BTreeSet::new());
    let (used, user) = ("math/functions".to_owned(), "env/contact".to_owned());
    assert!(uses[&user].contains(&used));
    uses.get_mut(&used).expect("a file").insert(user.clone());
    assert_eq!(circles(&uses), BTreeSet::from([BTreeSet::from([used, user])]));
}

/// Most lines of a file, and of half of the files.
const LONGEST: usize = 400;
const MEDIAN: usize = 150;

#[test]
fn files_can_be_read_in_one_sitting() {
    let folders = [("src", ".rs"), ("shaders", ".wgsl"), ("tests", ".rs"), ("benches", ".rs"), ("examples", ".rs")];
    let mut lengths: Vec<(usize, String)> = folders
        .iter()
        .flat_map(|(folder, ending)| files(folder, ending).into_iter().map(move |file| format!("{folder}/{file}")))
        .map(|file| (read(&file).lines().count(), file))
        .collect();
    lengths.sort();
    let long: Vec<&(usize, String)> = lengths.iter().filter(|(lines, _)| *lines > LONGEST).collect();
    assert!(long.is_empty(), "longer than {LONGEST} lines: {long:?}");
    let median = &lengths[lengths.len() / 2];
    assert!(median.0 <= MEDIAN, "half of the files are longer than {}: {median:?}", MEDIAN);
}

/// Where no Vulkan is installed, everything but the GPU backend must work.
#[test]
fn only_the_gpu_backend_knows_wgpu() {
    for file in files("src", ".rs") {
        let gpu = file.starts_with("backend/gpu/") || file == "backend/open.rs" || file.starts_with("cli/devices");
        let text = read(format!("src/{file}"));
        let named = code(&text).filter(|line| line.contains("wgpu") || line.contains("naga")).count();
        assert!(gpu || named == 0, "src/{file} names wgpu or naga");
    }
}

/// Files that touch something that is not of a run folder: what the user wrote, the machine's memory, what the
/// benchmark leaves.
const READ_BY_THEMSELVES: &[&str] =
    &["backend/memory.rs", "bench/mod.rs", "bench/result.rs", "run_folder/file_system.rs", "toml/files.rs"];

/// Tests make each call on a disk fail: one that bypasses `run_folder::file_system` would escape them.
#[test]
fn run_folders_are_reached_through_the_file_system_alone() {
    let calls = ["fs::", "File::", ".exists()", ".is_file()", ".is_dir()", ".try_exists()", "read_dir("];
    let touches = |file: &String| {
        let text = read(format!("src/{file}"));
        code(shipped(&text)).any(|line| calls.iter().any(|call| line.contains(call)))
    };
    let found: Vec<String> = files("src", ".rs").into_iter().filter(touches).collect();
    assert_eq!(found, READ_BY_THEMSELVES);
}
