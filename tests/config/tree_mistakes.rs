//! Trees, worlds, thresholds and mirrors that cannot be: a good message for each.

use super::plans::each_is_refused;
use super::trees::{FAMILY, family, names, relatives, skill};
use skilltree::config::Place;

#[test]
fn trees_and_worlds_that_cannot_be_are_refused() {
    // What is set, words of the message, words of the hint.
    let cases = [
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
        ("skill.recharge.oracle=true", "`recharge` chooses among skills and cannot be an oracle", "actions only"),
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
        ("skill.left.learning.repays=3", "unknown key `skill.left.learning.repays`", "did you mean `replays`"),
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
        ("robot.memory.range_decy=0", "unknown key `robot.memory.range_decy`", "did you mean `range_decay`"),
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
        ("transfer.movd.world=worlds/flat.toml", "there is no transfer `movd`", "did you mean `moved`"),
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
    ];
    each_is_refused(&cases, |set| family(&strict(), &[set]).0.err().unwrap_or_else(|| panic!("accepted {set}")));
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
        (&[("trials = 66", "oracle = true")], learned, "`right` is an oracle", "a number"),
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
