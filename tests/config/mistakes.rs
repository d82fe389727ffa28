//! A good message for every mistake: on the command line, in a config, in a world, in a file that cannot be read.

use super::plans::{FILE, WORLD, attempt, each_is_refused};
use super::shipped::refused;
use skilltree::config::{Overrides, Place, load};
use std::path::{Path, PathBuf};

#[test]
fn mistakes_on_the_command_line_name_it() {
    let cases = [
        ("learning.learning_rate", "no `=`", "--set key=value"),
        ("=3", "`` is not the name of a key", "--set key=value"),
        ("learning..rate=3", "`learning..rate` is not the name", "--set key=value"),
        ("learning.learning_rate=", "`` is not a value", "number"),
        ("arms=[taught-adam]", "`[taught-adam]` is not a value", "quotes"),
        ("title=two words", "`two words` is not a value", "quotes"),
        ("learning.repays=3", "unknown key `learning.repays`", "did you mean `replays`"),
        ("lerning.gamma=0.1", "unknown key `lerning`", "did you mean `learning`"),
        ("learning.learning_rate=fast", "must be a number, not a string", "more than 0 and at most 10"),
        ("learning.learning_rate=0", "out of range", "more than 0"),
        ("learning.learning_rate=1e-60", "is 1e-60, which is out of range", "more than 0"),
        ("learning.learning_rate=nan", "`nan` is not a number", "finite"),
        ("learning.learning_rate=-inf", "`-inf` is not a number", "finite"),
        ("learning.gamma=1.5", "out of range", "between 0 and 1"),
        ("learning.beta1=0.99999999999", "out of range", "less than 1"),
        ("learning.hidden=33", "out of range", "between 1 and 32"),
        ("learning.hidden=1.5", "must be a whole number, not a decimal number", "between 1 and 32"),
        ("learning.mask_blocked=1", "must be true or false", "without quotes"),
        ("learning.optimiser=adm", "`adm` is not one of the possible values", "did you mean `adam`"),
        ("arm.taught-adam.learning.momentum=0.9", "has no effect", "optimiser = \"sgd\""),
        ("arm.taught-sgd.learning.beta1=0.5", "has no effect", "optimiser = \"adam\""),
        ("learning=3", "`learning` must be a table", "[header]"),
        ("skill.dock.learning=3", "`skill.dock.learning` must be a table", "[header]"),
        ("skill.dok.trials=3", "there is no skill `dok`", "did you mean `dock`"),
        ("skill.dock.trials=-3", "out of range", "between 0 and 100000"),
        ("skill.dock.trails=3", "unknown key `skill.dock.trails`", "did you mean `trials`"),
        ("skill.dock.max_steps=256", "out of range", "between 1 and 255"),
        ("skill.dock.lessons=257", "is 257, more than there are", "raise `teacher.lessons`"),
        ("skill.dock.eval_starts=light-aria", "no region `light-aria`", "did you mean `light-area`"),
        ("skill.dock.starts=room:D", "no region `room:D`", "`room:A`"),
        ("skill.dock.starts={anywhere=0.5}", "sum to 0.5", "sum to 1"),
        ("skill.dock.starts={anywhere=-1, light-area=2}", "out of range", "more than 0"),
        ("skill.dock.starts={}", "sum to 0", "sum to 1"),
        ("skill.dock.starts=[1]", "must be a region or a table of shares", "light-area"),
        ("skill.dock.inputs=['sonar(0)']", "`0` cannot be the scale", "between 1 and 1000"),
        ("skill.dock.inputs=['sonar(nan)']", "`nan` cannot be the scale", "sonar(60)"),
        ("skill.dock.inputs=['lihgt']", "`lihgt` is not one of the inputs", "did you mean `light`"),
        ("skill.dock.inputs=['light', 'light']", "`light` is there twice", "once"),
        ("skill.dock.inputs=[]", "is empty", "at least one"),
        ("skill.dock.inputs=['sonar', 'sonar-far', 'light']", "72 values, more than 64", "sonar 24"),
        ("skill.dock.children=['turn+15', 'follow']", "`follow` is neither an action nor a skill", "`move-12`, `dock`"),
        ("skill.dock.children=['turn15']", "`turn15` is neither an action", "did you mean `turn+15`"),
        ("skill.dock.children=['turn+15', 'turn+15']", "there twice", "once"),
        ("skill.dock.reward={dock=1}", "`dock` is not one of the events", "`docked`"),
        ("skill.dock.reward.docked=true", "must be a number", "between"),
        ("skill.dock.goal=['door']", "`door` is not one of the events", "`passed-door`"),
        ("robot.noise.sonar=0.6", "out of range", "between 0 and 0.5"),
        ("robot.noise.kind=flat", "`flat` is not one", "`gaussian`"),
        ("robot.nose.kind=flat", "unknown key `robot.nose`", "did you mean `noise`"),
        ("evaluate.at=[0, 50, 50]", "`evaluate.at[2]` does not rise", "ascending"),
        ("evaluate.at=5", "must be a list", "[ ..., ... ]"),
        ("evaluate.episodes=0", "out of range", "between 1"),
        ("teacher.backward_cost=-1", "out of range", "between 0"),
        ("seed=-1", "out of range", "between 0 and 4294967295"),
        ("seeds=[1, 1]", "the seed 1 is there twice", "once"),
        ("seeds=[]", "there are no seeds", "0..7"),
        ("seeds=true", "must be text or a list", "0..7"),
        ("arms=['tought-adam']", "`tought-adam` is not one of the arms", "did you mean `taught-adam`"),
        ("arms=[]", "no arm is chosen", "`taught-adam`"),
        ("arms=['taught-adam', 'taught-adam']", "there twice", "once"),
        ("arm.tough-adam.learning.learning_rate=1", "there is no arm `tough-adam`", "did you mean `taught-adam`"),
        ("arm.taught-adam.evaluate.episodes=1", "`evaluate` is the same for all arms", "an arm may change"),
        ("arm.taught-adam.lerning.gamma=1", "unknown key `arm.taught-adam.lerning`", "did you mean `learning`"),
        ("arm.taught-adam.skill.dok.trials=1", "there is no skill `dok`", "did you mean `dock`"),
        ("world=worlds/ofice.toml", "cannot read the world file: there is no such file", "looked for at"),
        ("name=a/b", "`a/b` cannot be a name", "letters"),
        ("title=3", "`title` must be a string", "quotes"),
        ("nonsense=3", "unknown key `nonsense`", "`learning`"),
    ];
    each_is_refused(&cases, |set| refused(&[set]));
}

#[test]
fn mistakes_in_files_have_their_line() {
    attempt(FILE, WORLD).0.unwrap_or_else(|error| panic!("{error}"));
    // What is replaced, by what, the line of the complaint (0: the file), words of its message, words of its hint.
    for (from, to, line, message, hint) in [
        ("learning_rate = 0.01", "repays = 3", 4, "unknown key `learning.repays`", "did you mean `replays`"),
        ("learning_rate = 0.01", "learning_rate = '0.01'", 4, "must be a number, not a string", "more than 0"),
        ("learning_rate = 0.01", "learning_rate = nan", 4, "`nan` is not a number", "finite"),
        ("learning_rate = 0.01", "learning_rate = -0.01", 4, "out of range", "more than 0"),
        ("learning_rate = 0.01", "learning_rate = 0.01\nlearning_rate = 0.02", 5, "duplicate key", "toml.io"),
        ("learning_rate = 0.01", "learning_rate =", 4, "not valid TOML", "toml.io"),
        ("learning_rate = 0.01", "optimiser = 'sgd'", 4, "sgd has no default learning rate", "learning_rate = 0.15"),
        ("learning_rate = 0.01", "momentum = 0.9", 4, "`learning.momentum` has no effect", "sgd"),
        ("learning.gamma = 0.5", "learning.gama = 0.5", 12, "unknown key `learning.gama`", "did you mean `gamma`"),
        ("learning.gamma = 0.5", "learning.gamma = 2", 12, "out of range", "between 0 and 1"),
        ("learning.gamma = 0.5", "seeds = '0..2'", 12, "`seeds` is the same for all arms", "an arm may change"),
        ("learning.gamma = 0.5", "skill.dok.trials = 5", 12, "no skill `dok`", "did you mean `dock`"),
        ("learning.gamma = 0.5", "skill.dock.starts = { nowhere = 1 }", 12, "no region `nowhere`", "`anywhere`"),
        ("[arm.two]", "[arm.Two]", 11, "`Two` cannot be the name of an arm", "small letters"),
        ("[arm.two]", "[arm.'two words']", 11, "`two words` cannot be the name of an arm", "small letters"),
        ("[skill.dock]", "[skill.'my dock']", 5, "`my dock` cannot be the name of a skill", "letters"),
        ("inputs = ['sonar', 'bumpers']\n", "", 5, "`skill.dock.inputs` is missing", "add `inputs = "),
        ("inputs =", "input =", 5, "`skill.dock.inputs` is missing", "did you mean `inputs`"),
        ("reward = { docked = 100 }\n", "", 5, "`skill.dock.reward` is missing", "add `reward = "),
        ("reward = { docked = 100 }", "reward = {}", 7, "nothing to learn", "docked = 100"),
        ("{ docked = 100 }", "{ passed-door = 100 }", 7, "cannot happen: the world `world` has no doors", "add doors"),
        ("starts = 'anywhere'", "starts = 'sliver'", 8, "fits nowhere in the region `sliver`", "14 inches"),
        ("world = 'world.toml'\n", "", 0, "`world` is missing", "worlds/office.toml"),
        ("world = 'world.toml'", "world = 'none.toml'", 2, "cannot read the world file", "looked for at"),
        ("world = 'world.toml'", "world = '.'", 2, "cannot read the world file", "looked for at"),
        ("world = 'world.toml'", "world = 5", 2, "must be a string", "quotes"),
        ("title = 'test'", "seeds = '7..0'", 1, "holds no seed", "after the start"),
        ("title = 'test'", "arms = ['three']", 1, "`three` is not one of the arms", "`one`, `two`"),
        ("title = 'test'", "size = 3", 1, "unknown key `size`", "`world`"),
        ("title = 'test'", "arm = 3", 10, "not valid TOML", "toml.io"),
    ] {
        assert!(FILE.contains(from), "{from}");
        let (result, path) = attempt(&FILE.replacen(from, to, 1), WORLD);
        let error = result.expect_err(to);
        println!("{error}\n");
        match error.place() {
            Place::Line { path: at, line: found, .. } => assert_eq!((at, *found), (&path, line), "{to}\n{error}"),
            Place::File(at) => assert_eq!((at, 0), (&path, line), "{to}\n{error}"),
            Place::Argument(_) => panic!("{to}\n{error}"),
        }
        assert!(error.message().contains(message) && error.hint().contains(hint), "{to}\n{error}");
    }
}

#[test]
fn mistakes_in_the_world_point_into_the_world_file() {
    let (result, path) = attempt(FILE, &WORLD.replace("[100, 100, 0]", "[100, 3, 0]"));
    let error = result.expect_err("a place in a wall");
    let Place::Line { path: at, line, text, .. } = error.place() else { panic!("{error}") };
    assert_eq!((at, *line), (&path.with_file_name("world.toml"), 5));
    assert!(text.starts_with("places"));
    for (from, to, message) in [
        ("charger = { box = [0, 0, 24, 24] }\n", "", "`docked` cannot happen: the world `world` has no charger"),
        ("light = { at = [12, 12], range = 100 }\n", "", "`light` has nothing to show: the world `world` has no light"),
    ] {
        let config = FILE.replace("'bumpers'", "'light'");
        let error = attempt(&config, &WORLD.replace(from, to)).0.expect_err(message);
        println!("{error}\n");
        assert_eq!(error.message(), message);
    }
}

#[test]
fn files_that_cannot_be_read_are_named() {
    let error = load(Path::new("no/such.toml"), &Overrides::default()).expect_err("no file");
    println!("{error}\n");
    assert_eq!(error.place(), &Place::File(PathBuf::from("no/such.toml")));
    assert!(error.message().contains("there is no such file"));
    let folder = tempfile::tempdir().expect("a folder");
    let error = load(folder.path(), &Overrides::default()).expect_err("a folder");
    println!("{error}\n");
    let path = folder.path().join("binary.toml");
    std::fs::write(&path, [0xff, 0xfe, 0x00]).expect("a file");
    let error = load(&path, &Overrides::default()).expect_err("not text");
    println!("{error}\n");
    assert!(error.hint().contains("UTF-8"));
    for text in [
        "",
        "title = 'x'",
        "= 3",
        "[skill",
        "\u{0}",
        "a = \"\u{1F916}",
        "skill = 3\nworld = 'world.toml'",
        "[skill]\nworld = 'w'",
    ] {
        let (result, _) = attempt(text, WORLD);
        println!("{}\n", result.expect_err(text));
    }
    for (arms, message) in [("[arm]\n", "there are no arms"), ("", "")] {
        let (result, _) = attempt(&format!("{}{arms}", &FILE[..FILE.find("[arm.one]").expect("arms")]), WORLD);
        match result {
            Ok(plan) => assert_eq!((plan.arms[0].name.as_str(), message), ("base", "")),
            Err(error) => assert_eq!(error.message(), message, "{error}"),
        }
    }
    let (result, _) = attempt("world = 'world.toml'\n", WORLD);
    let error = result.expect_err("no skill");
    println!("{error}\n");
    assert_eq!(error.message(), "the config has no skill");
}
