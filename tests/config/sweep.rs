//! Sweeps in configs: which arms they make, how they are laid over the rest, and a good message for every mistake.

use super::plans::{attempt_files, read_again, with};
use skilltree::config::plan::{ArmPlan, AxisValue, Design, Plan, Scale, Threshold};
use skilltree::config::{ConfigError, Overrides, Place, load};
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::{Duration, Instant};

fn shipped(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("configs").join(name)
}

fn plan(config: &str, set: &[&str]) -> Plan {
    load(&shipped(config), &with(set)).unwrap_or_else(|error| panic!("{set:?}\n{error}"))
}

fn refused(config: &str, overrides: &Overrides) -> ConfigError {
    load(&shipped(config), overrides).err().unwrap_or_else(|| panic!("accepted {overrides:?}"))
}

/// Something of each arm, in order.
fn each<T>(plan: &Plan, of: impl Fn(&ArmPlan) -> T) -> Vec<T> {
    plan.arms.iter().map(of).collect()
}

fn numbers(plan: &Plan, axis: usize) -> Vec<f64> {
    let sweep = plan.sweep.as_ref().expect("a sweep");
    let value = |value: &AxisValue| match value {
        AxisValue::Number(number) => *number,
        AxisValue::Text(text) => panic!("{text}"),
    };
    sweep.axes[axis].values.iter().map(value).collect()
}

#[test]
fn a_grid_has_all_combinations() {
    let plan = plan(
        "docking.toml",
        &[
            "arms=['taught-adam', 'taught-sgd']",
            "sweep.skill.dock.trials={from=100, to=400, steps=4}",
            "sweep.learning.learning_rate={from=1e-4, to=1e-2, steps=3, scale='log', label='learning rate'}",
        ],
    );
    let names: Vec<(&str, u32)> = plan.arms.iter().map(|arm| (arm.name.as_str(), arm.point)).collect();
    let expected: Vec<(&str, u32)> =
        ["taught-adam", "taught-sgd"].into_iter().flat_map(|arm| (0..12).map(move |point| (arm, point))).collect();
    assert_eq!(names, expected);
    // The last axis is the fastest, and the sweep wins over an arm's own rate.
    let rates = [1e-4, 1e-3, 1e-2];
    for arm in &plan.arms {
        let skill = &arm.skills[0];
        let (trials, rate) = ([100, 200, 300, 400][arm.point as usize / 3], rates[arm.point as usize % 3]);
        assert_eq!((skill.params.trials, skill.params.learning_rate), (trials, rate), "{} {}", arm.name, arm.point);
    }
    let sweep = plan.sweep.as_ref().expect("a sweep");
    assert_eq!((sweep.design, sweep.points.len()), (Design::Grid, 12));
    let axes: Vec<_> = sweep.axes.iter().map(|axis| (axis.key.as_str(), axis.label.as_str(), axis.scale)).collect();
    let expected = [
        ("skill.dock.trials", "skill.dock.trials", Scale::Linear),
        ("learning.learning_rate", "learning rate", Scale::Log),
    ];
    assert_eq!(axes, expected);
    assert_eq!((numbers(&plan, 0), numbers(&plan, 1)), (vec![100.0, 200.0, 300.0, 400.0], vec![1e-4, 1e-3, 1e-2]));
    assert_eq!(sweep.describe(5), "skill.dock.trials 200, learning rate 0.01");
    read_again(&plan);
}

#[test]
fn any_key_of_an_arm_may_be_an_axis() {
    let plan = plan(
        "lin1993.toml",
        &[
            "arms=['hierarchical']",
            "sweep.skill.recharge.applicable.dock=[0.1, 0.2, 'learned(0.5)']",
            "sweep.robot.noise.sonar=[0.0, 0.3]",
        ],
    );
    let found = each(&plan, |arm| (arm.skills[4].applicable[0], arm.skills[4].applicable[1], arm.noise.sonar));
    let fixed = |value| Some(Threshold::Fixed(value));
    let other = fixed(0.4);
    let learned = Some(Threshold::Learned(0.5));
    let expected = [
        (fixed(0.1), other, 0.0),
        (fixed(0.1), other, 0.3),
        (fixed(0.2), other, 0.0),
        (fixed(0.2), other, 0.3),
        (learned, other, 0.0),
        (learned, other, 0.3),
    ];
    assert_eq!(found, expected, "one member of the table differs, and the others stay");
    read_again(&plan);
    // One axis of each kind, each against what the same value by `--set` gives.
    for (key, values) in [
        ("skill.dock.max_steps", &["20", "40"][..]),
        ("skill.dock.reward.collision", &["-10", "-20.5"]),
        ("skill.dock.starts", &["'anywhere'", "'light-area'"]),
        ("skill.dock.eval_starts", &["anywhere", "light-area"]),
        ("skill.dock.lessons", &["0", "5"]),
        ("skill.recharge.policy", &["learned", "fixed-priority"]),
        ("skill.recharge.persistence", &["true", "false", "training"]),
        ("skill.pass-door.learning.gamma", &["0.5", "0.9"]),
        ("learning.optimiser", &["adam"]),
        ("learning.mask_blocked", &["true", "false"]),
        ("learning.hidden", &["8", "32"]),
        ("robot.memory.light_decay", &["0.5", "0.97"]),
        ("robot.beside.near", &["10", "15"]),
        ("teacher.discount", &["0.9", "0.95"]),
        ("root", &["dock", "recharge"]),
        ("world", &["worlds/office.toml", "worlds/office-easy.toml"]),
    ] {
        let quoted: Vec<String> = values
            .iter()
            .map(|value| {
                match value.parse::<f64>().is_ok() || ["true", "false"].contains(value) || value.contains('\'') {
                    true => (*value).to_owned(),
                    false => format!("'{value}'"),
                }
            })
            .collect();
        let axis = format!("sweep.{key}=[{}]", quoted.join(", "));
        let swept = self::plan("lin1993.toml", &["arms=['hierarchical']", &axis]);
        assert_eq!(swept.arms.len(), values.len(), "{axis}");
        for (arm, value) in swept.arms.iter().zip(&quoted) {
            let alone = self::plan("lin1993.toml", &["arms=['hierarchical']", &single(key, value)]);
            let world = |plan: &Plan, arm: &ArmPlan| plan.worlds[arm.world].world.clone();
            assert_eq!(world(&swept, arm), world(&alone, &alone.arms[0]), "{key} = {value}");
            let bare = ArmPlan { point: 0, world: 0, ..arm.clone() };
            assert_eq!(bare, ArmPlan { world: 0, ..alone.arms[0].clone() }, "{key} = {value}");
        }
        read_again(&swept);
    }
}

/// The same value for one run. A whole table is given where `--set` of a member would replace the rest of it.
fn single(key: &str, value: &str) -> String {
    match key {
        "skill.dock.reward.collision" => format!("skill.dock.reward={{ docked = 100, collision = {value} }}"),
        _ => format!("{key}={value}"),
    }
}

#[test]
fn random_points_are_drawn_from_the_seed() {
    let set = [
        "arms=['taught-adam']",
        "sweep.design=random",
        "sweep.points=400",
        "sweep.learning.learning_rate={from=1e-4, to=1e-2, scale='log'}",
        "sweep.learning.gamma={from=0.5, to=0.9}",
        "sweep.skill.dock.lessons={from=0, to=10}",
        "sweep.learning.mask_blocked=[true, false]",
    ];
    let plan = plan("docking.toml", &set);
    assert_eq!((plan.arms.len(), plan.sweep.as_ref().map(|sweep| sweep.design)), (400, Some(Design::Random)));
    read_again(&plan);
    let (rates, gammas, lessons) = (numbers(&plan, 0), numbers(&plan, 1), numbers(&plan, 3));
    for (values, low, high) in [(&rates, 1e-4, 1e-2), (&gammas, 0.5, 0.9), (&lessons, 0.0, 10.0)] {
        assert!(values.is_sorted() && values.iter().all(|value| (low..=high).contains(value)), "{values:?}");
    }
    assert_eq!(lessons, (0..=10).map(f64::from).collect::<Vec<_>>());
    // Quarters of 400 uniform draws hold 100, give or take four standard deviations.
    let count = |values: &[f64], upper: f64| values.iter().filter(|value| **value < upper).count() as i32;
    for (found, expected) in [
        (count(&rates, 1e-3), 200),
        (count(&rates, 10_f64.powf(-3.5)), 100),
        (count(&gammas, 0.7), 200),
        (count(&gammas, 0.8), 300),
        (each(&plan, |arm| arm.skills[0].params.mask_blocked).iter().filter(|flag| **flag == 1).count() as i32, 200),
    ] {
        assert!((found - expected).abs() < 40, "{found} of {expected}");
    }
    let points = |plan: &Plan| plan.sweep.clone().expect("a sweep").points;
    let other = self::plan("docking.toml", &[&set[..], &["seed=7"]].concat());
    assert_ne!(points(&plan), points(&other));
    // Fewer points are the first of them.
    let fewer = self::plan("docking.toml", &[&set[..], &["sweep.points=50"]].concat());
    assert_eq!(points(&fewer), points(&plan)[..50]);
    let distinct: BTreeSet<String> = points(&plan).iter().map(|point| format!("{point:?}")).collect();
    assert_eq!(distinct.len(), 400);
}

#[test]
fn layers_lie_over_sweeps_too() {
    let set = ["sweep.skill.recharge.applicable.dock=[0.3]", "sweep.robot.noise.sonar={from=0.0, to=0.1, steps=3}"];
    let plan = plan("thresholds.toml", &set);
    assert_eq!(plan.arms.len(), 7 * 3, "the axis of doors is still there");
    let again = self::plan("thresholds.toml", &[&set[..], &["sweep.robot.noise.sonar.steps=2"]].concat());
    assert_eq!(again.arms.len(), 7 * 2);
    assert!(again.arms.iter().all(|arm| arm.skills[4].applicable[0] == Some(Threshold::Fixed(0.3))));
    // A range takes the place of values, and a sum of steps is written as short as it can be.
    let range = "sweep.skill.recharge.applicable.pass-door={from=0.1, to=0.7, steps=7}";
    let plan = self::plan("thresholds.toml", &[&set[..], &[range]].concat());
    assert_eq!(numbers(&plan, 1), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
}

#[test]
fn runs_may_be_restricted() {
    let overrides = Overrides { arms: vec!["taught-sgd".into()], points: vec![4, 1], ..Overrides::default() };
    let config = shipped("sweep.toml");
    let plan = load(&config, &overrides).unwrap_or_else(|error| panic!("{error}"));
    let whole = load(&config, &with(&["arms=['taught-sgd']"])).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(plan.arms, [whole.arms[1].clone(), whole.arms[4].clone()]);
    assert_eq!(plan.sweep, whole.sweep, "all points are still told");
    read_again(&plan);
    let twice = Overrides { arms: vec!["taught-td0".into(), "taught-adam".into()], ..Overrides::default() };
    let plan = load(&shipped("docking.toml"), &twice).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(each(&plan, |arm| arm.name.clone()), ["taught-adam", "taught-td0"], "in the order of the file");
    let alone = Overrides { points: vec![0], ..Overrides::default() };
    let plan = load(&shipped("docking.toml"), &alone).unwrap_or_else(|error| panic!("{error}"));
    assert!(plan.sweep.is_none() && plan.arms.len() == 5);
    for (overrides, place, message) in [
        (Overrides { arms: vec!["taught".into()], ..Overrides::default() }, "--arm taught", "not one of the arms"),
        (Overrides { points: vec![9], ..Overrides::default() }, "--point 9", "there is no point 9"),
        (Overrides { points: vec![3, 3], ..Overrides::default() }, "--point 3", "there twice"),
    ] {
        let error = refused("sweep.toml", &overrides);
        assert_eq!(error.place(), &Place::Argument(place.to_owned()), "{error}");
        assert!(error.message().contains(message) && !error.hint().is_empty(), "{error}");
    }
    let error = refused("docking.toml", &Overrides { points: vec![1], ..Overrides::default() });
    assert!(error.message().contains("no point 1") && error.hint().contains("no sweep"), "{error}");
}

#[test]
fn an_arm_without_an_axis_is_run_once() {
    let set = ["arms=['hierarchical', 'monolithic']", "sweep.robot.noise.sonar=[0.1, 0.2]"];
    let plan = plan("thresholds.toml", &set);
    let points =
        |name: &str| -> Vec<u32> { plan.arms.iter().filter(|arm| arm.name == name).map(|arm| arm.point).collect() };
    assert_eq!(points("hierarchical"), (0..98).collect::<Vec<_>>());
    // The actions of the other arm have no thresholds.
    assert_eq!(points("monolithic"), [0, 1]);
    let alone = |point| {
        let overrides = Overrides { arms: vec!["monolithic".into()], points: vec![point], ..with(&set) };
        load(&shipped("thresholds.toml"), &overrides)
    };
    let expected = plan.arms.iter().find(|arm| (arm.name.as_str(), arm.point) == ("monolithic", 1));
    assert_eq!(alone(1).expect("one of its points").arms.first(), expected);
    let error = alone(2).expect_err("the same as its first point");
    assert!(error.message().contains("point 2 changes no arm that is run"), "{error}");
}

/// Every mistake, by `--set`: what is said, and the hint.
#[test]
fn mistakes_are_named() {
    let docking: &[(&str, &str, &str)] = &[
        ("sweep.learning.gama=[0.1]", "unknown key `learning.gama`", "did you mean `learning.gamma`?"),
        ("sweep.skill.dokc.trials=[1]", "there is no skill `dokc`", "`dock`"),
        ("sweep.skill.dock.trails=[1]", "unknown key `skill.dock.trails`", "`skill.dock.trials`"),
        ("sweep.skill.dock.learning.gama=[1]", "unknown key", "`skill.dock.learning.gamma`"),
        ("sweep.robot.noise.snoar=[0]", "unknown key", "`robot.noise.sonar`"),
        ("sweep.wrold=['a.toml']", "unknown key `wrold`", "`world`"),
        ("sweep.seed=[1, 2]", "`seed` is the same at all points", "`learning`"),
        ("sweep.seeds=['0..2']", "`seeds` is the same at all points", "an axis may run over"),
        ("sweep.evaluate.episodes=[1, 2]", "`evaluate.episodes` is the same", "an axis may"),
        ("sweep.arms=['taught-adam']", "`arms` is the same", "an axis may"),
        ("sweep.name=['a']", "`name` is the same", "an axis may"),
        ("sweep.learning.gamma=[0.5, 1.5]", "`learning.gamma` is 1.5, which is out of range", "between 0 and 1"),
        ("sweep.skill.dock.trials=[10, -1]", "is -1, which is out of range", "whole number"),
        ("sweep.skill.dock.trials=[1.5]", "must be a whole number", "whole number"),
        ("sweep.learning.gamma=['high']", "must be a number, not a string", "number"),
        ("sweep.learning.gamma=[[0.5]]", "cannot be a value on an axis", "give arms"),
        ("sweep.skill.dock.inputs=[['sonar']]", "cannot be a value on an axis", "give arms"),
        ("sweep.learning.optimiser=['adma']", "`adma` is not one of", "`adam`"),
        ("sweep.world=['worlds/nowhere.toml']", "no such file", "looked for at"),
        ("sweep.learning.gamma=0.5", "must be values, not a decimal number", "[a, b, c]"),
        ("sweep.learning.gamma=[]", "is empty", "[a, b, c]"),
        ("sweep.learning.gamma=[0.5, 0.5]", "the value 0.5 is there twice", "once"),
        ("sweep.skill.dock.trials=[1, 1.0]", "the value 1 is there twice", "once"),
        ("sweep.learning.gamma={from=0.5, to=0.4, steps=3}", "from 0.5 to 0.4", "less than `to`"),
        ("sweep.learning.gamma={from=0.5, to=1.5, steps=3}", "`sweep.learning.gamma.to` is 1.5", "between 0 and 1"),
        ("sweep.learning.gamma={from=0.5, to=0.9}", "has no number of steps", "steps"),
        ("sweep.learning.gamma={from=0.5, steps=3}", "`sweep.learning.gamma.to` is missing", "to = "),
        ("sweep.learning.gamma={from=0.5, to=0.9, steps=1}", "is 1, which is out of range", "between 2"),
        ("sweep.learning.gamma={from=0.5, to=0.9, step=3}", "unknown key", "did you mean `steps`?"),
        ("sweep.learning.gamma={from='a', to=0.9, steps=3}", "must be a number", "number"),
        ("sweep.learning.gamma={from=0.0, to=0.9, steps=3, scale='log'}", "begins at 0", "above 0"),
        ("sweep.learning.gamma={from=0.1, to=0.9, steps=3, scale='cubic'}", "`cubic` is not one of", "`log`"),
        ("sweep.skill.dock.trials={from=1, to=3, steps=9}", "takes the value 1 twice", "fewer steps"),
        ("sweep.learning.optimiser={from=0, to=1, steps=2}", "takes no range", "list the values"),
        ("sweep.learning.gamma={from=0.1, to=0.9, steps=70000}", "out of range", "65536"),
        ("sweep={}", "the sweep has no axis", "learning.gamma"),
        ("sweep.only=[1]", "there is no point 1", "no sweep"),
        ("sweep.points=3", "the sweep has no axis", "learning.gamma"),
        ("sweep.design=spiral", "`spiral` is not one of the designs", "`grid`"),
        ("sweep.skill.dock.applicable.move=[0.1]", "no arm has", "chooses among actions"),
        ("sweep.skill.dock.reward.docekd=[1]", "`docekd` is not one of the events", "`docked`"),
    ];
    let more: &[(&[&str], &str, &str)] = &[
        (&["sweep.design=random", "sweep.learning.gamma=[0.1, 0.2]"], "has no number of points", "points = 100"),
        (&["sweep.design=random", "sweep.points=3", "sweep.learning.gamma=[0.1, 0.2]"], "only 2 different", "fewer"),
        (&["sweep.points=3", "sweep.learning.gamma=[0.1, 0.2]"], "for random designs", "random"),
        (&["sweep.only=[]", "sweep.learning.gamma=[0.1, 0.2]"], "no point is chosen", "only"),
        (
            &[
                "sweep.learning.gamma={from=0.1, to=0.9, steps=300}",
                "sweep.learning.lambda={from=0.1, to=0.9, steps=300}",
            ],
            "the sweep has 300 x 300 points",
            "at most 65536",
        ),
    ];
    let arm = "arms=['taught-adam']";
    let single = docking.iter().map(|(set, message, hint)| (vec![*set], *message, *hint));
    for (set, message, hint) in single.chain(more.iter().map(|(set, message, hint)| (set.to_vec(), *message, *hint))) {
        let error = refused("docking.toml", &with(&[&[arm], &set[..]].concat()));
        println!("{error}\n");
        assert!(error.message().contains(message), "{set:?}\n{error}");
        assert!(error.hint().contains(hint), "{set:?}\n{error}");
        let Place::Argument(place) = error.place() else { panic!("{set:?}\n{error}") };
        assert!(place.starts_with("--set sweep"), "{set:?}\n{error}");
    }
    for (set, message, hint) in [
        (&["sweep.skill.recharge.applicable.dcok=[0.1]"][..], "no arm has", "did you mean `dock`?"),
        // Every skill of these arms has a rate of its own, or no trials.
        (
            &["sweep.learning.learning_rate=[0.1, 0.2]", "skill.dock.learning={learning_rate=0.1}"],
            "changes nothing in any arm",
            "skill.dock",
        ),
    ] {
        let error = refused("thresholds.toml", &with(set));
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{error}");
    }
}

#[test]
fn mistakes_in_files_have_their_line() {
    let config = |sweep: &str| {
        format!(
            "world = 'world.toml'\n[skill.dock]\ninputs = ['sonar']\nreward = {{ docked = 100 }}\ngoal = ['docked']\n[sweep]\n{sweep}\n"
        )
    };
    let world = std::fs::read_to_string(shipped("worlds/office.toml")).expect("the office");
    let read = |sweep: &str| attempt_files(&[("c.toml", &config(sweep)), ("world.toml", &world)]);
    assert_eq!(read("learning.gamma = [0.5, 0.9]").0.expect("a good sweep").arms.len(), 2);
    for (sweep, marked, message) in [
        ("learning.gamma = [0.5, 1.5]", "1.5", "out of range"),
        ("learning.gama = [0.5, 1.5]", "gama", "unknown key"),
        ("learning.gamma = [0.5]\nlearning.gamma = [0.6]", "gamma", "duplicate key"),
        ("'learning.gamma' = [0.5]", "'learning.gamma'", "unknown key"),
        ("learning.gamma = { from = 0.5, to = 7, steps = 3 }", "7", "out of range"),
        ("skill.dock.trials = { from = 1, to = 3.5, steps = 3 }", "3.5", "must be a whole number"),
        ("world = ['world.toml', 'other.toml']", "'other.toml'", "no such file"),
    ] {
        let (result, path) = read(sweep);
        let error = result.err().unwrap_or_else(|| panic!("accepted {sweep}"));
        let Place::Line { path: at, line, column, width, text } = error.place() else { panic!("{error}") };
        let found: String = text.chars().skip(column - 1).take(*width).collect();
        assert_eq!((at, found.as_str()), (&path, marked), "{error}");
        assert!(*line >= 7 && error.message().contains(message), "{error}");
    }
}

#[test]
fn thousands_of_points_are_read_soon() {
    let begun = Instant::now();
    let steps = "{from=0.0, to=0.5, steps=100}";
    let axes = ["dock", "pass-door"].map(|child| format!("sweep.skill.recharge.applicable.{child}={steps}"));
    let plan = plan("thresholds.toml", &[&axes[0], &axes[1]]);
    let elapsed = begun.elapsed();
    println!("{elapsed:?}");
    assert_eq!(plan.arms.len(), 10_000);
    // A second on an idle machine; comparing each with each would take minutes.
    assert!(elapsed < Duration::from_secs(20), "{elapsed:?}");
}

#[test]
fn the_shipped_sweeps_are_as_published() {
    let thresholds = plan("thresholds.toml", &[]);
    assert_eq!((thresholds.arms.len(), thresholds.seeds.len()), (49, 32));
    let held = each(&thresholds, |arm| (arm.skills[4].applicable[0], arm.skills[4].applicable[1]));
    for (dock, door) in [(0.15, 0.4), (0.05, 0.3), (0.25, 0.5), (0.9, 0.9)] {
        let wanted = (Some(Threshold::Fixed(dock)), Some(Threshold::Fixed(door)));
        assert_eq!(held.iter().filter(|pair| **pair == wanted).count(), 1, "{wanted:?}");
    }
    let sweep = plan("sweep.toml", &[]);
    let found = each(&sweep, |arm| (arm.skills[0].params.lessons, arm.noise.sonar));
    let expected: Vec<(u32, f32)> =
        [0, 2, 10].into_iter().flat_map(|lessons| [0.0, 0.1, 0.2].map(|noise| (lessons, noise))).collect();
    assert_eq!(found, expected);
}
