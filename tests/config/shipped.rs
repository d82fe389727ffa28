//! What the shipped files say, layers, seeds, the resolved text.

use super::plans::{FILE, WORLD, attempt, attempt_files, read_again, with};
use super::rewards::rewards;
use skilltree::config::plan::{Action, ArmPlan, Child, Event, Input, Plan};
use skilltree::config::{ConfigError, Overrides, Place, keys, load, parse_seeds};
use skilltree::layout::HyperParams;
use skilltree::layout::choices::{NOISE_GAUSSIAN, OPTIMISER_ADAM, OPTIMISER_SGD};
use skilltree::train::allocate::Shape;
use std::path::{Path, PathBuf};

pub(crate) fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(name)
}

fn docking(set: &[&str]) -> Plan {
    load(&shipped("docking.toml"), &with(set)).unwrap_or_else(|error| panic!("{error}"))
}

pub(crate) fn refused(set: &[&str]) -> ConfigError {
    match load(&shipped("docking.toml"), &with(set)) {
        Ok(_) => panic!("accepted {set:?}"),
        Err(error) => error,
    }
}

fn rate(plan: &Plan, arm: &str) -> f32 {
    let arm = plan.arms.iter().find(|a| a.name == arm).expect("the arm");
    arm.skills[0].params.learning_rate
}

#[test]
fn docking_is_as_published() {
    let plan = docking(&[]);
    assert_eq!(plan.name, "docking");
    assert_eq!(plan.run_seed, 1993);
    assert_eq!(plan.seeds, [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(plan.world().name, "office");
    assert_eq!(plan.evaluate.at, [0, 25, 50, 75, 100, 150, 200, 250, 300]);
    assert_eq!(plan.evaluate.episodes, 100);
    let names: Vec<&str> = plan.arms.iter().map(|arm| arm.name.as_str()).collect();
    assert_eq!(names, ["taught-adam", "taught-sgd", "taught-td0", "untaught-adam", "untaught-sgd"]);
    for arm in &plan.arms {
        let noise = arm.noise;
        assert_eq!((noise.kind, noise.actuator, noise.sonar), (NOISE_GAUSSIAN, 0.08, 0.10));
        let dock = &arm.skills[0];
        assert_eq!(arm.skills.len(), 1);
        assert_eq!(dock.name, "dock");
        assert_eq!(dock.inputs, [Input::Sonar { scale: 60.0 }, Input::Light, Input::Bumpers]);
        assert_eq!(dock.children, Action::ALL.map(Child::Action));
        assert_eq!(dock.params.reward, rewards(&[(Event::Docked, 100.0), (Event::Collision, -10.0)]));
        assert_eq!(dock.eval_at, plan.evaluate.at);
        assert_eq!(dock.starts, [("light-area".to_owned(), 0.8), ("anywhere".to_owned(), 0.2)]);
        assert_eq!((dock.eval_starts.as_str(), dock.goal), ("light-area", Event::Docked.bit()));
        assert_eq!((dock.params.max_steps, dock.params.trials), (30, 300));
        assert_eq!(dock.params.lessons, if arm.name.starts_with("untaught") { 0 } else { 10 });
    }
    let learning = |i: usize| &plan.arms[i].skills[0].params;
    let (adam, sgd, td0) = (learning(0), learning(1), learning(2));
    assert_eq!((adam.optimiser, adam.learning_rate), (OPTIMISER_ADAM, 0.0015));
    assert_eq!((adam.beta1, adam.beta2, adam.epsilon), (0.9, 0.999, 1e-3));
    assert_eq!((adam.hidden, adam.init_range, adam.gamma, adam.lambda), (32, 0.2, 0.9, 0.95));
    assert_eq!(
        (adam.replays, adam.replay_capacity, adam.replay_mean_age, adam.policy_threshold),
        (60, 300, 100.0, 0.05)
    );
    assert_eq!((adam.learning_rate_end_share, adam.learning_rate_trials, sgd.learning_rate_end_share), (0.1, 300, 1.0));
    assert_eq!([adam.timeout_terminal, adam.mask_blocked, adam.taught_as_policy], [1; 3]);
    assert_eq!((sgd.optimiser, sgd.learning_rate, sgd.beta1), (OPTIMISER_SGD, 0.15, 0.0));
    assert_eq!((sgd.init_range, sgd.gamma, sgd.lambda, sgd.policy_threshold), (0.2, 0.95, 0.8, 0.001));
    assert_eq!((sgd.replays, sgd.replay_capacity, sgd.pretrain_epochs, sgd.taught_replays), (30, 100, 5, 2));
    assert_eq!((sgd.timeout_terminal, sgd.mask_blocked), (0, 0));
    assert_eq!(td0.lambda, 0.0);
    assert_eq!(&HyperParams { lambda: 0.95, ..*td0 }, adam);
    for (untaught, taught) in [(learning(3), adam), (learning(4), sgd)] {
        assert_eq!(&HyperParams { lessons: 10, ..*untaught }, taught);
    }
}

#[test]
fn quick_is_the_papers_main_comparison() {
    let plan = |name: &str| load(&shipped(name), &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let (quick, whole) = (plan("quick.toml"), plan("lin1993.toml"));
    let wanted: Vec<_> = whole.arms.iter().filter(|arm| ["hierarchical", "monolithic"].contains(&&*arm.name)).collect();
    assert_eq!(quick.arms.len(), wanted.len());
    for (arm, other) in quick.arms.iter().zip(wanted) {
        let trials = |arm: &ArmPlan| {
            arm.skills.iter().map(|skill| (skill.name.clone(), skill.params.trials)).collect::<Vec<_>>()
        };
        assert_eq!((&arm.name, trials(arm)), (&other.name, trials(other)));
        let (root, same) = (arm.skills.last().expect("a root"), other.skills.last().expect("a root"));
        assert_eq!((&root.params, &root.applicable), (&same.params, &same.applicable));
    }
    assert_ne!(quick.title, whole.title);
}

#[test]
fn every_office_serves_the_docking_config() {
    for name in ["office", "office-easy", "office-hard"] {
        assert_eq!(docking(&[&format!("world=worlds/{name}.toml")]).world().name, name);
    }
}

#[test]
fn every_default_is_read_and_in_range() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("small.toml");
    let world = shipped("worlds/office.toml").display().to_string();
    let text = format!("world = '{world}'\n[skill.s]\ninputs = ['sonar']\nreward = {{ docked = 1 }}\n");
    std::fs::write(&path, text).expect("a file");
    let plan = load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(plan.arms.len(), 1);
    assert_eq!(plan.arms[0].name, "base");
    // The defaults are the taught Adam arm of docking.
    let (own, taught) = (plan.arms[0].skills[0].params, docking(&[]).arms[0].skills[0].params);
    assert_eq!(own, HyperParams { lessons: own.lessons, reward: own.reward, ..taught });
    assert_eq!((own.lessons, own.reward), (0, rewards(&[(Event::Docked, 1.0)])));
    assert_eq!(plan.arms[0].noise, docking(&[]).arms[0].noise);
    assert_eq!((plan.arms[0].teacher, plan.evaluate), (docking(&[]).arms[0].teacher, docking(&[]).evaluate));
    for key in keys::all() {
        let last = key.path.rsplit('.').next().expect("a name");
        let written = plan.resolved.contains(&format!("{last} = ")) || plan.resolved.contains(&format!(".{last}]"));
        let rare = ["arms", "root", "extends", "arm.*.extends", "skill.*.eval_at"];
        let left_out = rare.contains(&key.path) || key.path.starts_with("sweep.");
        assert_eq!(written, !left_out, "{}", key.path);
        assert!(!key.doc.is_empty() && !key.allowed.to_string().is_empty());
    }
}

#[test]
fn the_resolved_text_gives_the_same_plan() {
    let cases: [&[&str]; 4] = [
        &[],
        &["arms=[\"untaught-sgd\", \"taught-adam\"]", "title=\"a \\\"quoted\\\" \\\\ title\\nin two lines\""],
        &[
            "arm.taught-sgd.learning.learning_rate=0.3",
            "learning.gamma=0.123456789",
            "seed=4294967295",
            "learning.epsilon=1e-10",
        ],
        &["skill.dock.starts={\"room:A\" = 0.25, anywhere = 0.75}", "robot.noise.kind=uniform"],
    ];
    for set in cases {
        let overrides = Overrides { seeds: Some("3,5..8".to_owned()), ..with(set) };
        let plan = load(&shipped("docking.toml"), &overrides).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(plan.seeds, [3, 5, 6, 7]);
        read_again(&plan);
    }
}

#[test]
fn layers_lie_over_one_another() {
    // On a base key: wins over the file's base, not over an arm's own key.
    let plan = docking(&["learning.learning_rate=0.01"]);
    assert_eq!((rate(&plan, "taught-adam"), rate(&plan, "taught-sgd")), (0.01, 0.15));
    // On an arm's key: that arm only.
    let plan = docking(&["arm.taught-sgd.learning.learning_rate=0.3"]);
    assert_eq!(
        (rate(&plan, "taught-sgd"), rate(&plan, "untaught-sgd"), rate(&plan, "taught-adam")),
        (0.3, 0.15, 0.0015)
    );
    // On a skill's learning: over `learning` of base and arm.
    let plan = docking(&["skill.dock.learning.learning_rate=0.02"]);
    assert_eq!((rate(&plan, "taught-adam"), rate(&plan, "taught-sgd")), (0.02, 0.02));
    // The later of two wins, and an arm without the key takes it.
    let plan = docking(&["skill.dock.trials=5", "skill.dock.trials = 7", "arm.taught-td0.skill.dock.trials=9"]);
    assert_eq!(plan.arms.iter().map(|a| a.skills[0].params.trials).collect::<Vec<_>>(), [7, 7, 9, 7, 7]);
    // Rewards merge, start shares are replaced.
    let plan =
        docking(&["skill.dock.reward.collision=0", "skill.dock.starts=light-area", "skill.dock.eval_starts=room:A"]);
    assert_eq!(plan.arms[0].skills[0].params.reward, rewards(&[(Event::Docked, 100.0)]));
    assert_eq!(plan.arms[0].skills[0].starts, [("light-area".to_owned(), 1.0)]);
    assert_eq!(plan.arms[0].skills[0].eval_starts, "room:A");
    let plan = docking(&["skill.dock.starts={light-area=0.5, near-doors=0.5}"]);
    assert_eq!(plan.arms[0].skills[0].starts.len(), 2);
    // A subset of the arms keeps the file's order; noise is an arm's too.
    let plan = docking(&["arms=['untaught-adam', 'taught-adam']", "arm.taught-adam.robot.noise.sonar=0"]);
    assert_eq!(plan.arms.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), ["taught-adam", "untaught-adam"]);
    assert_eq!((plan.arms[0].noise.sonar, plan.arms[1].noise.sonar), (0.0, 0.10));
    let plan = docking(&["skill.dock.inputs=['sonar', 'sonar-far', 'bumpers', 'compass']", "seeds=[4, 2]"]);
    assert_eq!(plan.arms[0].skills[0].inputs[1..], [Input::SonarFar, Input::Bumpers, Input::Compass]);
    assert_eq!(plan.seeds, [2, 4]);
    assert_eq!(docking(&["seeds=5"]).seeds, [5]);
    assert_eq!(docking(&["seeds=5..7"]).seeds, [5, 6]);
}

#[test]
fn seeds_are_ranges_and_lists() {
    let all = |text: &str| parse_seeds(text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(all("0..7"), [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(all("0..=6"), all("0..7"));
    assert_eq!(all("5"), [5]);
    assert_eq!(all("1,2,5..9"), [1, 2, 5, 6, 7, 8]);
    assert_eq!(all(" 9, 1 .. 3 "), [1, 2, 9]);
    assert_eq!(all("4294967295"), [u32::MAX]);
    assert_eq!(all("4294967294..=4294967295"), [u32::MAX - 1, u32::MAX]);
    assert_eq!(all("0..1048576").len(), 1 << 20);
    for (text, message, hint) in [
        ("", "`` is not a seed", "0..7"),
        ("a", "`a` is not a seed", "0..7"),
        ("-1", "`-1` is not a seed", "0 to 4294967295"),
        ("+1", "`+1` is not a seed", "0 to 4294967295"),
        ("1.5", "`1.5` is not a seed", "0..7"),
        ("4294967296", "is not a seed", "0 to 4294967295"),
        ("0..", "`` is not a seed", "0..7"),
        ("1,,2", "`` is not a seed", "0..7"),
        ("7..0", "`7..0` holds no seed", "after the start"),
        ("3..3", "`3..3` holds no seed", "0..7 for 0 to 6"),
        ("1,1", "the seed 1 is there twice", "once"),
        ("0..5,3", "the seed 3 is there twice", "once"),
        ("0..4294967295", "too many seeds", "1048576"),
        ("0..1048576,1048576", "too many seeds", "1048576"),
    ] {
        let error = parse_seeds(text).expect_err(text);
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{text}: {error}");
        assert_eq!(error.place(), &Place::Argument(format!("--seeds {text}")));
    }
    let overrides = Overrides { seeds: Some("7..1".to_owned()), ..Overrides::default() };
    let error = load(&shipped("docking.toml"), &overrides).expect_err("a reversed range");
    assert_eq!(error.place(), &Place::Argument("--seeds 7..1".to_owned()));
}

#[test]
fn a_config_may_lie_over_another() {
    let over = "extends = 'base.toml'\nseeds = '3'\n[learning]\ngamma = 0.25\n[arm.mine]\n";
    let load = |over: &str, base: &str| {
        let files = [("over.toml", over), ("base.toml", base), ("world.toml", WORLD), ("far/base.toml", base)];
        attempt_files(&files)
    };
    let base = format!("name = 'other'\n{FILE}");
    let (plan, below) = (load(over, &base).0.unwrap_or_else(|error| panic!("{error}")), attempt(FILE, WORLD).0);
    let below = below.expect("the file is good");
    assert_eq!((plan.name.as_str(), plan.title.as_str(), plan.seeds.as_slice()), ("over", "", &[3][..]));
    let arms: Vec<&str> = plan.arms.iter().map(|arm| arm.name.as_str()).collect();
    assert_eq!(arms, ["one", "two", "mine"]);
    assert_eq!(plan.evaluate, below.evaluate);
    let mut skill = below.arms[0].skills[0].clone();
    let gammas: Vec<f32> = plan.arms.iter().map(|arm| arm.skills[0].params.gamma).collect();
    assert_eq!(gammas, [0.25, 0.5, 0.25]);
    skill.params.gamma = 0.25;
    assert_eq!(plan.arms[2].skills, [skill]);
    // The resolved text stands alone.
    read_again(&plan);
    let chain = format!("extends = 'world.toml'\n{base}");
    for (name, base, message) in [
        ("far/base.toml", &base, "lies in another folder"),
        ("../base.toml", &base, "lies in another folder"),
        ("none.toml", &base, "there is no such file"),
        ("base.toml", &chain, "itself extends another config"),
    ] {
        let (result, path) = load(&over.replace("base.toml", name), base);
        let error = result.expect_err(message);
        println!("{error}\n");
        assert!(error.message().contains(message), "{error}");
        let Place::Line { path: at, line: 1, .. } = error.place() else { panic!("{error}") };
        assert_eq!(*at, path);
    }
}

#[test]
fn an_arm_may_be_like_another() {
    let text = format!(
        "{FILE}{}",
        "\
[arm.three]
extends = 'two'
skill.dock.max_steps = 50
[arm.four]
extends = 'three'
learning.gamma = 0.75
learning.learning_rate = 0.5
"
    );
    let plan = attempt(&text, WORLD).0.unwrap_or_else(|error| panic!("{error}"));
    let numbers = |name: &str| {
        let skill = &plan.arms.iter().find(|arm| arm.name == name).expect("the arm").skills[0];
        (skill.params.gamma, rate(&plan, name), skill.params.max_steps)
    };
    let expected = [("one", (0.9, 0.01, 30)), ("two", (0.5, 0.01, 30)), ("three", (0.5, 0.01, 50))];
    for (name, expected) in expected.into_iter().chain([("four", (0.75, 0.5, 50))]) {
        assert_eq!(numbers(name), expected, "{name}");
    }
    read_again(&plan);
    for (from, to, line, message) in [
        ("extends = 'two'", "extends = 'six'", "extends = 'six'", "`six` is not one of the arms"),
        ("extends = 'two'", "extends = 'four'", "extends = ", "in a circle"),
        ("extends = 'two'", "extends = 3", "extends = 3", "must be a string"),
        ("title", "extends = 'two'\ntitle", "extends = 'two'", "cannot read the config file"),
    ] {
        let error = attempt(&text.replacen(from, to, 1), WORLD).0.err().unwrap_or_else(|| panic!("accepted {to}"));
        println!("{error}\n");
        assert!(error.message().contains(message), "{to}\n{error}");
        let Place::Line { text, .. } = error.place() else { panic!("{to}\n{error}") };
        assert!(text.contains(line), "{to}\n{error}");
    }
}

#[test]
fn every_shipped_config_can_be_laid_out() {
    let mut arms = 0;
    for entry in std::fs::read_dir(shipped("")).expect("the configs") {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let plan = load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        // Laying out takes a while: all arms of the main experiment, and one of each of the others.
        let count = if path.ends_with("lin1993.toml") { plan.arms.len() } else { 1 };
        for arm in &plan.arms[..count] {
            Shape::new(plan.world_of(arm), &[arm]).unwrap_or_else(|error| panic!("{}: {error}", arm.name));
        }
        arms += plan.arms.len();
    }
    assert!(arms > 25, "{arms}");
}
