//! The planner in the place of skills: its tables against the planner itself, and skills that need no nets.

use super::super::configs::{TREE, number, plan_with};
use super::super::learner::seen;
use super::super::random::random;
use glam::Vec2;
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::{Backend, Test};
use skilltree::config::plan::{Plan, SkillPlan};
use skilltree::layout::Episode;
use skilltree::teacher::value_iteration::Planner;
use skilltree::train::batch_group::{BatchGroup, groups, terms_of};
use skilltree::world::Pose;

/// The tree with all four skills planned; children in no tidy order.
fn planned() -> (Plan, BatchGroup) {
    let set = [
        "skill.dock.oracle=true",
        "skill.door.oracle=true",
        "skill.right.oracle=true",
        "skill.right.children=['turn-60', 'move+12', 'turn+15']",
        "skill.door.children=['turn+60', 'turn-15', 'move+12', 'turn-60', 'turn+15']",
        "skill.door.learning.reward_scale=50.0",
        "evaluate.episodes=40",
    ];
    let plan = plan_with(TREE, &set);
    let group = groups(&plan).unwrap_or_else(|error| panic!("{error}")).remove(0);
    (plan, group)
}

fn planner(plan: &Plan, group: &BatchGroup, skill: &SkillPlan) -> Planner {
    Planner::new(plan.world(), &group.shared, skill, &terms_of(&plan.arms[0]))
}

/// Values of all children at a pose of a trial that began in room `origin`.
fn consulted(group: &BatchGroup, skill: usize, origin: u32, pose: Pose) -> Vec<f32> {
    let children = group.shared.skills[skill].children as usize;
    seen(&group.shared, &[], &[], |robot| {
        robot.reset(pose);
        robot.agent.origin = origin;
        robot.planned_values(skill as u32);
        robot.q[..children].to_vec()
    })
}

fn greatest(values: &[f32]) -> usize {
    (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).expect("a child")
}

#[test]
fn tables_hold_the_planners_choices() {
    let (plan, group) = planned();
    let world = plan.world();
    let arm = &plan.arms[0];
    let mut next = random(41);
    for name in ["dock", "door", "right", "left"] {
        let number = number(&plan, name);
        let skill = &arm.skills[number];
        assert!(group.shared.skills[number].planned > 0, "{name}");
        let planner = planner(&plan, &group, skill);
        let origins = if name == "door" { 2 } else { 1 };
        let mut picked = std::collections::BTreeSet::new();
        let (mut compared, mut buried) = (0, 0);
        for _ in 0..1500 {
            let cell = |size: f32, n: f64| ((f64::from(size) / 5.0 + 1.0) * n) as u32;
            let (column, row) = (cell(world.size.x, next()), cell(world.size.y, next()));
            let at = Vec2::new(column as f32 * 5.0, row as f32 * 5.0);
            let heading = (next() * 24.0) as u32 as f32 * 15.0;
            let origin = (next() * f64::from(origins)) as u32;
            // Anywhere round the grid pose the table says the same.
            let near = |n: f64| (n * 4.9 - 2.45) as f32;
            let (dx, dy, turn) = (near(next()), near(next()), near(next()) * 3.0);
            let pose = Pose {
                x: (at.x + dx).clamp(0.0, world.size.x),
                y: (at.y + dy).clamp(0.0, world.size.y),
                heading: (heading + turn).rem_euclid(360.0),
            };
            let found = consulted(&group, number, origin, pose);
            // Where no robot can stand, the nearest grid pose at which one can speaks for it.
            let free = |at: Vec2| world.is_free(at);
            let corners = (0..34_u32).flat_map(|x| (0..25_u32).map(move |y| Vec2::new(x as f32 * 5.0, y as f32 * 5.0)));
            let nearest: Vec<Vec2> = if free(at) {
                vec![at]
            } else {
                let all: Vec<Vec2> = corners.filter(|corner| free(*corner)).collect();
                let least = all.iter().map(|corner| corner.distance(at)).fold(f32::INFINITY, f32::min);
                all.into_iter().filter(|corner| corner.distance(at) < least + 0.01).collect()
            };
            let says = nearest.iter().map(|at| {
                let pose = Pose { x: at.x, y: at.y, heading };
                let value = planner.value(origin, pose) / skill.params.reward_scale;
                (planner.choose(&group.shared, origin, pose), value)
            });
            let best = greatest(&found);
            let agrees = |(child, value): (usize, f32)| {
                child == best && (value - found[best]).abs() < 1.0e-5 + value.abs() * 1.0e-5
            };
            assert!(
                says.clone().any(agrees),
                "{name} at {at} {heading} from {origin}: {found:?} {:?}",
                says.collect::<Vec<_>>()
            );
            // The others stand so far below that no temperature brings them up.
            assert!(found.iter().enumerate().all(|(child, q)| child == best || (found[best] - q - 1.0).abs() < 1.0e-5));
            picked.insert(best);
            compared += 1;
            buried += u32::from(!free(at));
        }
        println!("{name}: {picked:?} {buried} of {compared}");
        // Every action is the best one somewhere, but backing up, which costs.
        assert!(picked.len() >= 3 && buried > 100, "{name}: {picked:?} {buried}");
    }
}

/// Nets of planned skills are never looked at, and the tree does its work with untrained ones.
#[test]
fn planned_skills_need_no_nets() {
    let (plan, group) = planned();
    let learners = group.learners(&plan);
    let cohort = group.cohort(&plan, &learners);
    let root = cohort.skills - 1;
    assert!(plan.arms[0].skills[..root].iter().all(|skill| skill.params.trials == 0 && skill.params.lessons == 0));
    let tests = |poison: bool| -> Vec<Episode> {
        let mut cohort = cohort.clone();
        let end = cohort.shared.skills[root].nets_offset as usize;
        if poison {
            cohort.nets[..end].fill(f32::NAN);
        }
        let mut backend = cpu_backend(2, None).expect("threads");
        backend.load(cohort.clone()).expect("memory");
        (0..root as u32)
            .chain([root as u32])
            .flat_map(|skill| backend.evaluate(Test { skill, number: 5, episodes: 40 }).expect("it runs"))
            .collect()
    };
    let found = tests(false);
    assert!(found == tests(true), "a planned skill looks at its nets");
    let achieved =
        |skill: &str| found[number(&plan, skill) * 40..][..40].iter().filter(|episode| episode.state == 2).count();
    println!("{} {}", achieved("dock"), achieved("door"));
    // Untaught and untrained, and yet they nearly always achieve their goals.
    assert!(achieved("dock") >= 36 && achieved("door") >= 32);
}
