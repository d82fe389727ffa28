//! The program as its user meets it: every mistake has one clear message, the right exit code, and no consequence.

mod support;

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::OnceLock;
use support::{skilltree, tiny, tree};
use tempfile::TempDir;

const SHIPPED: &str = env!("CARGO_MANIFEST_DIR");

/// A folder with the shipped config and world to make mistakes in.
struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(TempDir::new().unwrap());
        desk.write("docking.toml", shipped("docking.toml"));
        desk.write("worlds/office.toml", shipped("worlds/office.toml"));
        desk
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// A copy of a complete run.
    fn run(&self, name: &str) -> PathBuf {
        for (file, bytes) in finished() {
            if file.ends_with('/') {
                fs::create_dir_all(self.path().join(name).join(file)).unwrap();
            } else {
                self.write(&format!("{name}/{file}"), bytes);
            }
        }
        self.path().join(name)
    }

    fn give(&self, line: &[&str]) -> Output {
        skilltree(self.path()).args(line).stdin(Stdio::null()).output().unwrap()
    }

    /// The command fails with this code, says each of these in one message, and changes nothing.
    fn refuses(&self, line: &[&str], code: i32, says: &[&str]) {
        let before = tree(self.path());
        let output = self.give(line);
        let after = tree(self.path());
        let what = format!("skilltree {}\n{}", line.join(" "), String::from_utf8_lossy(&output.stderr));
        let message = String::from_utf8(output.stderr).expect(&what);
        assert_eq!(output.status.code(), Some(code), "{what}");
        assert!(!message.contains("panicked") && !message.contains("bug in skilltree"), "{what}");
        assert_eq!(message.lines().filter(|line| line.starts_with("error: ")).count(), 1, "{what}");
        assert!(
            ["\nhint: ", "\nnote: ", "Usage:", "For more information"].iter().any(|hint| message.contains(hint)),
            "{what}"
        );
        for words in says {
            assert!(message.contains(words), "`{words}` is not in the answer to {what}");
        }
        assert!(output.stdout.is_empty(), "{what}{}", String::from_utf8_lossy(&output.stdout));
        let names = |tree: &BTreeMap<String, Vec<u8>>| tree.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&before), names(&after), "{what}");
        assert!(before == after, "a file changed: {what}");
    }
}

fn shipped(name: &str) -> String {
    fs::read_to_string(Path::new(SHIPPED).join("configs").join(name)).unwrap()
}

/// A shipped file with one change.
fn edited(name: &str, from: &str, to: &str) -> String {
    let text = shipped(name);
    assert_eq!(text.matches(from).count(), 1, "`{from}` in {name}");
    text.replace(from, to)
}

/// The files of a complete run with one arm and two seeds.
fn finished() -> &'static BTreeMap<String, Vec<u8>> {
    static RUN: OnceLock<BTreeMap<String, Vec<u8>>> = OnceLock::new();
    RUN.get_or_init(|| {
        let dir = TempDir::new().unwrap();
        let out = dir.path().join("run");
        let output = tiny(&out, &["--seeds", "0..2", "--set", "arms=['taught-adam']"]).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stderr).contains("2 of 2 learners"));
        let summary = String::from_utf8_lossy(&output.stdout);
        for name in ["taught-adam", "planner", "trials.parquet", "evaluations.parquet", "skills", "report.html"] {
            assert!(summary.contains(name), "{name} is not in {summary}");
        }
        tree(&out)
    })
}

#[test]
fn config_mistakes_name_their_line() {
    let desk = Desk::new();
    fs::create_dir(desk.path().join("folder")).unwrap();
    desk.refuses(&["run", "nowhere.toml"], 2, &["nowhere.toml", "no such file"]);
    desk.refuses(&["run", "folder"], 2, &["folder", "name a file"]);
    desk.refuses(&["run", "docking.toml/x"], 2, &["docking.toml/x"]);
    desk.refuses(&["run", "worlds/office.toml"], 2, &["worlds/office.toml", "`world` is missing"]);
    let deep = format!("world = {}", "[".repeat(100_000));
    let cases: [(&str, Vec<u8>, &[&str]); 24] = [
        ("empty", vec![], &["`world` is missing"]),
        ("binary", vec![0xff, 0xfe, 0], &["not text"]),
        ("deep", deep.into(), &["deep.toml:1:"]),
        ("syntax", edited("docking.toml", "seed  = 1993", "seed  = = 1993").into(), &["syntax.toml:", "not valid TOML", "^"]),
        ("cut", shipped("docking.toml").split_inclusive("at       = [0").next().unwrap().into(), &["cut.toml:", "^"]),
        ("twice", edited("docking.toml", "seed  = 1993", "seed  = 1993\nseed = 2").into(), &["twice.toml:", "not valid TOML"]),
        ("key", edited("docking.toml", "momentum                  = 0.0\ninit_range                = 0.2\ngamma                     = 0.95\nlambda                    = 0.8\ninverse_temperature_start = 10.0\ninverse_temperature_end   = 80.0\npolicy_threshold          = 0.001\nreplays                   = 30\nreplay_capacity           = 100\npretrain_epochs           = 5\ntaught_replays            = 2\ntimeout_terminal          = false\nmask_blocked              = false\n\n# TD(0)", "momentun = 0.0\n\n# TD(0)").into(), &["key.toml:", "momentun", "did you mean `momentum`?"]),
        ("type", edited("docking.toml", "gamma                      = 0.9\nlambda", "gamma = 'high'\nlambda").into(), &["type.toml:", "gamma", "'high'"]),
        ("nan", edited("docking.toml", "gamma                      = 0.9\nlambda", "gamma = nan\nlambda").into(), &["nan.toml:", "finite"]),
        ("infinite", edited("docking.toml", "learning_rate              = 0.0015", "learning_rate = inf").into(), &["infinite.toml:", "finite"]),
        ("huge", edited("docking.toml", "seed  = 1993", "seed  = 99999999999999999999").into(), &["huge.toml:", "too large"]),
        ("range", edited("docking.toml", "gamma                      = 0.9\nlambda", "gamma = 1.1\nlambda").into(), &["range.toml:", "between 0 and 1"]),
        ("under", edited("docking.toml", "trials      = 300                   # paper", "trials = -1").into(), &["under.toml:", "trials"]),
        ("negative", edited("docking.toml", "sonar    = 0.10", "sonar = -0.10").into(), &["negative.toml:", "sonar"]),
        ("date", edited("docking.toml", "seed  = 1993", "seed  = 1993-01-01").into(), &["date.toml:", "date"]),
        ("unknown-section", shipped("docking.toml").replace("[evaluate]", "[evaluat]").into(), &["unknown-section.toml:", "did you mean `evaluate`?"]),
        ("action", edited("docking.toml", "\"move+12\", ", "\"fly\", ").into(), &["action.toml:", "`fly`"]),
        ("event", edited("docking.toml", "docked = 100", "doked = 100").into(), &["event.toml:", "did you mean `docked`?"]),
        ("region", edited("docking.toml", "eval_starts = \"light-area\"", "eval_starts = \"attic\"").into(), &["region.toml:", "`attic`"]),
        ("shares", edited("docking.toml", "light-area = 0.8", "light-area = 0.9").into(), &["shares.toml:", "sum to 1"]),
        ("input", edited("docking.toml", "\"sonar(60)\"", "\"sonar(0)\"").into(), &["input.toml:", "sonar"]),
        ("order", edited("docking.toml", "[0, 25, 50,", "[0, 50, 25,").into(), &["order.toml:", "ascending"]),
        ("noworld", edited("docking.toml", "worlds/office.toml", "worlds/offce.toml").into(), &["noworld.toml:", "no such file", "worlds/offce.toml"]),
        ("isfolder", edited("docking.toml", "\"worlds/office.toml\"", "\"worlds\"").into(), &["isfolder.toml:", "it is a folder"]),
    ];
    for (name, text, says) in cases {
        let file = format!("{name}.toml");
        desk.write(&file, text);
        let said: Vec<&str> = says.iter().copied().chain([file.as_str()]).collect();
        for line in [&["run", &file, "--out", "new"][..], &["probe", &file, "--at", "60,60,0"]] {
            desk.refuses(line, 2, &said);
        }
    }
}

#[test]
fn world_mistakes_name_their_line() {
    let desk = Desk::new();
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
    desk.write("bad.toml", edited("docking.toml", "worlds/office.toml", "worlds/bad.toml"));
    for (from, to, words, says) in cases {
        desk.write("worlds/bad.toml", edited("worlds/office.toml", from, to));
        let said: Vec<&str> = says.iter().copied().chain([words]).collect();
        desk.refuses(&["run", "bad.toml", "--out", "new"], 2, &said);
        desk.refuses(&["probe", "bad.toml", "--at", "60,60,0"], 2, &said);
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
        desk.write("worlds/bad.toml", text);
        desk.refuses(&["run", "bad.toml", "--out", "new"], 2, says);
        desk.refuses(&["run", "bad.toml", "--out", "new"], 2, &["worlds/bad.toml"]);
    }
}

#[test]
fn usage_mistakes_are_refused_before_anything_is_done() {
    let desk = Desk::new();
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
        (&["--set", "learning.ratee=1"], &["did you mean `rate`?"]),
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
        desk.refuses(&[&run[..], more].concat(), 2, says);
    }
    desk.refuses(&["run"], 2, &["<CONFIG>"]);
    desk.refuses(&["report"], 2, &["<DIR>"]);
    desk.refuses(&["probe", "docking.toml"], 2, &["--at"]);
    desk.refuses(&["dance"], 2, &["dance"]);
    // A backend is asked for in vain before the folder is made.
    let before = tree(desk.path());
    let output = desk.give(&[&run[..], &["--backend", "cpu", "--threads", "99999"]].concat());
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && message.contains("99999") && message.contains("0..=1024"), "{message}");
    assert!(before == tree(desk.path()), "{message}");
}

#[test]
fn poses_and_actions_that_cannot_be_are_refused() {
    let desk = Desk::new();
    for (at, says) in [
        ("150,120,0", "does not fit"),
        ("170,140,0", "does not fit"),
        ("11,300,0", "does not fit"),
        ("-60,60,0", "does not fit"),
        ("1e30,60,0", "does not fit"),
        ("NaN,60,0", "finite"),
        ("60,inf,0", "finite"),
        ("60,60,NaN", "finite"),
        ("60,60,1e39", "finite"),
        ("60,60", "three"),
        ("60,60,0,0", "three"),
        ("60,60,north", "three"),
        ("60;60;0", "three"),
        ("L9", "L1, L2, L3"),
        ("", "--at"),
        (",,", "three"),
    ] {
        desk.refuses(&["probe", "docking.toml", "--at", at], 2, &["--at", says]);
    }
    let probe = ["probe", "docking.toml", "--at", "60,60,0"];
    for (more, says) in [
        (&["--actions", "move+12,fly"][..], &["`fly`", "move+12"][..]),
        (&["--actions", "move+13"], &["`move+13`"]),
        (&["--noise", "loud"], &["loud", "on, off"]),
        (&["--seed", "-1"], &["-1"]),
        (&["--set", "robot.noise.sonar=2"], &["robot.noise.sonar=2"]),
    ] {
        desk.refuses(&[&probe[..], more].concat(), 2, says);
    }
}

#[test]
fn places_that_cannot_be_written_are_refused() {
    let desk = Desk::new();
    desk.write("thesis/chapter1.tex", "years of work");
    desk.write("file", "a file");
    let cases: [(&str, &str); 5] = [
        ("thesis", "chapter1.tex"),
        ("file", "file"),
        ("file/below", "file/below"),
        ("/proc/skilltree", "/proc/skilltree"),
        ("/dev/null", "/dev/null"),
    ];
    for (out, says) in cases {
        let tiny = ["--backend", "cpu", "--set", "teacher.lessons=10", "--set", "teacher.eval_episodes=1"];
        desk.refuses(&[&["run", "docking.toml", "--out", out], &tiny[..]].concat(), 1, &[says, "--out"][..1]);
    }
}

#[test]
fn another_experiments_folder_is_left_alone() {
    let desk = Desk::new();
    let run = desk.run("run");
    let line = ["run", "docking.toml", "--out", "run"];
    desk.refuses(&line, 1, &["another config.toml", "--out"]);
    let config = run.join("config.toml");
    let saved = fs::read(&config).unwrap();
    for (name, content, says) in [
        (".skilltree", "skilltree run folder, format 99\n", "format 99"),
        (".skilltree", "my own notes", ".skilltree"),
        ("manifest.json", "{", "config.toml"),
    ] {
        let before = fs::read(run.join(name)).unwrap();
        fs::write(run.join(name), content).unwrap();
        desk.refuses(&line, 1, &[says]);
        fs::write(run.join(name), before).unwrap();
    }
    fs::remove_file(&config).unwrap();
    desk.refuses(&line, 1, &["config.toml", "missing"]);
    fs::create_dir(&config).unwrap();
    desk.refuses(&line, 1, &["config.toml", "cannot read"]);
    fs::remove_dir(&config).unwrap();
    fs::write(&config, saved).unwrap();
    // Somebody is at work there.
    let lock = skilltree::run_folder::folder::lock(&skilltree::run_folder::file_system::FileSystem, &run).unwrap();
    desk.refuses(&line, 1, &["another skilltree process"]);
    desk.refuses(&["report", "run"], 1, &["another skilltree process"]);
    drop(lock);
}

/// The line that made [`finished`], for a folder on the desk.
fn again(out: &Path) -> Command {
    tiny(out, &["--seeds", "0..2", "--set", "arms=['taught-adam']"])
}

#[test]
fn a_damaged_part_stops_the_run_and_says_which() {
    let desk = Desk::new();
    let out = desk.path().join("run");
    let plan = plan();
    let worlds = [("world.toml", plan.worlds[0].text.as_str())];
    let mut folder = skilltree::run_folder::RunFolder::open(&out, &plan.resolved, &worlds).unwrap();
    folder.commit_part("arm0-seed0_arm0-seed0", b"not the words of a learner").unwrap();
    drop(folder);
    let part = out.join("parts/arm0-seed0_arm0-seed0");
    let whole = fs::read(&part).unwrap();
    let mut flipped = whole.clone();
    flipped[60] ^= 1;
    for bytes in [&whole, &whole[..20], &[][..], &flipped] {
        fs::write(&part, bytes).unwrap();
        let before = tree(&out);
        let output = again(&out).output().unwrap();
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.contains("arm0-seed0_arm0-seed0") && message.contains("hint: remove this file"), "{message}");
        assert!(!message.contains("panicked"), "{message}");
        assert!(before == tree(&out), "{message}");
    }
    desk.refuses(&["report", "run"], 1, &["not complete", "goes on with it"]);
    // The hint helps.
    fs::remove_file(part).unwrap();
    assert!(again(&out).output().unwrap().status.success());
    assert!(results(&tree(&out)) == results(finished()));
}

/// The plan of [`finished`].
fn plan() -> skilltree::config::plan::Plan {
    let desk = Desk::new();
    desk.write("worlds/../world.toml", &finished()["world.toml"]);
    desk.write("config.toml", &finished()["config.toml"]);
    let set = vec![];
    let plan = skilltree::config::load(
        &desk.path().join("config.toml"),
        &skilltree::config::Overrides { set, ..Default::default() },
    );
    let mut plan = plan.unwrap();
    plan.resolved = String::from_utf8(finished()["config.toml"].clone()).unwrap();
    plan
}

/// All that two runs of the same experiment have in common, in whatever way they were carried out.
fn results(tree: &BTreeMap<String, Vec<u8>>) -> BTreeMap<&String, &Vec<u8>> {
    tree.iter().filter(|(name, _)| *name != "manifest.json" && *name != "report.html").collect()
}

#[test]
fn every_world_that_a_config_names_is_kept_with_the_run() {
    let desk = Desk::new();
    let out = desk.path().join("run");
    let more = ["--seeds", "0..1", "--set", "arms=['taught-adam']"];
    let other = ["--set", "arm.taught-sgd.world=worlds/office-easy.toml"];
    let output = tiny(&out, &[&more[..], &other].concat()).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.contains("world:    small, office-easy\n"), "{message}");
    let kept = tree(&out);
    assert!(kept["worlds/office-easy.toml"] == shipped("worlds/office-easy.toml").into_bytes());
    let manifest: Value = serde_json::from_slice(&kept["manifest.json"]).unwrap();
    assert!(manifest["files"]["worlds/office-easy.toml"].is_object());
    // The run folder is all that it takes to do the same again.
    let output = desk.give(&["run", "run/config.toml", "--backend", "cpu", "--out", "again"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(results(&tree(&desk.path().join("again"))) == results(&kept));
    fs::remove_file(out.join("worlds/office-easy.toml")).unwrap();
    desk.refuses(&["report", "run"], 1, &["office-easy.toml", "missing"]);
}

#[test]
fn reports_of_damaged_runs_say_which_file() {
    let desk = Desk::new();
    let run = desk.run("run");
    desk.write("file", "a file");
    fs::create_dir(desk.path().join("empty")).unwrap();
    desk.refuses(&["report", "nowhere"], 1, &["nowhere", "no such folder"]);
    desk.refuses(&["report", "file"], 1, &["file", "it is a file"]);
    desk.refuses(&["report", "empty"], 1, &["empty"]);
    desk.refuses(&["report", "worlds"], 1, &["office.toml"]);
    for name in [
        "manifest.json",
        "trials.parquet",
        "evaluations.parquet",
        "skills/taught-adam-1.safetensors",
        "places.json",
        "world.toml",
    ] {
        let path = run.join(name);
        let whole = fs::read(&path).unwrap();
        let mut flipped = whole.clone();
        let middle = whole.len() / 2;
        flipped[middle] = flipped[middle].wrapping_add(1) | 0x80;
        for bytes in [&whole[..middle], &[][..], &flipped] {
            fs::write(&path, bytes).unwrap();
            desk.refuses(&["report", "run"], 1, &[name, "damaged"]);
        }
        fs::remove_file(&path).unwrap();
        desk.refuses(&["report", "run"], 1, &[if name == "manifest.json" { "not complete" } else { name }]);
        fs::create_dir(&path).unwrap();
        desk.refuses(&["report", "run"], 1, &[name]);
        fs::remove_dir(&path).unwrap();
        fs::write(&path, whole).unwrap();
    }
    let figures = run.join("figures");
    fs::rename(&figures, desk.path().join("away")).unwrap();
    fs::write(&figures, "in the way").unwrap();
    desk.refuses(&["report", "run"], 1, &["figures"]);
    fs::remove_file(&figures).unwrap();
    fs::rename(desk.path().join("away"), &figures).unwrap();
    assert!(desk.give(&["report", "run"]).status.success());
    assert!(tree(&run) == *finished());
}

/// A file that the manifest vouches for may still make no sense: another program may have written both.
#[test]
fn reports_of_vouched_nonsense_do_not_panic() {
    let desk = Desk::new();
    let run = desk.run("run");
    let manifest = String::from_utf8(finished()["manifest.json"].clone()).unwrap();
    for (name, says) in [("evaluations.parquet", 1), ("places.json", 1), ("world.toml", 1)] {
        let whole = &finished()[name];
        for bytes in [whole[..whole.len() / 2].to_vec(), vec![], b"PAR1 nonsense PAR1".to_vec(), vec![0xff; 5000]] {
            let mut value: Value = serde_json::from_str(&manifest).unwrap();
            let digest = skilltree::run_folder::manifest::FileDigest::of(&bytes);
            value["files"][name] = serde_json::to_value(&digest).unwrap();
            fs::write(run.join("manifest.json"), value.to_string()).unwrap();
            fs::write(run.join(name), bytes).unwrap();
            desk.refuses(&["report", "run"], says, &[name]);
        }
        fs::write(run.join(name), whole).unwrap();
    }
}

#[test]
fn a_closed_or_full_output_is_no_panic() {
    let desk = Desk::new();
    let run = desk.run("run");
    let lines: [Vec<&str>; 5] = [
        vec!["probe", "docking.toml", "--at", "L2", "--json", "--actions", "turn+15,turn+15"],
        vec!["probe", "docking.toml", "--at", "L2"],
        vec!["report", run.to_str().unwrap()],
        vec!["devices"],
        vec!["devices", "--json"],
    ];
    // Without a driver: what adapters there are is none of this test's business.
    let skilltree = |dir: &Path| {
        let mut command = skilltree(dir);
        command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
        command
    };
    for line in &lines {
        let full = fs::File::options().write(true).open("/dev/full");
        if let Ok(full) = full {
            let output = skilltree(desk.path()).args(line).stdout(full).stderr(Stdio::piped()).output().unwrap();
            let message = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{message}");
            assert!(message.contains("standard output") && message.contains("hint: "), "{message}");
        }
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = skilltree(desk.path()).args(line).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    // With both closed, a run goes on to its end.
    let out = desk.path().join("again");
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let status = again(&out).stdout(writer.try_clone().unwrap()).stderr(writer).status().unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(results(&tree(&out)) == results(finished()));
    // A message that nobody reads still has its exit code.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    assert_eq!(skilltree(desk.path()).args(["run", "nowhere.toml"]).stderr(writer).status().unwrap().code(), Some(2));
}

#[test]
fn help_teaches() {
    let desk = Desk::new();
    for (line, says) in [
        (&["--help"][..], &["run", "report", "probe", "Start with:", "configs/quick.toml"][..]),
        (&["run", "--help"], &["Examples:", "--seeds 0..256", "--set", "--backend", "--threads", "--out", "continues"]),
        (&["report", "--help"], &["Example:", "runs/quick", "report.html"]),
        (&["devices", "--help"], &["Examples:", "--parity", "--learners", "--json", "exit code 1"]),
        (&["probe", "--help"], &["Examples:", "--at L2", "--at 60,60,225", "--json", "bumpers", "counter-clockwise"]),
    ] {
        let output = desk.give(line);
        let text = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line:?}");
        assert!(output.stderr.is_empty());
        for words in says.iter().chain(&["Exit codes: 0 done; 2 wrong usage or config; 75"]) {
            assert!(text.contains(words), "`{words}` is not in {line:?}:\n{text}");
        }
    }
    // The examples of `probe` work as they stand.
    let help = String::from_utf8(desk.give(&["probe", "--help"]).stdout).unwrap();
    let examples: Vec<&str> = help.lines().filter_map(|line| line.strip_prefix("  skilltree ")).collect();
    assert_eq!(examples.len(), 2, "{help}");
    for example in examples {
        let output = skilltree(Path::new(SHIPPED)).args(example.split_whitespace()).output().unwrap();
        assert!(output.status.success(), "{example}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let version = desk.give(&["--version"]);
    assert_eq!(String::from_utf8_lossy(&version.stdout), format!("skilltree {}\n", env!("CARGO_PKG_VERSION")));
    // Without a command, the help goes where mistakes go.
    let bare = desk.give(&[]);
    assert_eq!(bare.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&bare.stderr).contains("Usage:") && bare.stdout.is_empty());
}

/// A bare room of 360 by 420 inches with the charger in a corner and a light that reaches 200 inches.
fn bare_room() -> Desk {
    let desk = Desk::new();
    let world = "size = [360, 420]\n[[rooms]]\nname = \"hall\"\nbox = [0, 0, 360, 420]\n\
        [charger]\nbox = [0, 0, 24, 24]\ntolerance = 30\n[light]\nat = [12, 12]\nrange = 200\n\
        [places]\nmiddle = [180.5, 210.25, -90]\n";
    desk.write("worlds/bare.toml", world);
    desk.write("bare.toml", edited("docking.toml", "worlds/office.toml", "worlds/bare.toml"));
    desk
}

fn readings(desk: &Desk, line: &[&str]) -> Vec<Value> {
    let output = desk.give(&[&["probe", "bare.toml", "--json"], line].concat());
    assert!(output.status.success(), "{line:?} {}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(reading: &Value, key: &str) -> f64 {
    reading[key].as_f64().unwrap_or_else(|| panic!("{key} of {reading}"))
}

fn list(reading: &Value, key: &str) -> Vec<u64> {
    reading[key].as_array().unwrap().iter().map(|value| value.as_u64().unwrap()).collect()
}

#[test]
fn probe_prints_one_object_per_pose() {
    let desk = bare_room();
    let all = readings(&desk, &["--at", "200,200,350", "--actions", "turn+15, turn-60,move+12,,move-12"]);
    assert_eq!(all.len(), 5);
    let keys = ["x", "y", "heading", "room", "sonar", "light", "bumpers", "compass", "blocked", "docked"];
    for reading in &all {
        let found: Vec<&String> = reading.as_object().unwrap().keys().collect();
        assert_eq!(found.len(), keys.len());
        assert!(keys.iter().all(|key| reading.get(key).is_some()), "{reading}");
        for key in ["x", "y", "heading", "compass"] {
            assert!(number(reading, key).is_finite());
        }
        for key in ["heading", "compass"] {
            assert!((0.0..360.0).contains(&number(reading, key)), "{reading}");
        }
        assert_eq!(reading["room"], "hall");
        assert!(list(reading, "sonar").len() == 24 && list(reading, "sonar").iter().all(|inches| *inches <= 127));
        assert!(list(reading, "light").len() == 24 && list(reading, "light").iter().all(|bit| *bit <= 1));
        assert!(list(reading, "bumpers").len() == 4 && list(reading, "bumpers").iter().all(|bit| *bit <= 1));
        assert!(reading["blocked"].is_boolean() && reading["docked"].is_boolean());
    }
    // The same seed gives the same noise, another one gives another.
    let noisy = |seed: &str| readings(&desk, &["--at", "200,200,350", "--actions", "move+12", "--seed", seed]);
    assert_eq!(noisy("7"), noisy("7"));
    assert_ne!(noisy("7"), noisy("8"));
    assert_ne!(
        noisy("7")[1]["x"],
        readings(&desk, &["--at", "200,200,350", "--actions", "move+12", "--noise", "off"])[1]["x"]
    );
}

#[test]
fn probe_senses_what_geometry_says() {
    let desk = bare_room();
    for (x, y, heading) in [(300.0, 350.0, 0.0), (40.0, 380.0, 97.0), (330.0, 30.0, 359.5), (250.0, 250.0, -33.0)] {
        let at = format!("{x},{y},{heading}");
        let reading = &readings(&desk, &["--noise", "off", "--at", &at])[0];
        assert!((number(reading, "heading") - f64::rem_euclid(heading, 360.0)).abs() < 1e-4);
        assert_eq!(number(reading, "compass"), number(reading, "heading"));
        for (ray, inches) in list(reading, "sonar").into_iter().enumerate() {
            let (sine, cosine) = f64::to_radians(heading + 15.0 * ray as f64).sin_cos();
            let wall = |at: f64, size: f64, along: f64| match along {
                _ if along.abs() < 1e-9 => f64::INFINITY,
                _ if along > 0.0 => (size - at) / along,
                _ => -at / along,
            };
            // The charger is beyond the sonar's reach from all of these.
            let exact = wall(x, 360.0, cosine).min(wall(y, 420.0, sine)).min(127.0);
            assert!((inches as f64 - exact).abs() <= 0.501, "ray {ray} at {at}: {inches}, not {exact}");
        }
        // The light is lit on bearings where (range / d)^2 exp(k (cos - 1)) exceeds 1, k = 1 / (15 degrees)^2.
        let (dx, dy) = (12.0 - x, 12.0 - y);
        for (ray, bit) in list(reading, "light").into_iter().enumerate() {
            let off = f64::to_radians(heading + 15.0 * ray as f64) - f64::atan2(dy, dx);
            let bright = 200.0 * 200.0 / (dx * dx + dy * dy) * ((off.cos() - 1.0) / 15f64.to_radians().powi(2)).exp();
            assert!((bright - 1.0).abs() > 0.01, "the test's pose {at} is at the threshold");
            assert_eq!(bit == 1, bright > 1.0, "ray {ray} at {at}: {bright}");
        }
    }
    // A near light is seen on several bearings, symmetrically.
    let near = &readings(&desk, &["--noise", "off", "--at", "82,82,225"])[0];
    let light = list(near, "light");
    assert_eq!(light.iter().sum::<u64>() % 2, 1);
    assert!(light[0] == 1 && (1..12).all(|ray| light[ray] == light[24 - ray]), "{light:?}");
}

#[test]
fn probe_moves_as_told() {
    let desk = bare_room();
    let walk = |at: &str, actions: &str| readings(&desk, &["--noise", "off", "--at", at, "--actions", actions]);
    let close = |reading: &Value, x: f64, y: f64, heading: f64| {
        let off = [number(reading, "x") - x, number(reading, "y") - y, number(reading, "heading") - heading];
        assert!(off.iter().all(|off| off.abs() < 1e-3), "{reading}, not {x} {y} {heading}");
    };
    let turns = walk("200,200,10", "turn+15,turn-60,turn-15,turn+60");
    for (reading, heading) in turns.iter().zip([10.0, 25.0, 325.0, 310.0, 10.0]) {
        close(reading, 200.0, 200.0, heading);
        assert_eq!(reading["blocked"], false);
    }
    let moves = walk("200,200,30", "move+12,move-12,move-12");
    let (dx, dy) = (12.0 * 30f64.to_radians().cos(), 6.0);
    for (reading, steps) in moves.iter().zip([0.0, 1.0, 0.0, -1.0]) {
        close(reading, 200.0 + steps * dx, 200.0 + steps * dy, 30.0);
    }
    // Against the east wall: contact where the disc of 12 inches touches, the front bumper, no docking.
    let wall = walk("330,200,0", "move+12,move+12,turn+60,move+12");
    close(&wall[1], 342.0, 200.0, 0.0);
    close(&wall[2], 348.0, 200.0, 0.0);
    assert_eq!(
        (&wall[1]["blocked"], &wall[2]["blocked"], &wall[2]["docked"]),
        (&false.into(), &true.into(), &false.into())
    );
    assert_eq!((list(&wall[1], "bumpers"), list(&wall[2], "bumpers")), (vec![0; 4], vec![1, 0, 0, 0]));
    close(&wall[3], 348.0, 200.0, 60.0);
    assert_eq!(wall[4]["blocked"], true);
    // Into the charger: contact with its east face at x = 24 + 12, and docked.
    let dock = walk("50,12,180", "move+12,move+12");
    close(&dock[1], 38.0, 12.0, 180.0);
    close(&dock[2], 36.0, 12.0, 180.0);
    assert_eq!((&dock[2]["docked"], &dock[2]["blocked"]), (&true.into(), &true.into()));
    // Backwards is no way to dock. The wall touches the right side.
    let back = walk("50,12,0", "move-12,move-12");
    assert_eq!(
        (&back[2]["docked"], &back[2]["blocked"], list(&back[2], "bumpers")),
        (&false.into(), &true.into(), vec![0, 0, 1, 1])
    );
}

#[test]
fn probe_knows_places_and_prints_text() {
    let desk = bare_room();
    let reading = &readings(&desk, &["--noise", "off", "--at", "middle"])[0];
    assert_eq!((number(reading, "x"), number(reading, "y"), number(reading, "heading")), (180.5, 210.25, 270.0));
    let output =
        desk.give(&["probe", "bare.toml", "--noise", "off", "--at", "50,12,180", "--actions", "move+12,move+12"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 15, "{text}");
    assert!(
        lines[0].starts_with("start ") && lines[0].contains("x 50.00  y 12.00  heading 180.0  room hall"),
        "{text}"
    );
    assert!(lines[5].starts_with("move+12 ") && !lines[5].contains("DOCKED"), "{text}");
    assert!(lines[10].contains("x 36.00") && lines[10].ends_with("DOCKED"), "{text}");
    for (line, word) in lines[1..5].iter().zip(["sonar", "light", "bumpers", "compass"]) {
        assert!(line.trim_start().starts_with(word), "{text}");
    }
    assert_eq!(lines[1].split_whitespace().count(), 25);
}
