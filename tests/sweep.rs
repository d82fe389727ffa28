//! Runs of sweeps: every learner leaves what it would have left alone, and a dry run says what is to come.

mod support;

use bytemuck::Pod;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::{Backend, BackendError};
use skilltree::config::plan::{ArmPlan, Plan, SkillPlan, TeacherPlan, Threshold};
use skilltree::config::{Overrides, load};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{HyperParams, Noise};
use skilltree::run_folder::sweep::AxisValue;
use skilltree::run_folder::tables::{EVALUATIONS, TRIALS, read_evaluations, read_trials};
use skilltree::run_folder::{JsonFile, Sweep};
use skilltree::train::batch_group::groups;
use skilltree::train::pretraining::shared_skills;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;
use support::{skilltree, tiny, tree};
use tempfile::TempDir;

/// Two arms of one skill over two axes, one of which makes another teacher necessary.
const DOCKING: [&str; 6] = [
    "--set",
    "arms=['taught-adam', 'untaught-sgd']",
    "--set",
    "sweep.skill.dock.trials=[4, 7]",
    "--set",
    "sweep.robot.noise.sonar={from=0.0, to=0.2, steps=2, label='noise'}",
];
/// A tree of skills: an axis of the root, which shares what is below, and one of a skill below.
const TREE: [&str; 8] = [
    "--set",
    "arms=['persistent']",
    "--set",
    "sweep.skill.top.applicable.dock=[-0.1, 0.2]",
    "--set",
    "sweep.skill.pass.learning.learning_rate=[0.1, 0.2]",
    "--set",
    "teacher.eval_episodes=2",
];

/// A run of `tests/support/tree.toml` on the CPU.
fn trees(out: &Path, more: &[&str]) -> Command {
    let mut command = skilltree(Path::new(env!("CARGO_MANIFEST_DIR")));
    command.args(["run", "tests/support/tree.toml", "--backend", "cpu", "--out"]).arg(out).args(TREE).args(more);
    seeds(command, "0..2", more)
}

/// These seeds, if no others are wanted.
fn seeds(mut command: Command, seeds: &str, more: &[&str]) -> Command {
    if !more.contains(&"--seeds") {
        command.args(["--seeds", seeds]);
    }
    command
}

fn docking(out: &Path, more: &[&str]) -> Command {
    let mut command = tiny(out, &DOCKING);
    command.args(more);
    seeds(command, "3..5", more)
}

/// What a command says on standard error; it must succeed.
#[track_caller]
fn succeeds(mut command: Command) -> String {
    let output = command.output().expect("the program");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    said
}

/// Every file but those that say how and where the run was carried out.
fn results(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = tree(out);
    for name in ["manifest.json", "report.html", ".lock", ".skilltree"] {
        assert!(files.remove(name).is_some(), "no {name}");
    }
    files
}

/// A learner as the tables name it: arm, point, seed.
type Who = (String, u32, u32);

/// All rows of both tables, by learner, numbers to the last bit; those of planners have no learner and are left out.
fn rows(out: &Path) -> BTreeMap<Who, Vec<String>> {
    let mut found: BTreeMap<Who, Vec<String>> = BTreeMap::new();
    let (_, trials) = read_trials(&out.join(TRIALS)).expect("trials");
    for row in trials {
        let text = format!("{} {row:?}", row.reward.to_bits());
        found.entry((row.arm, row.point, row.seed)).or_default().push(text);
    }
    let (_, tests) = read_evaluations(&out.join(EVALUATIONS)).expect("tests");
    for row in tests.into_iter().filter(|row| !row.arm.starts_with("planner")) {
        let text = format!("{} {row:?}", row.reward.to_bits());
        found.entry((row.arm, row.point, row.seed)).or_default().push(text);
    }
    found
}

fn nets(out: &Path, (arm, point, seed): &Who) -> Vec<u8> {
    fs::read(out.join(format!("skills/{arm}-p{point}-{seed}.safetensors"))).expect("nets")
}

fn file_count(out: &Path) -> usize {
    fs::read_dir(out.join("skills")).expect("nets").count()
}

/// Runs a whole sweep, and each of some learners alone.
fn check_alone(run: fn(&Path, &[&str]) -> Command, learners: usize, alone: &[(&str, u32, u32)]) -> TempDir {
    let dir = TempDir::new().expect("a folder");
    let all = dir.path().join("all");
    succeeds(run(&all, &[]));
    let expected = rows(&all);
    assert_eq!((expected.len(), file_count(&all)), (learners, learners));
    for (number, (arm, point, seed)) in alone.iter().enumerate() {
        let out = dir.path().join(number.to_string());
        let (point_text, seed_text) = (point.to_string(), seed.to_string());
        succeeds(run(&out, &["--arm", arm, "--point", &point_text, "--seeds", &seed_text]));
        let who = ((*arm).to_owned(), *point, *seed);
        let found = rows(&out);
        assert_eq!(found.keys().collect::<Vec<_>>(), [&who]);
        assert_eq!(found[&who], expected[&who], "{who:?}");
        assert!(nets(&out, &who) == nets(&all, &who), "{who:?}");
        assert_eq!(file_count(&out), 1);
        assert_eq!(fs::read(out.join(Sweep::NAME)).ok(), fs::read(all.join(Sweep::NAME)).ok());
    }
    // No two learners are the same after all.
    let distinct: BTreeSet<Vec<u8>> = expected.keys().map(|who| nets(&all, who)).collect();
    assert_eq!(distinct.len(), learners);
    dir
}

#[test]
fn a_learner_alone_is_the_learner_in_the_sweep() {
    let dir = check_alone(docking, 2 * 4 * 2, &[("taught-adam", 2, 3), ("untaught-sgd", 1, 4)]);
    let all = dir.path().join("all");
    let text = fs::read(all.join(Sweep::NAME)).expect("the sweep");
    let sweep = Sweep::parse(&text, Path::new("sweep.json")).expect("a sweep");
    let number = |value| AxisValue::Number(value);
    let points = [[4.0, 0.0], [4.0, 0.2], [7.0, 0.0], [7.0, 0.2]].map(|point| point.map(number).to_vec());
    let axes: Vec<_> = sweep.axes.iter().map(|axis| (axis.key.as_str(), axis.label.as_str())).collect();
    assert_eq!(axes, [("skill.dock.trials", "skill.dock.trials"), ("robot.noise.sonar", "noise")]);
    assert_eq!(sweep.points, points);
    // The tables mean the same points: the number of trials shows it.
    let (names, trials) = read_trials(&all.join(TRIALS)).expect("trials");
    let place = |row: &skilltree::run_folder::TrialRow| (row.arm.clone(), row.point, row.seed);
    assert!(trials.is_sorted_by_key(place), "rows are sorted by arm, point and seed");
    assert_eq!(names.arms, ["taught-adam", "untaught-sgd"]);
    for point in 0..4 {
        let own = trials
            .iter()
            .filter(|row| row.point == point && !row.taught && (row.arm.as_str(), row.seed) == ("untaught-sgd", 3));
        assert_eq!(own.count(), [4, 4, 7, 7][point as usize], "point {point}");
    }
    // Two levels of noise are two tasks of the planner, each tested at the point where it first comes up.
    let (_, tests) = read_evaluations(&all.join(EVALUATIONS)).expect("tests");
    let bounds: BTreeSet<(&str, u32)> =
        tests.iter().map(|row| (row.arm.as_str(), row.point)).filter(|(arm, _)| arm.starts_with("planner")).collect();
    assert_eq!(bounds, BTreeSet::from([("planner", 0), ("planner", 1)]));
}

/// A plan with two points on an axis, and perhaps other changes.
fn swept(config: &str, axis: &str, more: &[&str]) -> Plan {
    let set = more.iter().chain([&axis]).map(|set| (*set).to_owned()).collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(config);
    load(&path, &Overrides { set, seeds: Some("0".to_owned()), ..Overrides::default() }).expect("a plan")
}

/// Numbers of single learners keep nobody apart; whatever the teacher, the world or the nets' shapes know does.
#[test]
fn arms_share_a_batch_and_skills_where_their_learners_see_the_same() {
    let cuts =
        ["world=../tests/support/small.toml", "arms=['taught-adam']", "teacher.lessons=16", "teacher.eval_episodes=1"];
    for (axis, expected) in [
        ("sweep.skill.dock.trials=[4, 7]", 1),
        ("sweep.skill.dock.max_steps=[9, 12]", 2),
        ("sweep.robot.noise.sonar=[0.0, 0.2]", 2),
    ] {
        let plan = swept("configs/docking.toml", axis, &cuts);
        let found = groups(&plan).unwrap_or_else(|error| panic!("{axis}: {error}"));
        assert_eq!((found.len(), found.iter().map(|group| group.arms.len()).sum::<usize>()), (expected, 2), "{axis}");
        // Without skills below the root, what trains together is what shares a batch.
        assert_eq!(shared_skills(&plan).len(), expected, "{axis}");
    }
    for (axis, shared) in
        [("sweep.skill.top.applicable.dock=[-0.1, 0.2]", 1), ("sweep.skill.pass.learning.learning_rate=[0.1, 0.2]", 2)]
    {
        let plan = swept("tests/support/tree.toml", axis, &["arms=['persistent']"]);
        let found = shared_skills(&plan);
        assert!(found.iter().all(|shared| shared.pretrained));
        assert_eq!((found.len(), groups(&plan).expect("groups").len()), (shared, 1), "{axis}");
    }
}

/// A record with one word changed: a whole number by 1, any other by an eighth or more.
fn flipped<T: Pod>(record: &T, word: usize) -> T {
    let mut words: Vec<u32> = bytemuck::cast_slice(std::slice::from_ref(record)).to_vec();
    words[word] ^= if words[word] < 1 << 20 { 1 } else { 1 << 20 };
    bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words))
}

fn words<T>() -> std::ops::Range<usize> {
    0..size_of::<T>() / 4
}

/// An arm's skills that are learned before its root are its own alone as soon as anything of them differs.
#[test]
fn every_word_keeps_arms_apart_whose_learners_see_it() {
    let mut plan =
        swept("tests/support/tree.toml", "sweep.skill.top.applicable.dock=[-0.1, 0.2]", &["arms=['persistent']"]);
    let arm = plan.arms[0].clone();
    let mut apart = |change: &dyn Fn(&mut ArmPlan)| {
        let mut other = arm.clone();
        change(&mut other);
        plan.arms = vec![arm.clone(), other];
        shared_skills(&plan).len() == 2
    };
    assert!(!apart(&|_| ()) && !apart(&|arm| (arm.name, arm.point) = ("other".to_owned(), 1)));
    let root = arm.skills.len() - 1;
    for skill in 0..=root {
        for word in words::<HyperParams>() {
            let change = |arm: &mut ArmPlan| arm.skills[skill].params = flipped(&arm.skills[skill].params, word);
            assert_eq!(apart(&change), skill < root, "word {word} of skill {skill}");
        }
    }
    for word in words::<Noise>() {
        assert!(apart(&|arm| arm.noise = flipped(&arm.noise, word)), "word {word} of the noise");
    }
    for word in words::<TeacherPlan>() {
        assert!(apart(&|arm| arm.teacher = flipped(&arm.teacher, word)), "word {word} of the teacher");
    }
    let changes: [fn(&mut SkillPlan); 12] = [
        |skill| skill.name.push('x'),
        |skill| skill.inputs.clear(),
        |skill| skill.children.clear(),
        |skill| skill.applicable[0] = Some(Threshold::Fixed(0.5)),
        |skill| skill.mirror = Some(0),
        |skill| skill.oracle = true,
        |skill| skill.starts[0].0.push('x'),
        |skill| skill.starts[0].1 *= 0.5,
        |skill| skill.eval_starts.push('x'),
        |skill| skill.eval_at.push(1),
        |skill| skill.goal ^= 1,
        |skill| skill.regions.push("x".to_owned()),
    ];
    for (number, change) in changes.iter().enumerate() {
        assert!(apart(&|arm| change(&mut arm.skills[0])), "change {number} below the root");
        assert!(!apart(&|arm| change(&mut arm.skills[root])), "change {number} of the root");
    }
    assert!(apart(&|arm| arm.world += 1) && apart(&|arm| drop(arm.skills.remove(0))));
}

/// Whatever arms of one batch may differ in, nothing of it reaches what they share: shapes, tables, taught lessons.
#[test]
fn what_a_batch_shares_knows_nothing_of_its_arms() {
    let cuts = [
        "world=../tests/support/small.toml",
        "arms=['taught-adam']",
        "learning.hidden=16",
        "teacher.lessons=16",
        "teacher.eval_episodes=1",
    ];
    let mut plan = swept("configs/docking.toml", "sweep.skill.dock.trials=[4, 7]", &cuts);
    let arm = plan.arms[0].clone();
    let with = |words: &[usize]| {
        let mut other = arm.clone();
        for word in words {
            other.skills[0].params = flipped(&other.skills[0].params, *word);
        }
        other
    };
    let mut sharing = |other: ArmPlan| {
        plan.arms = vec![arm.clone(), other];
        shared_skills(&plan).len() == 1
    };
    let (own, seen): (Vec<usize>, Vec<usize>) = words::<HyperParams>().partition(|word| sharing(with(&[*word])));
    println!("a batch's arms may differ in words {own:?}, and not in {seen:?}");
    assert!(own.len() > seen.len() && sharing(with(&own)));
    let mut left = |arm: ArmPlan| {
        plan.arms = vec![arm];
        let group = groups(&plan).expect("a group").remove(0);
        let CohortData { skills, tables, bank, .. } = group.shared;
        (bytemuck::cast_slice::<_, u32>(&skills).to_vec(), tables, bank)
    };
    let expected = left(arm.clone());
    assert!(expected.2.len() > 100 && left(with(&own)) == expected);
    // The comparison can fail.
    assert!(left(with(&[std::mem::offset_of!(HyperParams, noise.actuator) / 4])).2 != expected.2);
}

#[test]
fn branches_of_a_swept_tree_are_what_they_are_alone() {
    check_alone(trees, 4 * 2, &[("persistent", 1, 1), ("persistent", 2, 0)]);
}

#[test]
fn no_split_and_no_order_changes_a_byte() {
    let dir = TempDir::new().expect("a folder");
    for (name, run) in [("docking", docking as fn(&Path, &[&str]) -> Command), ("tree", trees)] {
        let whole = dir.path().join(name);
        succeeds(run(&whole, &[]));
        let expected = results(&whole);
        assert!(expected.contains_key(Sweep::NAME) && expected.keys().any(|name| name.starts_with("skills/")));
        for (number, way) in [
            &["--cohort", "1", "--threads", "1"][..],
            &["--cohort", "3", "--iterations", "37"],
            &["--cohort", "100", "--threads", "3"],
        ]
        .iter()
        .enumerate()
        {
            let out = dir.path().join(format!("{name}-{number}"));
            succeeds(run(&out, way));
            let found = results(&out);
            let differs: Vec<_> = expected.keys().filter(|name| found.get(*name) != expected.get(*name)).collect();
            assert!(found.len() == expected.len() && differs.is_empty(), "{name} {way:?}: {differs:?}");
        }
        // The resolved config in the run folder gives the run again.
        let out = dir.path().join(format!("{name}-again"));
        let mut again = skilltree(dir.path());
        again.args(["run", &format!("{name}/config.toml"), "--backend", "cpu", "--out"]).arg(&out);
        succeeds(again);
        let found = results(&out);
        let differs: Vec<_> = expected.keys().filter(|name| found.get(*name) != expected.get(*name)).collect();
        assert!(found.len() == expected.len() && differs.is_empty(), "{name}, resolved: {differs:?}");
    }
}

#[test]
fn a_dry_run_tells_and_writes_nothing() {
    let dir = TempDir::new().expect("a folder");
    let out = dir.path().join("new");
    let said = succeeds(docking(&out, &["--dry-run", "--cohort", "4"]));
    for words in [
        "sweep:    4 points: skill.dock.trials (2 values), noise (2 values)",
        "learners: 16 (2 arms x 4 points x 2 seeds)\n",
        "for 4 learners in the largest of 4 cohorts",
        "disk:     about ",
        "backend:  cpu",
        "time:     ",
        "by estimate",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    assert!(!out.exists(), "{said}");
    let said = succeeds(trees(&out, &["--dry-run", "--point", "3", "--seeds", "1"]));
    assert!(said.contains("learners: 1 (1 arm x 1 point x 1 seed)\n"), "{said}");
    let said = succeeds(trees(&out, &["--dry-run"]));
    let words = "learners: 8 (1 arm x 4 points x 2 seeds); everything below the roots is trained 4 times";
    assert!(said.contains(words), "{said}");
    assert!(!out.exists() && tree(dir.path()).is_empty(), "{said}");
    // A run says the same before it begins, and what it promised to write is about what it wrote.
    let said = succeeds(docking(&out, &[]));
    assert!(said.contains("time:     ") && said.contains("learners: 16 ("), "{said}");
    let promised = said.lines().find_map(|line| line.strip_prefix("disk:     about ")).expect("a promise");
    let number: f64 = promised.split(' ').next().and_then(|number| number.parse().ok()).expect("a number");
    let promised = number * if promised.contains("MB") { 1e6 } else { 1e3 };
    let written: usize = results(&out)
        .iter()
        .filter(|(name, _)| name.starts_with("skills/") || name.ends_with(".parquet"))
        .map(|(_, bytes)| bytes.len())
        .sum();
    assert!((0.5..2.0).contains(&(promised / written as f64)), "{promised} promised, {written} written");
}

#[test]
fn points_and_arms_that_are_not_there_are_refused() {
    let dir = TempDir::new().expect("a folder");
    let out = dir.path().join("new");
    for (more, says) in [
        (&["--point", "4"][..], &["--point 4", "there is no point 4", "numbered from 0 to 3"][..]),
        (&["--point", "x"], &["--point", "x"]),
        (&["--arm", "taught-adm"], &["--arm taught-adm", "did you mean `taught-adam`?"]),
        (&["--set", "sweep.skill.dock.trials=[1, 'x']"], &["--set sweep.skill.dock.trials", "whole number"]),
    ] {
        let output = docking(&out, more).output().expect("the program");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{more:?} {said}");
        assert!(says.iter().all(|words| said.contains(words)), "{more:?} {said}");
        assert!(!out.exists());
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_learner_that_fits_no_memory_is_refused() {
    let backend = cpu_backend(1, None).expect("a thread");
    assert_eq!(backend.cohort_size(1 << 10).ok(), Some(32));
    let refused = backend.cohort_size(1 << 60);
    assert!(
        matches!(refused, Err(BackendError::NoRoom { bytes, room }) if bytes == 1 << 60 && room > 0),
        "{refused:?}"
    );
}
