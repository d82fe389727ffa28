//! Configs of trees: which skills an arm trains, what they see and choose, worlds and alterations.

mod plans;

use plans::{attempt_files, read_again, with};
use skilltree::config::plan::{Action, Alteration, ArmPlan, Child, Event, Input, Noise, Plan, SkillPlan, Threshold};
use skilltree::config::{ConfigError, Overrides, Place, load};
use skilltree::layout::HyperParams;
use skilltree::layout::choices::{
    BACKUP_DECISIONS, BACKUP_PERSISTENT, BACKUP_STEPS, NOISE_UNIFORM, POLICY_FIXED_PRIORITY, POLICY_LEARNED,
    POLICY_RANDOM,
};
use skilltree::layout::sensors::SONAR_SCALE;
use std::path::PathBuf;

const FAMILY: &str = "\
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
const FLAT: &str = "\
size = [208, 200]
boxes = [[100, 0, 108, 50], [100, 110, 108, 200]]
rooms = [{ name = 'A', box = [0, 0, 100, 200] }, { name = 'B', box = [108, 0, 208, 200] }]
doors = [{ name = 'door', rooms = ['A', 'B'], centre = [104, 80], width = 60 }]
charger = { box = [0, 0, 24, 24] }
light = { at = [12, 12], range = 100 }
";

/// Loads a config with three worlds beside it.
fn family(config: &str, set: &[&str]) -> (Result<Plan, ConfigError>, PathBuf) {
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

fn relatives(set: &[&str]) -> Plan {
    family(FAMILY, set).0.unwrap_or_else(|error| panic!("{error}"))
}

fn arm<'a>(plan: &'a Plan, name: &str) -> &'a ArmPlan {
    plan.arms.iter().find(|arm| arm.name == name).expect("the arm")
}

fn names(arm: &ArmPlan) -> Vec<&str> {
    arm.skills.iter().map(|skill| skill.name.as_str()).collect()
}

fn skill<'a>(plan: &'a Plan, arm_name: &str, name: &str) -> &'a SkillPlan {
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
    assert_eq!((right.params.reward, right.mirror), ([0.0, -1.0, 0.0, 3.0, -2.0], None));
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
        params: HyperParams { reward: [0.0, -1.0, 0.0, -2.0, 3.0], lessons: 0, trials: 0, ..right.params },
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

#[test]
fn trees_and_worlds_that_cannot_be_are_refused() {
    // What is set, words of the message, words of the hint.
    for (set, message, hint) in [
        ("root=dok", "`dok` is not one of the skills", "did you mean `dock`"),
        ("arm.full.root=dok", "`dok` is not one of the skills", "did you mean `dock`"),
        ("root=3", "`root` must be a string", "quotes"),
        ("arm.full.world=worlds/eazy.toml", "cannot read the world file: there is no such file", "looked for at"),
        ("arm.full.world=3", "`world` must be a string", "quotes"),
        ("arm.full.transfer={}", "`transfer` is the same for all arms", "`world`, `root`"),
        ("arm.full.wrld=x", "unknown key `arm.full.wrld`", "did you mean `world`"),
        ("skill.recharge.children=['explore', 'dok']", "`dok` is neither an action nor a skill", "`dock`"),
        ("skill.spare.children=['dok']", "`dok` is neither an action nor a skill", "did you mean `dock`"),
        (
            "skill.explore.children=['recharge']",
            "`recharge` is made of itself: recharge > explore > recharge",
            "drop one",
        ),
        ("skill.explore.children=['explore']", "`explore` is made of itself: explore > explore", "drop one"),
        ("skill.recharge.applicable={ dok = 0 }", "`dok` is not among the children", "did you mean `dock`"),
        ("skill.recharge.applicable={ left = 0 }", "`left` is not among the children", "`explore`, `dock`"),
        ("skill.explore.applicable={ move+12 = 0 }", "is not a value", "number"),
        ("skill.explore.applicable={ 'move+12' = 0 }", "`move+12` has no threshold", "only skills"),
        ("skill.dock.applicable={ left = 0 }", "`left` is not among the children", "there are no skills"),
        ("skill.recharge.applicable=[]", "must be a table", "key = value"),
        ("skill.recharge.applicable.dock=1.01", "is 1.01, which is out of range", "between -1 and 1"),
        ("skill.recharge.applicable.dock=true", "must be a number", "between -1 and 1"),
        ("skill.recharge.applicable.dock=lerned", "`lerned` is not a threshold", "\"learned(0.8)\""),
        ("skill.recharge.applicable.dock='learned(1)'", "`1` cannot be the probability", "less than 1"),
        ("skill.recharge.applicable.dock='learned(x)'", "`x` cannot be the probability", "learned(0.8)"),
        ("skill.dock.inputs=['applicable']", "`applicable` of `dock` has nothing to show", "applicable = {"),
        ("skill.dock.inputs=['sonar-compass(0)']", "`0` cannot be the scale", "sonar-compass(60)"),
        ("skill.dock.inputs=['lit(3)']", "`lit(3)` is not one of the inputs", "`sonar-compass`"),
        ("skill.dock.inputs=['compass3']", "`compass3` is not one of the inputs", "did you mean `compass`"),
        ("skill.dock.inputs=['light', 'sonar', 'sonar-compass']", "72 values, more than 64", "running 1 per child"),
        ("skill.recharge.policy=lerned", "`lerned` is not one of the possible values", "did you mean `learned`"),
        ("skill.recharge.persistence=tests", "must be true, false or \"training\"", "not in tests"),
        ("skill.recharge.persistence=1", "must be true, false or \"training\"", "not in tests"),
        ("skill.recharge.applicability=1", "must be true or false", "without quotes"),
        ("skill.recharge.interrupt=1", "must be true or false", "without quotes"),
        ("skill.recharge.child_timeout=256", "out of range", "between 0 and 255"),
        ("skill.recharge.eval_at=[3, 2]", "`skill.recharge.eval_at[1]` does not rise", "ascending"),
        ("skill.left.eval_at=5", "must be a list", "[ ..., ... ]"),
        ("skill.recharge.oracle=true", "`recharge` chooses among skills and cannot be planned", "actions only"),
        ("skill.recharge.oracle=yes", "must be true or false", "without quotes"),
        ("skill.recharge.lessons=1", "`recharge` cannot have lessons: nobody demonstrates skills", "lessons = 0"),
        ("skill.left.mirror=rigt", "`rigt` is not one of the skills", "did you mean `right`"),
        ("skill.left.mirror=true", "must be the name of a skill, or false", "mirror = false"),
        ("skill.left.mirror=left", "`left` cannot be the mirror image of `left`: it is the same", "mirror = false"),
        (
            "skill.left.mirror=explore",
            "`left` cannot be the mirror image of `explore`: it chooses among",
            "over actions",
        ),
        ("skill.dock.mirror=left", "`dock` cannot be the mirror image of `left`: it is a mirror image", "of its own"),
        ("skill.left.trails=3", "unknown key `skill.left.trails`", "did you mean `trials`"),
        ("skill.left.learning.rte=3", "unknown key `skill.left.learning.rte`", "did you mean `rate`"),
        ("skill.spare.trails=3", "unknown key `skill.spare.trails`", "did you mean `trials`"),
        ("arm.full.skill.spare.eval_starts=3", "`skill.spare.eval_starts` must be a string", "quotes"),
        ("skill.spare.eval_starts=attic", "has no region `attic`", "`anywhere`"),
        (
            "skill.recharge.goal=['beside-rigt']",
            "`beside-rigt` is not one of the events",
            "did you mean `beside-right`",
        ),
        ("robot.memory.light_decay=1", "out of range", "less than 1"),
        ("robot.memory.door_decay=-0.1", "out of range", "at least 0"),
        ("robot.memory.range_decay=0", "unknown key `robot.memory.range_decay`", "did you mean `ranges`"),
        (
            "robot.beside.near=30",
            "`robot.beside.near` is 30, which is not less than `robot.beside.far`, 30",
            "near < far",
        ),
        ("robot.beside.far=15", "`robot.beside.near` is 15, which is not less", "near < far"),
        ("robot.beside.far=128", "out of range", "between 0 and 127"),
        ("robot.besides.far=12", "unknown key `robot.besides`", "did you mean `beside`"),
        ("learning.backup=step", "`step` is not one of the possible values", "did you mean `steps`"),
        ("learning.shared_net=1", "must be true or false", "without quotes"),
        ("learning.advantage_scale=0.5", "out of range", "between 1 and 1000"),
        ("arm.full.learning.intra_skill_share=1.5", "out of range", "between 0 and 1"),
        ("skill.dock.learning.child_inverse_temperature=-1", "out of range", "between 0 and 10000"),
        ("transfer.movd.world=worlds/flat.toml", "there is no alteration `movd`", "did you mean `moved`"),
        ("transfer.moved.wrld=x", "unknown key `transfer.moved.wrld`", "did you mean `world`"),
        ("transfer.loud.noise=0.3", "`transfer.loud.noise` must be a table", "key = value"),
        ("transfer.loud.noise.loud=0.3", "unknown key `transfer.loud.noise.loud`", "`actuator`"),
        (
            "transfer.loud.noise.sonar=0.6",
            "`transfer.loud.noise.sonar` is 0.6, which is out of range",
            "between 0 and 0.5",
        ),
        ("transfer.moved.world=other/turned.toml", "has the rooms B, A, not those of `flat`", "same order: A, B"),
        (
            "transfer.moved.world=other/closed.toml",
            "`passed-door` cannot happen: the world `closed` has no doors",
            "`explore`",
        ),
        (
            "transfer.moved.world=other/bare.toml",
            "`docked` cannot happen: the world `bare` has no charger",
            "`recharge`",
        ),
        (
            "transfer.moved.world=other/dark.toml",
            "the world `dark` has no region `light-area`, where tests of `recharge`",
            "region",
        ),
    ] {
        let error = family(&strict(), &[set]).0.err().unwrap_or_else(|| panic!("accepted {set}"));
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{set}\n{error}");
        assert_eq!(error.place(), &Place::Argument(format!("--set {set}")), "{error}");
    }
}

/// The config above with roots whose tests can be held against altered worlds.
fn strict() -> String {
    let text = FAMILY.replace("[0, 20, 60]", "[0, 20, 60]\neval_starts = 'light-area'\ngoal = ['docked']");
    text.replace("{ passed-door = 1 }", "{ passed-door = 1 }\ngoal = ['passed-door']")
}

#[test]
fn what_does_not_go_together_is_shown_in_the_file() {
    let missing = "is neither an action nor a skill";
    // What is replaced, by what, words of the line that is shown, of the message and of the hint.
    for (from, to, line, message, hint) in [
        ("{ dock = 0.25 }", "{}", "'values'", "`values` of `recharge` has nothing to show: no child has", "drop this"),
        ("['explore', 'dock']", "['dock']", "'running'", "`running` of `recharge` has nothing to show", "add children"),
        ("['explore', 'dock']", "['explore', 'dck']", "'dck'", missing, "did you mean `dock`"),
        ("['left', 'move+12']", "['recharge']", "['recharge']", "recharge > explore > recharge", "drop one"),
        ("['sonar', 'bumpers']", "['sonar', 'compass']", "'right'", "whose input `compass` has none", "sonar-far"),
        ("mirror = 'right'", "mirror = 3", "mirror = 3", "must be the name of a skill, or false", "mirror = false"),
        ("[skill.spare]", "[skill.turn-15]", "turn-15", "`turn-15` cannot be the name of a skill", "another name"),
        ("worlds/easy", "other/dark", "['light']", "the world `dark` has no light", "[light]"),
        ("worlds/easy", "other/bare", "docked", "cannot happen: the world `bare` has no charger", "add charger"),
        (
            "[arm.full]\nroot = 'recharge'",
            "[arm.full]\nroot = 'dock'\nworld = 'other/closed.toml'\nskill.dock.inputs = ['door-trace']",
            "'door-trace'",
            "the world `closed` has no doors",
            "[[doors]]",
        ),
        (
            "'explore'\n",
            "'explore'\nworld = 'other/turned.toml'\n",
            "other/easy",
            "not those of `turned`",
            "order: B, A",
        ),
        ("world = 'other/easy.toml'", "", "[transfer.moved]", "`transfer.moved` alters nothing", "noise = {"),
        (
            "[transfer.moved]",
            "[transfer.Moved]",
            "Moved",
            "`Moved` cannot be the name of an alteration",
            "small letters",
        ),
        ("'other/easy.toml'", "'other/none.toml'", "none", "cannot read the world file", "looked for at"),
        ("'other/easy.toml'", "3", "world = 3", "`transfer.moved.world` must be a string", "quotes"),
        (
            "{ actuator = 0.16, kind",
            "{ acuator = 0.16, kind",
            "acuator",
            "unknown key `transfer.loud.noise.acuator`",
            "actuator",
        ),
        (
            "[transfer.moved]",
            "[transfer]\nmoved = 3\n[transfer.x]",
            "moved = 3",
            "`transfer.moved` must be a table",
            "[header]",
        ),
    ] {
        let text = strict();
        assert!(text.contains(from), "{from}");
        let (result, path) = family(&text.replacen(from, to, 1), &[]);
        let error = result.err().unwrap_or_else(|| panic!("accepted {to}"));
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{to}\n{error}");
        let Place::Line { path: at, text, column, width, .. } = error.place() else { panic!("{to}\n{error}") };
        let shown: String = text.chars().skip(column - 1).take(*width).collect();
        assert!(*at == path && (shown.contains(line) || text.contains(line)), "{to}: {shown}\n{error}");
    }
}

/// What is replaced in a text, and by what.
type Edits<'a> = &'a [(&'a str, &'a str)];

/// What would be silently without effect, or wrong, is refused.
#[test]
fn thresholds_that_nothing_teaches_and_mirrors_that_show_something_else_are_refused() {
    let learned = "'learned'";
    // What is replaced, by what, words of the line that is shown, of the message and of the hint.
    let cases: [(Edits<'_>, &str, &str, &str); 6] = [
        (&[("goal = ['beside-right', 'passed-door']", "goal = []")], learned, "`right` has no goal", "a number"),
        (&[("trials = 66", "trials = 0")], learned, "`right` has no trials", "a number"),
        (&[("trials = 66", "oracle = true")], learned, "`right` is planned", "a number"),
        (
            &[("applicable = { right =", "applicable = { left ="), ("['dock', 'right']", "['dock', 'left']")],
            learned,
            "`left` is a mirror image",
            "a number",
        ),
        (
            &[("['left', 'move+12']", "['right', 'move+12']\napplicable = { right = 'learned' }")],
            learned,
            "`explore` is not the root",
            "a number",
        ),
        (&[("{ gamma = 0.75 }", "{ mirror_replays = true }")], "mirror_replays", "beside-right", "false"),
    ];
    for (edits, line, message, hint) in cases {
        let text = edits.iter().fold(strict(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        let (result, path) = family(&text, &[]);
        let error = result.err().unwrap_or_else(|| panic!("accepted {edits:?}"));
        println!("{error}\n");
        assert!(error.message().contains(message) && error.hint().contains(hint), "{edits:?}\n{error}");
        let Place::Line { path: at, text, .. } = error.place() else { panic!("{edits:?}\n{error}") };
        assert!(*at == path && text.contains(line), "{edits:?}\n{error}");
    }
    for (set, message) in [
        ("skill.dock.children=['turn+15', 'move+12']", "no turn the other way than `turn+15`"),
        ("skill.dock.inputs=['light', 'compass']", "whose input `compass` has no mirror image"),
        ("skill.dock.children=['right', 'move+12']", "chooses among skills"),
    ] {
        let error = family(FAMILY, &[set, "skill.dock.learning.mirror_replays=true"]).0.expect_err(message);
        println!("{error}\n");
        assert!(error.message().contains(message), "{error}");
    }
    let fine = ["skill.dock.learning.mirror_replays=true", "skill.dock.children=['turn-60', 'move+12', 'turn+60']"];
    assert!(skill(&relatives(&fine), "full", "dock").params.mirror_replays == 1);
    // Where nobody is paid for one side only, and no end is on one side only, a mirror does no harm.
    let even = ["skill.right.reward={ beside-right = 3, beside-left = 3 }", "skill.right.goal=['passed-door']"];
    assert!(family(FAMILY, &[even.as_slice(), &["skill.right.learning.mirror_replays=true"]].concat()).0.is_ok());
    let uneven = [even[0], "skill.right.goal=['beside-left']", "skill.right.learning.mirror_replays=true"];
    let error = family(FAMILY, &uneven).0.expect_err("an end on one side");
    assert!(error.message().contains("`beside-right` than in `beside-left`"), "{error}");
}

#[test]
fn trees_are_neither_too_large_nor_too_deep() {
    let skill = |name: &str, children: &str| {
        format!("[skill.{name}]\ninputs = ['bumpers']\nreward = {{ docked = 1 }}\nchildren = [{children}]\n")
    };
    let leaves = |number: usize| (0..number).map(|leaf| format!("'leaf{leaf}'")).collect::<Vec<_>>().join(", ");
    let wide = |number: usize| {
        let below: String = (0..number - 1).map(|leaf| skill(&format!("leaf{leaf}"), "'move+12'")).collect();
        format!("world = 'worlds/flat.toml'\n{}{below}", skill("top", &leaves(number - 1)))
    };
    let deep = |number: usize| {
        let chain = |at: usize| skill(&format!("level{at}"), &format!("'level{}', 'turn+15'", at + 1));
        let above: String = (1..number).map(chain).collect();
        format!("world = 'worlds/flat.toml'\n{above}{}", skill(&format!("level{number}"), "'move+12'"))
    };
    for (text, skills) in [(wide(8), 8), (deep(6), 6)] {
        let plan = family(&text, &[]).0.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(plan.arms[0].skills.len(), skills);
    }
    for (text, message, hint) in [
        (wide(9), "the tree of `top` has 9 skills", "at most 8"),
        (deep(7), "the tree of `level1` is 7 skills deep", "at most 6"),
    ] {
        let error = family(&text, &[]).0.expect_err(message);
        println!("{error}\n");
        assert!(error.message() == message && error.hint().contains(hint), "{error}");
        assert!(matches!(error.place(), Place::Line { line: 2, .. }), "{error}");
        // A smaller part of it will do.
        let root = if text.contains("leaf0") { "root=leaf0" } else { "root=level2" };
        assert!(family(&text, &[root]).0.is_ok());
    }
    // A cycle in a part that nobody trains does no harm; one further down is named from where it begins.
    let text = format!("{}{}", deep(2), skill("a", "'b'") + &skill("b", "'a'"));
    assert_eq!(names(&family(&text, &["root=level1"]).0.unwrap_or_else(|error| panic!("{error}")).arms[0]).len(), 2);
    let error = family(&text.replace("'move+12'", "'a'"), &["root=level1"]).0.expect_err("a cycle");
    assert_eq!(error.message(), "`a` is made of itself: a > b > a");
}
