//! Figure 2, equal cost, rooms, alterations and example trials, against numbers computed by hand.

use crate::close;
use crate::hand_made_tables::HandMadeTables;
use skilltree::report::comparison::{Comparison, median_actions, within};
use skilltree::report::figure::render_svg;
use skilltree::report::figure2;
use skilltree::report::rooms::{self, low_quantile};
use skilltree::report::statistics::{ratio, ratio_of, sorted};
use skilltree::report::summary::{Score, Series};
use skilltree::report::training::pooled;
use skilltree::report::trajectory_plot::{draw, stretches};
use skilltree::report::transfer::differences;
use skilltree::run_folder::{Trajectory, TrajectoryPoint};
use skilltree::world::load;
use std::path::Path;

/// Of two seeds of a tree, one achieves 1 of its first 10 trials, the other all; 25 trials in all.
fn trained() -> HandMadeTables {
    let mut made = HandMadeTables::default();
    made.arm("hierarchical", true, 2, &[(0, 100, &[("A", 10, 0)]), (25, 9_000, &[("A", 10, 5)])]);
    for trial in 0..25 {
        let lucky = trial == 3;
        made.trial("hierarchical", "recharge", 0, trial, if lucky { (50, 100.0, 0) } else { (200, 0.0, 8) });
        made.trial("hierarchical", "recharge", 1, trial, (100, 100.0, 1));
        made.trial("hierarchical", "dock", 1, trial, (1, 1e6, 1));
    }
    let mut lesson = made.trials[0].clone();
    (lesson.taught, lesson.reward) = (true, 1e6);
    made.trials.push(lesson);
    made
}

#[test]
fn windows_sum_the_roots_training_trials() {
    let trainings = trained().trainings();
    let windows = &trainings[0].windows;
    assert_eq!((trainings.len(), windows.iter().map(|window| window.end).collect::<Vec<_>>()), (1, vec![10, 20, 25]));
    let first = &windows[0].sums;
    assert_eq!((first[0].steps, first[0].reward, first[0].collisions, first[0].episodes), (1850, 100.0, 72, 10));
    assert_eq!((first[1].steps, first[1].reward), (1000, 1000.0));
    let together = pooled(first, Score::reward_and_steps, 2000);
    close(together.value, 1100.0 / 2850.0, 1e-12);
    // A resample of two seeds is one of them twice with probability 1/2.
    close(together.low, 100.0 / 1850.0, 1e-12);
    close(together.high, 1.0, 1e-12);
    // One trial of 2 per step, ten of 1.
    close(pooled(first, Score::ratios_and_trials, 0).value, 12.0 / 20.0, 1e-12);
    let all = trainings[0].sums_by_seed(0);
    assert_eq!((all[0].episodes, all[0].steps, all[1].reward), (25, 24 * 200 + 50, 2500.0));
    close(
        ratio(&trainings[0].sums_by_seed(20).iter().map(Score::reward_and_steps).collect::<Vec<_>>()),
        500.0 / 1500.0,
        1e-12,
    );
    assert!(ratio_of(&[], 100).low.is_nan());
}

#[test]
fn figure_2_has_a_panel_per_kind_of_arm() {
    let mut made = trained();
    made.arm("monolithic", false, 2, &[(25, 5_000, &[("A", 10, 1)])]);
    let (summary, trainings) = (made.summary(), made.trainings());
    let comparison = Comparison::new(&summary).unwrap();
    let drawings = figure2::draw(&comparison, &trainings);
    let names: Vec<_> = drawings.iter().map(|drawing| drawing.name.as_str()).collect();
    // The monolithic arm has tests, which only the paper's version shows, and no training trials.
    assert_eq!(names, ["figure-2a-paper", "figure-2b-paper", "figure-2b"]);
    let paper = render_svg(&drawings[1]);
    assert!(paper.contains(">greedy tests<") && paper.contains(">Mean over the first n = 2 seeds; no interval.<"));
    assert!(render_svg(&drawings[2]).contains(">Sums over n = 2 seeds"));
    // Both panels can be compared.
    assert_eq!((&drawings[0].x, &drawings[0].y), (&drawings[1].x, &drawings[1].y));
    assert_eq!(drawings.iter().filter(|drawing| drawing.section == "paper").count(), 2);
    let costs = figure2::equal_cost(&comparison);
    assert_eq!(costs.len(), 4);
    assert!(costs.iter().all(|figure| render_svg(figure).contains(">monolithic<")), "{:?}", costs[0]);
    assert!(Comparison::new(&HandMadeTables::default().summary()).is_none());
}

/// Four seeds; the tree is tested after 1,000, 2,000 and 3,000 actions.
fn budgets() -> HandMadeTables {
    let mut made = HandMadeTables::default();
    made.arm(
        "hierarchical",
        true,
        4,
        &[(0, 1_000, &[("A", 10, 0)]), (10, 2_000, &[("A", 10, 8)]), (20, 3_000, &[("A", 10, 9)])],
    );
    for seed in 0..4 {
        let late = if seed == 3 { 2_600 } else { 2_500 };
        made.test("monolithic", "recharge", seed, (0, 1_500, &[("A", 10, 2)]));
        made.test("monolithic", "recharge", seed, (99, late, &[("A", 10, 4)]));
    }
    made
}

fn successes(scores: &[Score]) -> Vec<f64> {
    scores.iter().map(Score::success).collect()
}

#[test]
fn equal_cost_takes_the_last_test_within_the_budget() {
    let summary = budgets().summary();
    let of = |arm: &str| summary.series(arm, "recharge").unwrap();
    close(median_actions(of("hierarchical")), 3_000.0, 0.0);
    close(median_actions(of("monolithic")), 2_500.0, 0.0);
    assert_eq!(successes(&within(of("hierarchical"), 2_500.0)), [0.8; 4]);
    // The last seed's second test came later.
    assert_eq!(successes(&within(of("monolithic"), 2_500.0)), [0.4, 0.4, 0.4, 0.2]);
    assert_eq!(successes(&within(of("hierarchical"), 999.0)), [0.0; 4]);
    assert_eq!(within(of("hierarchical"), 999.0)[3].seed, 3);
}

#[test]
fn rooms_are_kept_apart_and_the_worst_seeds_are_seen() {
    let mut made = HandMadeTables::default();
    for seed in 0..21 {
        made.test("hierarchical", "dock", seed, (0, 10, &[("A", 10, 9)]));
        made.test("hierarchical", "recharge", seed, (60, 100, &[("C", 20, seed), ("none", 1, 0), ("A", 20, 20)]));
    }
    // A seed whose tests by chance never began in C.
    made.tests.retain(|row| !(row.seed == 7 && row.room == "C"));
    let summary = made.summary();
    let cell = summary.series("hierarchical", "recharge").unwrap().last();
    let (a, c) = (summary.room("A").unwrap(), summary.room("C").unwrap());
    assert_eq!((rooms::success(cell, a), rooms::success(cell, c).len()), (vec![1.0; 21], 20));
    close(rooms::success(cell, c)[7], 8.0 / 20.0, 1e-12);
    let overall: Vec<f64> = cell.values(Score::success);
    close(overall[4], 24.0 / 41.0, 1e-12);
    assert_eq!(overall.len(), 21);
    close(low_quantile(&sorted(&(0..21).map(|i| f64::from(i) / 20.0).collect::<Vec<_>>())), 0.05, 1e-12);
    let comparison = Comparison::new(&summary).unwrap();
    let shown = rooms::of(&comparison, &summary.rooms);
    assert_eq!(shown.iter().map(|(_, name)| *name).collect::<Vec<_>>(), ["A", "C", "none"]);
    assert_eq!(rooms::table(&comparison, &shown).len(), 1);
}

#[test]
fn alterations_are_paired_by_seed_and_kept_out_of_the_curves() {
    let mut made = HandMadeTables::default();
    made.arm("hierarchical", true, 3, &[(60, 100, &[("A", 10, 9), ("C", 10, 8)])]);
    for (seed, successes) in [(0, 9), (2, 4)] {
        made.variant(
            ("hierarchical", "recharge", "moved"),
            seed,
            (60, 100, &[("A", 10, successes), ("C", 10, successes)]),
        );
    }
    let summary = made.summary();
    let series: &Series = summary.series("hierarchical", "recharge").unwrap();
    assert_eq!((series.tests.len(), series.transfer.len(), series.transfer[0].variant.as_str()), (1, 1, "moved"));
    let found = differences(series, &series.transfer[0]);
    assert_eq!(found.len(), 2);
    close(found[0], 18.0 / 20.0 - 17.0 / 20.0, 1e-12);
    close(found[1], 8.0 / 20.0 - 17.0 / 20.0, 1e-12);
}

/// East along a corridor: follow two steps, pass three, follow one, and there it ends.
pub(crate) fn example() -> Trajectory {
    let children = [0, 0, 1, 1, 1, 0, 1];
    let point = |(i, child): (usize, u32)| TrajectoryPoint { x: 40.0 + 12.0 * i as f32, y: 240.0, heading: 0.0, child };
    Trajectory {
        arm: "hierarchical".into(),
        seed: 0,
        skill: "recharge".into(),
        place: "L1".into(),
        world: "world.toml".into(),
        children: vec!["follow-left".into(), "pass-door".into(), "dock".into()],
        achieved: true,
        points: children.into_iter().enumerate().map(point).collect(),
    }
}

#[test]
fn trajectories_are_drawn_in_the_colour_of_who_drives() {
    let trajectory = example();
    let cut = stretches(&trajectory.points);
    assert_eq!(cut.iter().map(|piece| (piece.child, piece.way.len())).collect::<Vec<_>>(), [(0, 3), (1, 4), (0, 2)]);
    assert_eq!(cut[1].way[0], cut[0].way[2]);
    let world = load::parse(crate::OFFICE, Path::new("world.toml")).unwrap();
    let drawn = render_svg(&draw(&world, &trajectory));
    // Each child's pieces and its entry in the legend; the third child never drives.
    let lines = |color: &str| drawn.matches(&format!("fill=\"none\" stroke=\"{color}\"")).count();
    assert_eq!((lines("#0072b2"), lines("#d55e00"), lines("#009e73")), (2 + 1, 1 + 1, 0));
    assert!(drawn.contains(">6 steps, goal achieved (seed 0)<"));
    assert!(drawn.contains(">pass-door<") && !drawn.contains(">dock<"));
    let failed = Trajectory { achieved: false, points: Vec::new(), ..trajectory };
    assert!(draw(&world, &failed).subtitle.contains("0 steps, goal not achieved"));
}
