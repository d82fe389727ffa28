//! Wrong configs, worlds and command lines.

use super::fixture::{Sandbox, edited, shipped};
use super::support::tree;
use std::fs;

#[test]
fn config_mistakes_name_their_line() {
    let sandbox = Sandbox::new();
    fs::create_dir(sandbox.path().join("folder")).unwrap();
    sandbox.refuses(&["run", "nowhere.toml"], 2, &["nowhere.toml", "no such file"]);
    sandbox.refuses(&["run", "folder"], 2, &["folder", "name a file"]);
    sandbox.refuses(&["run", "docking.toml/x"], 2, &["docking.toml/x"]);
    sandbox.refuses(&["run", "worlds/office.toml"], 2, &["worlds/office.toml", "`world` is missing"]);
    let deep = format!("world = {}", "[".repeat(100_000));
    let cases: [(&str, Vec<u8>, &[&str]); 24] = [
        ("empty", vec![], &["`world` is missing"]),
        ("binary", vec![0xff, 0xfe, 0], &["not text"]),
        ("deep", deep.into(), &["deep.toml:1:"]),
        (
            "syntax",
            edited("docking.toml", "seed  = 1993", "seed  = = 1993").into(),
            &["syntax.toml:", "not valid TOML", "^"],
        ),
        ("cut", shipped("docking.toml").split_inclusive("at       = [0").next().unwrap().into(), &["cut.toml:", "^"]),
        (
            "twice",
            edited("docking.toml", "seed  = 1993", "seed  = 1993\nseed = 2").into(),
            &["twice.toml:", "not valid TOML"],
        ),
        (
            "key",
            edited("docking.toml", "mask_blocked              = false\n\n# TD(0)", "momentun = 0.0\n\n# TD(0)").into(),
            &["key.toml:", "momentun", "did you mean `momentum`?"],
        ),
        (
            "type",
            edited("docking.toml", "gamma                      = 0.9", "gamma        = 'high'").into(),
            &["type.toml:", "gamma", "'high'"],
        ),
        (
            "nan",
            edited("docking.toml", "gamma                      = 0.9", "gamma        = nan").into(),
            &["nan.toml:", "finite"],
        ),
        (
            "infinite",
            edited("docking.toml", "learning_rate              = 0.0015", "learning_rate = inf").into(),
            &["infinite.toml:", "finite"],
        ),
        (
            "huge",
            edited("docking.toml", "seed  = 1993", "seed  = 99999999999999999999").into(),
            &["huge.toml:", "too large"],
        ),
        (
            "range",
            edited("docking.toml", "gamma                      = 0.9", "gamma        = 1.1").into(),
            &["range.toml:", "between 0 and 1"],
        ),
        (
            "under",
            edited("docking.toml", "trials      = 300                   # paper", "trials    = -1").into(),
            &["under.toml:", "trials"],
        ),
        (
            "negative",
            edited("docking.toml", "sonar    = 0.10", "sonar    = -0.10").into(),
            &["negative.toml:", "sonar"],
        ),
        ("date", edited("docking.toml", "seed  = 1993", "seed  = 1993-01-01").into(), &["date.toml:", "date"]),
        (
            "unknown-section",
            shipped("docking.toml").replace("[evaluate]", "[evaluat]").into(),
            &["unknown-section.toml:", "did you mean `evaluate`?"],
        ),
        ("action", edited("docking.toml", "\"move+12\", ", "\"fly\", ").into(), &["action.toml:", "`fly`"]),
        (
            "event",
            edited("docking.toml", "docked = 100", "doked = 100").into(),
            &["event.toml:", "did you mean `docked`?"],
        ),
        (
            "region",
            edited("docking.toml", "eval_starts = \"light-area\"", "eval_starts = \"attic\"").into(),
            &["region.toml:", "`attic`"],
        ),
        (
            "shares",
            edited("docking.toml", "light-area = 0.8", "light-area = 0.9").into(),
            &["shares.toml:", "sum to 1"],
        ),
        ("input", edited("docking.toml", "\"sonar(60)\"", "\"sonar(0)\"").into(), &["input.toml:", "sonar"]),
        ("order", edited("docking.toml", "[0, 25, 50,", "[0, 50, 25,").into(), &["order.toml:", "ascending"]),
        (
            "noworld",
            edited("docking.toml", "worlds/office.toml", "worlds/offce.toml").into(),
            &["noworld.toml:", "no such file", "worlds/offce.toml"],
        ),
        (
            "isfolder",
            edited("docking.toml", "\"worlds/office.toml\"", "\"worlds\"").into(),
            &["isfolder.toml:", "it is a folder"],
        ),
    ];
    for (name, text, says) in cases {
        let file = format!("{name}.toml");
        sandbox.write(&file, text);
        let said: Vec<&str> = says.iter().copied().chain([file.as_str()]).collect();
        for line in [&["run", &file, "--out", "new"][..], &["probe", &file, "--at", "60,60,0"]] {
            sandbox.refuses(line, 2, &said);
        }
    }
}

#[test]
fn world_mistakes_name_their_line() {
    let sandbox = Sandbox::new();
    let cases: [(&str, &str, &str, &[&str]); 18] = [
        ("size = [360, 420]", "size = [360]", "size", &["worlds/bad.toml:8:"]),
        ("size = [360, 420]", "size = [360, nan]", "size", &["worlds/bad.toml:8:", "finite"]),
        ("size = [360, 420]", "size = [-360, 420]", "size", &["worlds/bad.toml:8:"]),
        ("size = [360, 420]", "size = [1e9, 420]", "size", &["worlds/bad.toml:8:"]),
        ("boxes = [\n", "boxes = [\n[0, 0, 360, 420],\n", "solid", &["worlds/bad.toml:"]),
        ("[140, 110, 176, 170]", "[176, 110, 140, 170]", "box", &["worlds/bad.toml:"]),
        ("[140, 110, 176, 170]", "[140, 110, 176]", "numbers", &["worlds/bad.toml:"]),
        ("name = \"B\"", "name = \"A\"", "A", &["worlds/bad.toml:"]),
        ("rooms  = [\"B\", \"C\"]\ncentre", "rooms  = [\"B\", \"D\"]\ncentre", "`D`", &["worlds/bad.toml:"]),
        ("centre = [300, 204]\nwidth  = 50", "centre = [300, 204]\nwidth  = -50", "width", &["worlds/bad.toml:"]),
        ("centre = [300, 204]\nwidth  = 50", "centre = [300, 204]\nwidth  = 20", "too narrow", &["worlds/bad.toml:"]),
        ("tolerance = 30", "tolerance = -30", "tolerance", &["worlds/bad.toml:"]),
        ("range = 230", "range = -230", "range", &["worlds/bad.toml:"]),
        ("area  = 140", "area  = -1", "area", &["worlds/bad.toml:"]),
        ("at    = [12, 12]", "at    = [12, 500]", "500", &["worlds/bad.toml:"]),
        ("L2 = [80, 90, 225]", "L2 = [150, 120, 225]", "does not fit at the place `L2`", &["worlds/bad.toml:"]),
        ("L2 = [80, 90, 225]", "L2 = [8000, 90, 225]", "L2", &["worlds/bad.toml:"]),
        ("[charger]", "[chargre]", "did you mean `charger`?", &["worlds/bad.toml:"]),
    ];
    sandbox.write("bad.toml", edited("docking.toml", "worlds/office.toml", "worlds/bad.toml"));
    for (from, to, words, says) in cases {
        sandbox.write("worlds/bad.toml", edited("worlds/office.toml", from, to));
        let said: Vec<&str> = says.iter().copied().chain([words]).collect();
        sandbox.refuses(&["run", "bad.toml", "--out", "new"], 2, &said);
        sandbox.refuses(&["probe", "bad.toml", "--at", "60,60,0"], 2, &said);
    }
    let worlds: [(&str, &[&str]); 4] = [
        ("", &["`size` is missing"]),
        ("size = [360, 420]", &["no rooms"]),
        (
            "size = [60, 60]\nboxes = [[20, 20, 40, 40]]\n[[rooms]]\nname = \"A\"\nbox = [0, 0, 60, 60]",
            &["no free space"],
        ),
        ("size = [360, 420", &["not valid TOML"]),
    ];
    for (text, says) in worlds {
        sandbox.write("worlds/bad.toml", text);
        sandbox.refuses(&["run", "bad.toml", "--out", "new"], 2, says);
        sandbox.refuses(&["run", "bad.toml", "--out", "new"], 2, &["worlds/bad.toml"]);
    }
}

#[test]
fn usage_mistakes_are_refused_before_anything_is_done() {
    let sandbox = Sandbox::new();
    let run = ["run", "docking.toml", "--out", "new"];
    let cases: [(&[&str], &[&str]); 36] = [
        (&["--seeds", "x"], &["--seeds x", "`x` is not a seed"]),
        (&["--seeds", "3..1"], &["--seeds 3..1", "holds no seed"]),
        (&["--seeds", "2..2"], &["holds no seed"]),
        (&["--seeds", "1,1"], &["twice"]),
        (&["--seeds", "0..5,3"], &["twice"]),
        (&["--seeds", ","], &["is not a seed"]),
        (&["--seeds", ""], &["--seeds"]),
        (&["--seeds", "0..7..9"], &["is not a seed"]),
        (&["--seeds", "0...7"], &["is not a seed"]),
        (&["--seeds", "4294967296"], &["is not a seed"]),
        (&["--seeds", "0..4294967295"], &["too many seeds"]),
        (&["--seeds=-1"], &["is not a seed"]),
        (&["--set", "learning.learning_rate"], &["--set learning.learning_rate", "no `=`"]),
        (&["--set", "=1"], &["is not the name of a key"]),
        (&["--set", "learning..rate=1"], &["is not the name of a key"]),
        (&["--set", "learning.learning_rate="], &["is not a value"]),
        (&["--set", "learning.learning_rate=[1"], &["is not a value"]),
        (&["--set", "learning.learning_rate=nan"], &["--set learning.learning_rate=nan", "finite"]),
        (&["--set", "learning.learning_rate=-1"], &["--set learning.learning_rate=-1", "more than 0"]),
        (&["--set", "learning.learning_rate=fast"], &["--set learning.learning_rate=fast"]),
        (&["--set", "learning=3"], &["--set learning=3"]),
        (&["--set", "learning.learning_rate.x=3"], &["--set learning.learning_rate.x=3"]),
        (&["--set", "learning.learning_ratee=1"], &["did you mean `learning_rate`?"]),
        (&["--set", "skill.dokc.trials=1"], &["did you mean `dock`?"]),
        (&["--set", "arm.taught-adm.learning.learning_rate=1"], &["did you mean `taught-adam`?"]),
        (&["--set", "arms=['nobody']"], &["nobody"]),
        (&["--set", "arms=[]"], &["arms"]),
        (&["--iterations", "0"], &["--iterations"]),
        (&["--cohort", "0"], &["--cohort"]),
        (&["--cohort", "4294967296"], &["--cohort"]),
        (&["--threads", "-1"], &["-1"]),
        (&["--threads", "many"], &["--threads"]),
        (&["--backend", "tpu"], &["--backend", "cpu"]),
        (&["--out", ""], &["--out"]),
        (&["--fast"], &["--fast"]),
        (&["more.toml"], &["more.toml"]),
    ];
    for (more, says) in cases {
        sandbox.refuses(&[&run[..], more].concat(), 2, says);
    }
    sandbox.refuses(&["run"], 2, &["<CONFIG>"]);
    sandbox.refuses(&["report"], 2, &["<DIR>"]);
    sandbox.refuses(&["probe", "docking.toml"], 2, &["--at"]);
    sandbox.refuses(&["dance"], 2, &["dance"]);
    // A backend is asked for in vain before the folder is made.
    let before = tree(sandbox.path());
    let output = sandbox.give(&[&run[..], &["--backend", "cpu", "--threads", "99999"]].concat());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && message.contains("99999") && message.contains("0..=1024"), "{message}");
    assert!(before == tree(sandbox.path()), "{message}");
}
