//! One name, one thing.

use crate::sources::{code, files, read, shipped};
use std::collections::BTreeMap;

/// Names of the types that a text declares.
fn types(text: &str) -> Vec<String> {
    let kinds = ["struct ", "enum ", "trait ", "type ", "union "];
    let bare = |line: &str| {
        let line = line.trim_start();
        let line =
            line.strip_prefix("pub").map_or(line, |rest| rest.trim_start_matches(|c: char| c != ' ').trim_start());
        kinds.iter().find_map(|kind| line.strip_prefix(kind)).map(str::to_owned)
    };
    let top = code(text).filter(|line| !line.starts_with("    ") || line.trim_start().starts_with("struct "));
    let names = top
        .filter_map(bare)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default().to_owned());
    names.filter(|name| name.starts_with(char::is_uppercase)).collect()
}

/// Names that more than one file declares.
fn repeated(declared: impl IntoIterator<Item = (String, String)>) -> BTreeMap<String, Vec<String>> {
    let mut files_of: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, file) in declared {
        files_of.entry(name).or_default().push(file);
    }
    files_of.retain(|_, files| files.len() > 1);
    files_of
}

#[test]
fn no_type_name_is_used_twice() {
    let all = files("src", ".rs").into_iter().flat_map(|file| {
        types(shipped(&read(format!("src/{file}")))).into_iter().map(move |name| (name, file.clone()))
    });
    let mut all: Vec<(String, String)> = all.collect();
    assert_eq!(repeated(all.clone()), BTreeMap::new());
    assert!(all.iter().any(|(name, file)| name == "HyperParams" && file == "layout/params.rs"), "{all:?}");
    all.push(("HyperParams".to_owned(), "report/page.rs".to_owned()));
    assert_eq!(repeated(all).into_keys().collect::<Vec<_>>(), ["HyperParams"]);
}
