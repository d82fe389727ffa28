//! Pages of whole runs: which parts they have, and which they leave out.

use crate::comparison::example;
use crate::hand_made_tables::HandMadeTables;
use crate::{OFFICE, scratch};
use skilltree::report::write;
use skilltree::run_folder::tables::write_table;
use skilltree::run_folder::{JsonFile, Provenance, RunFolder, Trajectory};
use std::fs;
use std::path::Path;

/// Parts that only runs with a hierarchy have.
const PARTS: [&str; 6] = [
    "Figure 2: ",
    "Equal cost",
    "Success by starting room",
    "Example trials",
    "Altered worlds and noise",
    "monolithic",
];

fn finish(dir: &Path, made: &HandMadeTables, config: &str, worlds: &[(&str, &str)], trajectories: &[Trajectory]) {
    let seeds = made.summary().skills[0].series[0].last().scores.iter().map(|score| score.seed).collect();
    let provenance = Provenance { version: "0.1.0".into(), backend: "cpu".into(), seeds, ..Provenance::default() };
    let files = [
        ("trials.parquet".to_owned(), write_table(&made.trials).unwrap()),
        ("evaluations.parquet".to_owned(), write_table(&made.tests).unwrap()),
        ("trajectories.json".to_owned(), trajectories.to_vec().to_bytes().unwrap()),
    ];
    RunFolder::open(dir, config, worlds).unwrap().finish(files, provenance).unwrap();
}

/// A tree, two arms without, an arm that does not learn, two alterations in one other world, two example trials.
fn everything(dir: &Path) {
    let mut made = HandMadeTables::default();
    let rooms = |successes: u32| [("A", 20, successes), ("B", 20, successes / 2), ("C", 20, successes)];
    made.arm("hierarchical", true, 8, &[(0, 500, &rooms(2)), (20, 2_500, &rooms(16)), (60, 6_000, &rooms(19))]);
    made.arm("no-persistence", true, 8, &[(0, 500, &rooms(2)), (60, 8_000, &rooms(9))]);
    made.arm("fixed-arbitration", true, 8, &[(0, 500, &rooms(15))]);
    made.arm("monolithic", false, 8, &[(0, 300, &rooms(1)), (60, 9_000, &rooms(4))]);
    made.arm("monolithic-penalty", false, 8, &[(0, 300, &rooms(1)), (60, 9_000, &rooms(6))]);
    for row in made.tests.iter_mut().rev().take(6) {
        row.reward -= 10.0;
    }
    made.test("planner", "recharge", 0, (0, 0, &rooms(20)));
    for (seed, trial) in (0..8).flat_map(|seed| (0..60).map(move |trial| (seed, trial))) {
        let learned = trial > 5 + 3 * seed;
        made.trial("hierarchical", "recharge", seed, trial, if learned { (80, 100.0, 1) } else { (200, 0.0, 9) });
        made.trial(
            "monolithic",
            "recharge",
            seed,
            trial,
            if trial % 9 == seed { (60, 100.0, 9) } else { (200, 0.0, 30) },
        );
    }
    for (variant, seed) in ["easy", "noise-double"].iter().flat_map(|variant| (0..8).map(move |seed| (variant, seed))) {
        made.variant(("hierarchical", "recharge", variant), seed, (60, 6_000, &rooms(18)));
        made.variant(("monolithic", "recharge", variant), seed, (60, 9_000, &rooms(4)));
    }
    let config = concat!(
        "title = \"A <tree>\"\n",
        "[transfer.easy]\nworld = \"worlds/easy.toml\"\n",
        "[transfer.noise-double]\nnoise = { sonar = 0.2 }\n"
    );
    let flat = Trajectory { arm: "monolithic".into(), achieved: false, world: "worlds/easy.toml".into(), ..example() };
    let third = Trajectory { arm: "no-persistence".into(), ..example() };
    let easy = include_str!("../../configs/worlds/office-easy.toml");
    finish(dir, &made, config, &[("world.toml", OFFICE), ("worlds/easy.toml", easy)], &[third, example(), flat]);
}

#[test]
fn a_hierarchy_has_every_part() {
    let dir = scratch("report-everything");
    everything(&dir);
    let written = write(&dir).unwrap();
    let names: Vec<_> = written.files.iter().map(|path| path.strip_prefix(&dir).unwrap().to_str().unwrap()).collect();
    for name in [
        "figure-2a-paper",
        "figure-2b",
        "success-by-actions",
        "reinforcement-by-trials",
        "rooms-hierarchical",
        "rooms-monolithic",
        "trial-hierarchical-L1",
        "trial-monolithic-L1",
        "world-easy",
    ] {
        assert!(names.contains(&format!("figures/{name}.svg").as_str()), "{name}: {names:?}");
    }
    assert!(!names.contains(&"figures/trial-no-persistence-L1.svg"));
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    for fetch in ["http:", "https:", "src=", "href=", "@import", "url("] {
        assert!(!page.contains(fetch), "{fetch}");
    }
    for said in PARTS.into_iter().chain([
        "A &lt;tree&gt;",
        "The paper's claims",
        "not tested here",
        "There is no arm <code>td0</code>.",
        "<dt>noise-double</dt><dd>noise = { sonar = 0.2 }</dd>",
        "arms that are punished are left out",
        "hierarchical minus fixed-arbitration</td><td>60, 0</td>",
        "hierarchical +2: also no-persistence, fixed-arbitration",
    ]) {
        assert!(page.contains(said), "{said}");
    }
    assert!(!page.contains("NaN") && !page.contains('`'));
    let said = written.summary;
    // 16 + 8 + 16 of 60; every seed the same.
    assert!(said.contains("A 95.0% [95.0, 95.0]   B 45.0% [45.0, 45.0]   C 95.0% [95.0, 95.0]"), "{said}");
    assert!(said.lines().any(|line| line.starts_with("   7 tree, 20 trials    partly")), "{said}");
    assert_eq!(said.lines().filter(|line| line.contains("not tested here")).count(), 5, "{said}");
}

#[test]
fn docking_alone_has_a_short_page() {
    let dir = scratch("report-docking");
    let mut made = HandMadeTables::default();
    for (arm, seed) in ["taught-adam", "untaught-adam"].iter().flat_map(|arm| (0..7).map(move |seed| (arm, seed))) {
        made.test(arm, "dock", seed, (0, 100, &[("A", 20, 1)]));
        let learned = if *arm == "taught-adam" { 13 } else { 4 };
        made.test(arm, "dock", seed, (150, 3_000, &[("A", 20, learned + seed)]));
        made.trial(arm, "dock", seed, 0, (30, -10.0, 1));
    }
    finish(&dir, &made, "", &[("world.toml", OFFICE)], &[]);
    let said = write(&dir).unwrap().summary;
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    for part in PARTS.into_iter().chain(["The paper's claims"]) {
        assert!(!page.contains(part), "{part}");
    }
    assert!(page.contains("taught-adam minus untaught-adam") && page.contains("until 80% of a seed"));
    assert!(!said.contains("claims"));
    let dir = scratch("report-docking-claims");
    let mut named = HandMadeTables::default();
    for seed in 0..7 {
        named.test("docking-taught", "dock", seed, (150, 3_000, &[("A", 20, 19)]));
    }
    finish(&dir, &named, "", &[("world.toml", OFFICE)], &[]);
    write(&dir).unwrap();
    let page = fs::read_to_string(dir.join("report.html")).unwrap();
    assert!(page.contains("The paper's claims") && !page.contains("not tested here"));
    assert_eq!(page.matches("class=\"verdict").count(), 1);
}
