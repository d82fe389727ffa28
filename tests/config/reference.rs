//! The reference of every key, the JSON schemas of editors, old names, and configs that are read from memory.

use super::plans::with;
use serde_json::Value;
use skilltree::config::keys;
use skilltree::config::reference::{config_schema, text, world_schema};
use skilltree::config::{MemoryFiles, Overrides, Place, load, load_from};
use std::path::{Path, PathBuf};

fn configs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs")
}

#[test]
fn the_reference_has_every_key() {
    let all = text("");
    for key in keys::all() {
        assert!(all.contains(&format!("  {}", key.path)) && all.contains(key.doc.trim()), "{}", key.path);
        assert!(text(key.path).contains(key.path), "{}", key.path);
    }
    for found in ["turn-60", "beside-left", "sonar-compass (24)", "charger.tolerance = 30.0", "doors[].width"] {
        assert!(all.contains(found), "{found}");
    }
    let one = text("skill.dock.learning.gamma");
    assert!(one.contains("learning.gamma = 0.9  (default: ours)") && one.contains("a number between 0 and 1"), "{one}");
    assert!(one.contains("Discount factor.") && !one.contains("lambda"), "{one}");
    assert!(text("arm.x.robot.noise.sonar").contains("robot.noise.sonar = 0.10  (default: paper)"));
    assert!(text("DISCOUNT").contains("teacher.discount"));
    assert_eq!(text("no such thing"), "");
}

/// `skilltree keys --json-schema config > configs/schema.json` makes them anew.
#[test]
fn the_shipped_schemas_are_those_of_the_rows() {
    for (path, schema) in [("schema.json", config_schema()), ("worlds/schema.json", world_schema())] {
        let shipped = std::fs::read_to_string(configs().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(shipped == format!("{schema:#}\n"), "configs/{path} is not what `skilltree keys --json-schema` prints");
    }
}

/// What a schema says against a value: types, ranges, words, unknown keys. As much of JSON schema as the shipped ones use.
fn breaches(schema: &Value, value: &Value, path: &str, found: &mut Vec<String>) {
    let kind = match value {
        Value::Number(number) if number.is_f64() => "number",
        Value::Number(_) => "integer",
        Value::String(_) => "string",
        Value::Bool(_) => "boolean",
        Value::Array(_) => "array",
        _ => "object",
    };
    let fits = |name: &Value| name == kind || (name == "number" && kind == "integer");
    let right = match &schema["type"] {
        Value::Null => true,
        Value::Array(names) => names.iter().any(fits),
        name => fits(name),
    };
    let number = value.as_f64().unwrap_or_default();
    let bound = |key: &str| schema[key].as_f64();
    let inside = value.as_f64().is_none()
        || bound("minimum").is_none_or(|low| number >= low)
            && bound("maximum").is_none_or(|high| number <= high)
            && bound("exclusiveMinimum").is_none_or(|low| number > low)
            && bound("exclusiveMaximum").is_none_or(|high| number < high);
    let listed = schema["enum"].as_array().is_none_or(|words| words.contains(value));
    if !(right && inside && listed) {
        found.push(format!("{path}: {value}"));
    }
    if let (Some(entries), true) = (value.as_object(), schema["properties"].is_object()) {
        for (key, value) in entries {
            let (own, other) = (&schema["properties"][key], &schema["additionalProperties"]);
            match (own.is_object(), other) {
                (true, _) => breaches(own, value, &format!("{path}.{key}"), found),
                (false, Value::Object(_)) => breaches(other, value, &format!("{path}.{key}"), found),
                (false, Value::Bool(true)) => {}
                _ => found.push(format!("{path}.{key} is unknown")),
            }
        }
    }
    if let (Some(items), true) = (value.as_array(), schema["items"].is_object()) {
        items.iter().for_each(|item| breaches(&schema["items"], item, path, found));
    }
}

fn checked(schema: &Value, text: &str) -> Vec<String> {
    let value: toml::Table = toml::from_str(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let mut found = Vec::new();
    breaches(schema, &serde_json::to_value(value).expect("JSON"), "", &mut found);
    found
}

#[test]
fn the_schemas_accept_what_ships_and_refuse_mistakes() {
    let toml = |folder: &Path| {
        let files = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect::<Vec<_>>()
    };
    let read = |path: &Path| std::fs::read_to_string(path).expect("a file");
    for path in toml(&configs()) {
        assert_eq!(checked(&config_schema(), &read(&path)), [""; 0], "{}", path.display());
        // So is everything that the program itself writes.
        let plan = load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(checked(&config_schema(), &plan.resolved), [""; 0], "{}", path.display());
    }
    for path in [toml(&configs().join("worlds")), toml(&configs().join("worlds/altered"))].concat() {
        assert_eq!(checked(&world_schema(), &read(&path)), [""; 0], "{}", path.display());
    }
    for (text, found) in [
        ("[learning]\ngamma = 1.5", ".learning.gamma: 1.5"),
        ("[learning]\nreplay_capacity = 0", ".learning.replay_capacity: 0"),
        ("[learning]\ntarget_clip = 1.0", ".learning.target_clip: 1.0"),
        ("[arm.a.learning]\nhidden = 2.5", ".arm.a.learning.hidden: 2.5"),
        ("[skill.dock.learning]\noptimiser = 'rmsprop'", ".skill.dock.learning.optimiser: \"rmsprop\""),
        ("[skill.dock]\nends = []", ".skill.dock.ends is unknown"),
        ("[transfer.loud.noise]\nsonar = 2", ".transfer.loud.noise.sonar: 2"),
        ("seeds = true", ".seeds: true"),
    ] {
        assert_eq!(checked(&config_schema(), text), [found]);
    }
    assert_eq!(checked(&world_schema(), "[[doors]]\nwidth = -1"), [".doors.width: -1"]);
}

#[test]
fn an_old_name_is_refused_with_the_new_one() {
    for (set, message, hint) in [
        ("learning.rate=0.1", "`learning.rate` has another name now", "write `learning_rate`"),
        ("skill.dock.learning.memory=3", "`skill.dock.learning.memory` has", "write `replay_capacity`"),
        ("arm.taught-sgd.learning.taught_passes=3", "taught_passes` has", "write `pretrain_epochs`"),
        ("arm.taught-sgd.skill.dock.tests=anywhere", "tests` has", "write `eval_starts`"),
        ("skill.dock.ends=[]", "`skill.dock.ends` has", "write `goal`"),
        ("sweep.learning.rate=[0.1, 0.2]", "`sweep.learning.rate` has", "write `learning_rate`"),
        ("sweep.skill.dock.planned=[true, false]", "planned` has", "write `oracle`"),
        ("alter.x.world=a.toml", "`alter` has", "write `transfer`"),
        ("arm.taught-sgd.like=untaught-sgd", "like` has", "write `extends`"),
        ("robot.memory.doors=0.5", "`robot.memory.doors` has", "write `door_decay`"),
        ("teacher.bank=3", "`teacher.bank` has", "write `lessons`"),
        ("skill.dock.policy=ordered", "`ordered` of `skill.dock.policy` has", "write \"fixed-priority\""),
        ("sweep.skill.dock.policy=['random', 'ordered']", "`ordered` of", "write \"fixed-priority\""),
    ] {
        let error = load(&configs().join("docking.toml"), &with(&[set])).expect_err(set);
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint() == hint, "{error}");
        assert_eq!(error.place(), &Place::Argument(format!("--set {set}")));
    }
    let files = MemoryFiles::from_iter([("old.toml", "world = 'w.toml'\n[skill.s]\ntested_at = [3]\n")]);
    let error = load_from(&files, Path::new("old.toml"), &Overrides::default()).expect_err("an old key");
    assert!(error.to_string().contains("old.toml:3:1") && error.to_string().contains("^^^^^^^^^"), "{error}");
    assert_eq!(error.hint(), "write `eval_at`");
}

#[test]
fn configs_from_memory_are_those_of_the_disk() {
    let read = |name: &str| std::fs::read_to_string(configs().join(name)).expect("a file");
    let names = ["quick.toml", "lin1993.toml", "worlds/office.toml"];
    let files: MemoryFiles = names.into_iter().map(|name| (format!("here/./{name}"), read(name))).collect();
    let plan = load_from(&files, Path::new("here/worlds/../quick.toml"), &Overrides::default());
    let plan = plan.unwrap_or_else(|error| panic!("{error}"));
    let other = load(&configs().join("quick.toml"), &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((plan.resolved, plan.arms, plan.worlds[0].world.clone()), {
        (other.resolved, other.arms, other.worlds[0].world.clone())
    });
    let error = load_from(&files, Path::new("sweep.toml"), &Overrides::default()).expect_err("no such text");
    assert_eq!(error.place(), &Place::File(PathBuf::from("sweep.toml")));
    let alone = MemoryFiles::from_iter([("quick.toml", read("lin1993.toml"))]);
    let error = load_from(&alone, Path::new("quick.toml"), &Overrides::default()).expect_err("no world");
    assert!(error.message().contains("cannot read the world file: there is no such file"), "{error}");
}

#[test]
fn the_command_prints_the_reference_and_the_schemas() {
    let keys = |arguments: &[&str]| {
        let program = std::process::Command::new(env!("CARGO_BIN_EXE_skilltree")).arg("keys").args(arguments).output();
        let output = program.expect("the program runs");
        let [out, said] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("text"));
        (output.status.code(), out, said)
    };
    assert_eq!(keys(&[]), (Some(0), text(""), String::new()));
    assert_eq!(keys(&["teacher"]), (Some(0), text("teacher"), String::new()));
    assert_eq!(keys(&["--json-schema", "config"]).1, format!("{:#}\n", config_schema()));
    assert_eq!(keys(&["--json-schema", "world"]).1, format!("{:#}\n", world_schema()));
    let (code, out, said) = keys(&["no such thing"]);
    assert_eq!((code, out.as_str()), (Some(2), ""));
    assert!(said.contains("no key matches `no such thing`") && said.contains("hint: "), "{said}");
}
