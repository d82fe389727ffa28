//! Configs of trees: which skills an arm trains, what they see and choose, worlds and alterations.

use super::plans::{attempt_files, read_again, with};
use super::rewards::rewards;
use skilltree::config::plan::{Action, Alteration, ArmPlan, Child, Event, Input, Noise, Plan, SkillPlan, Threshold};
use skilltree::config::{ConfigError, Overrides, load};
use skilltree::layout::HyperParams;
use skilltree::layout::choices::{
    BACKUP_DECISIONS, BACKUP_PERSISTENT, BACKUP_STEPS, NOISE_UNIFORM, POLICY_FIXED_PRIORITY, POLICY_LEARNED,
    POLICY_RANDOM,
};
use skilltree::layout::sensors::SONAR_SCALE;
use std::path::PathBuf;

pub(crate) const FAMILY: &str = "\
world = 'worlds/flat.toml'
[evaluate]
at = [0, 10, 20]
[skill.recharge]
inputs = ['sonar-compass(40)', 'compass2', 'values', 'applicable', 'lit', 'running', 'room']
children = ['explore', 'dock']
applicable = { dock = 0.25 }
reward = { docked = 100 }
eval_at = [0, 20, 60]
[skill.left]
mirror = 'right'
eval_at = [0]
[skill.right]
inputs = ['sonar', 'bumpers']
children = ['turn+15', 'turn-60', 'move+12', 'move-12', 'turn-15', 'turn+60']
reward = { beside-right = 3, beside-left = -2, collision = -1 }
goal = ['beside-right', 'passed-door']
starts = 'room:A'
eval_starts = 'room:B'
max_steps = 77
lessons = 5
trials = 66
learning = { gamma = 0.75 }
[skill.spare]
inputs = ['light']
reward = { docked = 1 }
[skill.dock]
inputs = ['light']
reward = { docked = 1 }
[skill.explore]
inputs = ['compass', 'light-trace', 'door-trace', 'range-means', 'sonar-compass']
children = ['left', 'move+12']
reward = { passed-door = 1 }
[arm.full]
root = 'recharge'
[arm.sides]
root = 'explore'
[arm.easy]
root = 'recharge'
world = 'worlds/easy.toml'
skill.recharge.children = ['dock', 'right']
skill.recharge.applicable = { right = 'learned' }
[transfer.moved]
world = 'other/easy.toml'
[transfer.loud]
noise = { actuator = 0.16, kind = 'uniform' }
";
pub(crate) const FLAT: &str = "\
size = [208, 200]
boxes = [[100, 0, 108, 50], [100, 110, 108, 200]]
rooms = [{ name = 'A', box = [0, 0, 100, 200] }, { name = 'B', box = [108, 0, 208, 200] }]
doors = [{ name = 'door', rooms = ['A', 'B'], centre = [104, 80], width = 60 }]
charger = { box = [0, 0, 24, 24] }
light = { at = [12, 12], range = 100 }
";

/// Loads a config with three worlds beside it.
pub(crate) fn family(config: &str, set: &[&str]) -> (Result<Plan, ConfigError>, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [
        ("config.toml", config.to_owned()),
        ("worlds/flat.toml", FLAT.to_owned()),
        ("worlds/easy.toml", FLAT.replace("[12, 12]", "[20, 20]")),
        ("other/easy.toml", FLAT.replace("'door'", "'gate'")),
        ("other/dark.toml", FLAT.replace("light = ", "# light = ")),
        ("other/bare.toml", FLAT.replace("charger = ", "# charger = ")),
        ("other/closed.toml", FLAT.replace("doors = ", "# doors = ")),
        ("other/turned.toml", FLAT.replace("'A'", "'X'").replace("'B'", "'A'").replace("'X'", "'B'")),
    ] {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        // A world without a name has its file's, which is another one in a run folder.
        let stem = path.file_stem().expect("a stem").to_string_lossy();
        let named = if name == "config.toml" { text } else { format!("name = '{stem}'\n{text}") };
        std::fs::write(path, named).expect("a file");
    }
    let path = folder.path().join("config.toml");
    (load(&path, &with(set)), path)
}

pub(crate) fn relatives(set: &[&str]) -> Plan {
    family(FAMILY, set).0.unwrap_or_else(|error| panic!("{error}"))
}

fn arm<'a>(plan: &'a Plan, name: &str) -> &'a ArmPlan {
    plan.arms.iter().find(|arm| arm.name == name).expect("the arm")
}

pub(crate) fn names(arm: &ArmPlan) -> Vec<&str> {
    arm.skills.iter().map(|skill| skill.name.as_str()).collect()
}

pub(crate) fn skill<'a>(plan: &'a Plan, arm_name: &str, name: &str) -> &'a SkillPlan {
    arm(plan, arm_name).skills.iter().find(|skill| skill.name == name).expect("the skill")
}

#[test]
fn an_arm_trains_the_tree_of_its_root() {
    let plan = relatives(&[]);
    // Children before parents, mirrored ones before their images, otherwise as in the file.
    assert_eq!(names(arm(&plan, "full")), ["right", "left", "dock", "explore", "recharge"]);
    assert_eq!(names(arm(&plan, "sides")), ["right", "left", "explore"]);
    assert_eq!(names(arm(&plan, "easy")), ["right", "dock", "recharge"]);
    let recharge = skill(&plan, "full", "recharge");
    assert_eq!(recharge.children, [Child::Skill(3), Child::Skill(2)]);
    assert_eq!(recharge.applicable, [None, Some(Threshold::Fixed(0.25))]);
    assert!(recharge.is_high() && !skill(&plan, "full", "dock").is_high());
    assert_eq!(skill(&plan, "full", "explore").children, [Child::Skill(1), Child::Action(Action::Forward)]);
    // Thresholds are replaced as a whole.
    let recharge = skill(&plan, "easy", "recharge");
    assert_eq!(recharge.children, [Child::Skill(1), Child::Skill(0)]);
    assert_eq!(recharge.applicable, [None, Some(Threshold::Learned(0.5))]);
    // Without a name, the root is the last one that no other is made of, be it as a child or as a mirror image.
    let base = &FAMILY[..FAMILY.find("[arm.full]").expect("arms")];
    let root = |text: &str| {
        let plan = family(text, &[]).0.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((plan.arms.len(), plan.arms[0].name.as_str()), (1, "base"));
        names(&plan.arms[0]).last().map(|&name| name.to_owned())
    };
    assert_eq!(root(base).as_deref(), Some("spare"));
    let recharge = base.replace("['explore', 'dock']", "['explore', 'dock', 'spare']");
    assert_eq!(root(&recharge).as_deref(), Some("recharge"));
    let pair =
        "world = 'worlds/flat.toml'\n[skill.a]\nmirror = 'b'\n[skill.b]\ninputs = ['sonar']\nreward.docked = 1\n";
    assert_eq!(root(pair).as_deref(), Some("a"));
    assert_eq!(names(arm(&relatives(&["arm.easy.root=left"]), "easy")), ["right", "left"]);
    let text = format!("root = 'dock'\n{}", &FAMILY.replace("root = 'recharge'\n", ""));
    let plan = family(&text, &[]).0.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((names(arm(&plan, "full")), names(arm(&plan, "sides")).len()), (vec!["dock"], 3));
}

#[test]
fn a_mirror_image_takes_everything_from_its_skill() {
    let plan = relatives(&[]);
    let (left, right) = (skill(&plan, "full", "left"), skill(&plan, "full", "right"));
    let pays =
        |right, left| rewards(&[(Event::Collision, -1.0), (Event::BesideRight, right), (Event::BesideLeft, left)]);
    assert_eq!((right.params.reward, right.mirror), (pays(3.0, -2.0), None));
    assert_eq!((right.eval_at.as_slice(), left.eval_at.as_slice()), (&[0, 10, 20][..], &[0][..]));
    let turned = [
        Action::TurnRight15,
        Action::TurnLeft60,
        Action::Forward,
        Action::Backward,
        Action::TurnLeft15,
        Action::TurnRight60,
    ];
    let image = SkillPlan {
        name: "left".to_owned(),
        children: turned.map(Child::Action).to_vec(),
        mirror: Some(0),
        params: HyperParams { reward: pays(-2.0, 3.0), lessons: 0, trials: 0, ..right.params },
        goal: Event::BesideLeft.bit() | Event::PassedDoor.bit(),
        eval_at: vec![0],
        ..right.clone()
    };
    assert_eq!(*left, image);
    assert_eq!((left.params.max_steps, left.params.gamma, left.eval_starts.as_str()), (77, 0.75, "room:B"));
    assert_eq!((right.params.lessons, right.params.trials), (5, 66));
    // Keys beside the name are unused, until an arm says that there is no mirror.
    let own = "arm.sides.skill.left={ mirror = false, inputs = ['compass'], reward = { passed-door = 9 } }";
    let plan = relatives(&["skill.left.trials=9", own]);
    let (left, alone) = (skill(&plan, "full", "left"), skill(&plan, "sides", "left"));
    assert_eq!((left.params.trials, left.mirror), (0, Some(0)));
    assert_eq!((alone.params.trials, alone.mirror, &alone.inputs), (9, None, &vec![Input::Compass]));
    assert_eq!(names(arm(&plan, "sides")), ["left", "explore"]);
    // A skill without nets has no image of them.
    let plan = relatives(&["skill.right.oracle=true", "arm.easy.skill.recharge.applicable={ right = 0.5 }"]);
    for name in ["left", "right"] {
        let planned = skill(&plan, "full", name);
        assert_eq!((planned.oracle, planned.mirror, planned.params.trials, planned.params.lessons), (true, None, 0, 0));
    }
}

/// How a skill keeps to its child: in training, in tests, applicability, interrupt, steps.
fn persistence(skill: &SkillPlan) -> [u32; 5] {
    let own = &skill.params;
    [own.persist_training, own.persist_tests, own.applicability, own.interrupt, own.child_timeout]
}

/// What its robot remembers, and the band beside a wall.
fn memory(skill: &SkillPlan) -> (f32, f32, f32, u32, u32) {
    let own = &skill.params;
    (own.light_decay, own.door_decay, own.range_decay, own.beside_near, own.beside_far)
}

#[test]
fn skills_say_what_they_see_and_how_they_choose() {
    let plan = relatives(&[]);
    let recharge = skill(&plan, "full", "recharge");
    let seen = [
        Input::SonarCompass { scale: 40.0 },
        Input::Compass2,
        Input::Values,
        Input::Applicable,
        Input::Lit,
        Input::Running,
        Input::Room,
    ];
    assert_eq!(recharge.inputs, seen);
    assert_eq!(recharge.width(2), 24 + 2 + 1 + 1 + 1 + 2 + 2);
    let seen = [
        Input::Compass,
        Input::LightTrace,
        Input::DoorTrace,
        Input::RangeMeans,
        Input::SonarCompass { scale: SONAR_SCALE },
    ];
    assert_eq!(skill(&plan, "full", "explore").inputs, seen);
    assert_eq!((recharge.eval_at.as_slice(), recharge.params.policy), (&[0, 20, 60][..], POLICY_LEARNED));
    assert!(!recharge.oracle && recharge.mirror.is_none());
    assert_eq!(persistence(recharge), [1, 1, 1, 1, 30]);
    assert_eq!(memory(recharge), (0.97, 0.97, 0.9, 15, 30));
    let learning = &recharge.params;
    assert_eq!((learning.shared_net, learning.backup, learning.advantage_scale), (0, BACKUP_DECISIONS, 1.0));
    assert_eq!((learning.intra_skill_share, learning.child_inverse_temperature), (0.1, 60.0));

    let plan = relatives(&[
        "skill.recharge.policy=fixed-priority",
        "skill.recharge.persistence=training",
        "skill.recharge.applicability=false",
        "skill.recharge.interrupt=false",
        "skill.recharge.child_timeout=0",
        "skill.recharge.trials=0",
        "skill.recharge.applicable={ explore = -1, dock = 'learned(0.8)' }",
        "skill.dock.goal=['docked']",
        "skill.recharge.learning={ shared_net = true, backup = 'steps', advantage_scale = 1000 }",
        "arm.full.learning={ intra_skill_share = 1, child_inverse_temperature = 0, backup = 'persistent' }",
        "skill.dock.policy=random",
        "skill.dock.persistence=false",
        "robot.memory={ light_decay = 0, door_decay = 0.5, range_decay = 0.25 }",
        "arm.full.robot.beside={ near = 0, far = 127 }",
    ]);
    let recharge = skill(&plan, "full", "recharge");
    assert_eq!(persistence(recharge), [1, 0, 0, 0, 0]);
    assert_eq!((recharge.params.policy, recharge.params.trials), (POLICY_FIXED_PRIORITY, 0));
    assert_eq!(recharge.applicable, [Some(Threshold::Fixed(-1.0)), Some(Threshold::Learned(0.8))]);
    let learning = &recharge.params;
    assert_eq!((learning.shared_net, learning.backup, learning.advantage_scale), (1, BACKUP_STEPS, 1000.0));
    assert_eq!((learning.intra_skill_share, learning.child_inverse_temperature), (1.0, 0.0));
    let dock = skill(&plan, "full", "dock");
    assert_eq!((dock.params.policy, dock.params.backup), (POLICY_RANDOM, BACKUP_PERSISTENT));
    assert_eq!(persistence(dock)[..2], [0, 0]);
    assert_eq!(memory(recharge), (0.0, 0.5, 0.25, 0, 127));
    assert_eq!(memory(skill(&plan, "easy", "recharge")), (0.0, 0.5, 0.25, 15, 30));
    let planned = skill(&relatives(&["skill.dock.oracle=true", "skill.dock.lessons=9"]), "full", "dock").clone();
    assert_eq!((planned.oracle, planned.params.trials, planned.params.lessons), (true, 0, 0));
}

#[test]
fn worlds_are_read_once_and_named_for_the_run_folder() {
    let plan = relatives(&[]);
    let files: Vec<&str> = plan.worlds.iter().map(|world| world.file.as_str()).collect();
    assert_eq!(files, ["world.toml", "worlds/easy.toml", "worlds/easy-2.toml"]);
    assert_eq!((arm(&plan, "full").world, arm(&plan, "sides").world, arm(&plan, "easy").world), (0, 0, 1));
    assert_ne!(plan.world().light, plan.world_of(arm(&plan, "easy")).light);
    assert!(plan.worlds[0].text.ends_with(FLAT));
    let loud = Noise { kind: NOISE_UNIFORM, actuator: 0.16, ..arm(&plan, "full").noise };
    let alterations = [
        Alteration { name: "moved".to_owned(), world: Some(2), noise: None },
        Alteration { name: "loud".to_owned(), world: None, noise: Some(loud) },
    ];
    assert_eq!(plan.alterations, alterations);
    read_again(&plan);
    // The same file under other names is one world; worlds of arms that are not run are there all the same.
    let plan = relatives(&[
        "arm.full.world=worlds/../worlds/flat.toml",
        "transfer.moved.world=./worlds/easy.toml",
        "transfer.moved.noise.sonar=0.5",
        "robot.noise.sonar=0.25",
        "transfer.loud.world=worlds/flat.toml",
        "arms=['sides']",
    ]);
    assert_eq!((plan.worlds.len(), plan.arms.len(), plan.arms[0].world), (2, 1, 0));
    assert_eq!((plan.alterations[0].world, plan.alterations[1].world), (Some(1), Some(0)));
    let noise = |number: usize| plan.alterations[number].noise.expect("noise");
    assert_eq!((noise(0).sonar, noise(1).sonar, noise(1).actuator), (0.5, 0.25, 0.16));
    read_again(&plan);
    // Names that no run folder takes are made fit.
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("big")).expect("a folder");
    let worlds =
        ["flat.toml", "two words.toml", ".two words", "big/EASY.toml", "easy.toml", "easy-2.toml", "...toml", "world"];
    let mut text = FAMILY[..FAMILY.find("[arm.full]").expect("arms")].replace("worlds/flat", "flat");
    for (number, name) in worlds.iter().enumerate() {
        std::fs::write(folder.path().join(name), FLAT).expect("a file");
        text += &format!("[arm.a{number}]\nworld = '{name}'\n");
    }
    let path = folder.path().join("config.toml");
    std::fs::write(&path, text).expect("a file");
    let plan = load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let files: Vec<&str> = plan.worlds.iter().map(|world| world.file.as_str()).collect();
    let fit = ["two-words", "two-words-2", "EASY", "easy-2", "easy-2-2", "world", "world-2"];
    assert_eq!(files[1..], fit.map(|name| format!("worlds/{name}.toml")));
    let again: Vec<(&str, &str)> = [("config.toml", plan.resolved.as_str())]
        .into_iter()
        .chain(plan.worlds.iter().map(|world| (world.file.as_str(), world.text.as_str())))
        .collect();
    let again = attempt_files(&again).0.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((&again.resolved, &again.arms), (&plan.resolved, &plan.arms));
}
