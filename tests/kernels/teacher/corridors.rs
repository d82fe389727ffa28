//! The planner against exact values: shortest paths by breadth-first search and a recursion in f64, in corridors whose
//! grid the robot's moves keep to.

use super::super::configs::shipped;
use super::super::rewards::rewards;
use skilltree::config::plan::{Action, Child, Event, Noise, RegionEvent, SkillPlan};
use skilltree::env::motion::{DOCKED, PASSED_DOOR};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::choices::{NOISE_GAUSSIAN, NOISE_UNIFORM};
use skilltree::teacher::value_iteration::{Planner, Terms};
use skilltree::train::observation::{SILENT, floor_only};
use skilltree::world::{Pose, World, parse};
use std::collections::VecDeque;
use std::fmt::Write;
use std::path::Path;

/// Inches between grid points of the corridors, and side of their square floor.
const MOVE: i32 = 12;
const SIDE: f64 = 240.0;
const DISCOUNT: f32 = 0.9;

/// A quarter turn of the floor about its middle, some times over. It takes grid points to grid points.
fn turned(point: [f64; 2], quarters: u32) -> [f64; 2] {
    (0..quarters).fold(point, |[x, y], _| [SIDE - y, x])
}

fn turned_box(b: [f64; 4], quarters: u32) -> [f64; 4] {
    let (p, q) = (turned([b[0], b[1]], quarters), turned([b[2], b[3]], quarters));
    [p[0].min(q[0]), p[1].min(q[1]), p[0].max(q[0]), p[1].max(q[1])]
}

/// A corridor along y = 24 with an inch of play on either side of the robot: only along it can it move 12 in. At its
/// west end the charger's front, at its east end a wall 18 in from the last grid point. Then turned by quarters.
fn corridor(charger_front: f64, quarters: u32) -> World {
    corridor_with(charger_front, quarters, "")
}

/// The same with more in its file.
fn corridor_with(charger_front: f64, quarters: u32, more: &str) -> World {
    let walls = [[0.0, 11.0, SIDE, 11.0], [0.0, 37.0, SIDE, 37.0], [234.0, 11.0, 234.0, 37.0]];
    let walls = walls.map(|w| turned_box(w, quarters));
    let rooms = [("A", [0.0, 11.0, 116.0, 37.0]), ("B", [124.0, 11.0, SIDE, 37.0]), ("C", [0.0, 60.0, SIDE, SIDE])];
    let mut text = format!("size = [{SIDE}, {SIDE}]\nwalls = {walls:?}\n");
    for (name, area) in rooms {
        let _ = writeln!(text, "[[rooms]]\nname = {name:?}\nbox = {:?}", turned_box(area, quarters));
    }
    let centre = turned([120.0, 24.0], quarters);
    let _ = writeln!(text, "[[doors]]\nname = \"gap\"\nrooms = [\"A\", \"B\"]\ncentre = {centre:?}\nwidth = 26");
    let charger = turned_box([0.0, 12.0, charger_front, 36.0], quarters);
    let _ = writeln!(text, "[charger]\nbox = {charger:?}\ntolerance = 20\n{more}");
    parse(&text, Path::new("corridor.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A pose on the corridor's line; the heading is relative to the corridor.
fn on_line(x: f64, heading: f64, quarters: u32) -> Pose {
    let [x, y] = turned([x, 24.0], quarters);
    let heading = (heading + 90.0 * f64::from(quarters)).rem_euclid(360.0);
    Pose { x: x as f32, y: y as f32, heading: heading as f32 }
}

fn docking() -> SkillPlan {
    let skill = shipped("configs/docking.toml", &[]).arms[0].skills[0].clone();
    assert_eq!(
        (skill.params.reward, skill.goal),
        (rewards(&[(Event::Docked, 100.0), (Event::Collision, -10.0)]), DOCKED)
    );
    skill
}

/// What a planner plans with.
fn terms(noise: Noise, backward_cost: f32, pitch: f32) -> Terms {
    Terms { noise, beside: (15, 30), discount: DISCOUNT, backward_cost, collision_cost: 0.0, pitch }
}

/// Place on the line in moves, and heading in steps of 15 degrees.
type State = (i32, i32);

/// What an action leads to in the corridor, if nothing is in the way; none where it would collide.
fn next(state: State, action: Action) -> Option<State> {
    let (place, heading) = state;
    let turn = (action.turn() / 15.0) as i32;
    if turn != 0 {
        return Some((place, (heading + turn).rem_euclid(24)));
    }
    let travel = action.travel() as i32 / MOVE;
    match heading {
        0 => Some((place + travel, heading)),
        12 => Some((place - travel, heading)),
        _ => None,
    }
}

/// Fewest actions to the goal from every state with a place in `range`; `ends` says which step reaches it.
fn distances(
    children: &[Action],
    range: std::ops::Range<i32>,
    ends: impl Fn(State, State, Action) -> bool,
) -> Vec<(State, u32)> {
    let states = || range.clone().flat_map(|place| (0..24).map(move |heading| (place, heading)));
    let steps: Vec<(State, State)> = states()
        .flat_map(|state| children.iter().filter_map(move |action| next(state, *action).map(|to| (state, to, *action))))
        .filter(|(from, to, action)| !ends(*from, *to, *action) && range.contains(&to.0))
        .map(|(from, to, _)| (from, to))
        .collect();
    let last = |state: &State| children.iter().any(|a| next(*state, *a).is_some_and(|to| ends(*state, to, *a)));
    let mut found: Vec<(State, u32)> = states().filter(last).map(|state| (state, 1)).collect();
    let mut queue: VecDeque<(State, u32)> = found.iter().copied().collect();
    while let Some((state, distance)) = queue.pop_front() {
        for (from, _) in steps.iter().filter(|(_, to)| *to == state) {
            if !found.iter().any(|(known, _)| known == from) {
                found.push((*from, distance + 1));
                queue.push_back((*from, distance + 1));
            }
        }
    }
    found
}

/// The actions that a skill chooses among.
fn actions(skill: &SkillPlan) -> Vec<Action> {
    let action = |child: &Child| match child {
        Child::Action(action) => *action,
        Child::Skill(_) => panic!("a skill among the children"),
    };
    skill.children.iter().map(action).collect()
}

fn close(found: f32, expected: f64, what: impl Fn() -> String) {
    let error = (f64::from(found) - expected).abs();
    assert!(error <= 1.0e-4 * expected.abs(), "{}: {found} for {expected}", what());
}

/// Checks a planner against the shortest paths: values on grid poses and between them, and every choice.
fn check_paths(planner: &Planner, floor: &CohortData, children: &[Action], found: &[(State, u32)], quarters: u32) {
    check_dear_paths(planner, floor, children, found, quarters, 0.0);
}

/// The same where every step costs something.
fn check_dear_paths(
    planner: &Planner,
    floor: &CohortData,
    children: &[Action],
    found: &[(State, u32)],
    quarters: u32,
    step_cost: f64,
) {
    let later = |steps: u32| f64::from(DISCOUNT).powi(steps as i32);
    let worth =
        |distance: u32| (0..distance).map(|step| -step_cost * later(step)).sum::<f64>() + 100.0 * later(distance - 1);
    let distance = |state: State| found.iter().find(|(known, _)| *known == state).map(|(_, distance)| *distance);
    let inches = |place: i32| f64::from(place * MOVE);
    for ((place, heading), steps) in found.iter().copied() {
        let pose = on_line(inches(place), f64::from(heading) * 15.0, quarters);
        let say = || format!("place {place}, heading {heading}, {steps} steps, turned {quarters} times");
        close(planner.value(0, pose), worth(steps), say);
        let child = children[planner.choose(floor, 0, pose)];
        close(planner.worth(floor, 0, pose, child), worth(steps), say);
        let after = next((place, heading), child).and_then(distance);
        assert!(steps == 1 || after == Some(steps - 1), "{}: {child:?} leads to {after:?}", say());
        // A third of the way to the next place and a quarter of the way to the next heading.
        let beside = (heading + 1).rem_euclid(24);
        let corner = |place, heading| distance((place, heading)).map(worth);
        if let (Some(a), Some(b), Some(c), Some(d)) =
            (Some(worth(steps)), corner(place + 1, heading), corner(place, beside), corner(place + 1, beside))
        {
            let between = on_line(inches(place) + 4.0, f64::from(heading) * 15.0 + 3.75, quarters);
            let mixed = 0.75 * (a * 2.0 / 3.0 + b / 3.0) + 0.25 * (c * 2.0 / 3.0 + d / 3.0);
            close(planner.value(0, between), mixed, say);
        }
    }
}

#[test]
fn docking_values_are_those_of_the_shortest_paths() {
    let skill = docking();
    for quarters in 0..4 {
        // Contact is 30 in from the end: halfway between two grid points, so no rounding decides a step.
        let world = corridor(18.0, quarters);
        let shared = floor_only(&world);
        let planner = Planner::new(&world, &shared, &skill, &terms(SILENT, 5.0, MOVE as f32));
        // Places 3 to 18: 36 to 216 in. A forward step west from place 3 docks.
        let docks = |_: State, to: State, action: Action| to.0 == 2 && action == Action::Forward;
        let found = distances(&actions(&skill), 3..19, docks);
        assert_eq!(found.len(), 16 * 24);
        assert_eq!(found.iter().map(|(_, steps)| *steps).max(), Some(16 + 4));
        check_paths(&planner, &shared, &actions(&skill), &found, quarters);
        // Backing up is worth its cost less than what follows it, and a bump 10 less.
        let ahead = on_line(72.0, 0.0, quarters);
        let back = planner.worth(&shared, 0, ahead, Action::Backward);
        close(back, 0.9 * 100.0 * 0.9_f64.powi(3 + 3 - 1) - 5.0, || "backward".to_owned());
        let bump = planner.worth(&shared, 0, on_line(216.0, 0.0, quarters), Action::Forward);
        close(bump, 0.9 * 100.0 * 0.9_f64.powi(3 + 16 - 1) - 10.0, || "bump".to_owned());
        // The teacher's own cost of collisions comes on top, and changes nothing where nobody needs to collide.
        if quarters == 1 {
            let dear = Terms { collision_cost: 7.0, ..terms(SILENT, 5.0, MOVE as f32) };
            let planner = Planner::new(&world, &shared, &skill, &dear);
            check_paths(&planner, &shared, &actions(&skill), &found, quarters);
            let bump = planner.worth(&shared, 0, on_line(216.0, 0.0, quarters), Action::Forward);
            close(bump, 0.9 * 100.0 * 0.9_f64.powi(3 + 16 - 1) - 17.0, || "dear bump".to_owned());
        }
    }
}

#[test]
fn door_values_are_those_of_the_shortest_paths() {
    let mut skill = docking();
    skill.params.reward = rewards(&[(Event::Collision, -10.0), (Event::PassedDoor, 100.0)]);
    skill.goal = PASSED_DOOR;
    // Fewer children, in another order, for good measure.
    let children = [Action::Backward, Action::TurnLeft60, Action::TurnLeft15, Action::Forward];
    skill.children = children.map(Child::Action).to_vec();
    for quarters in 0..4 {
        let world = corridor(18.0, quarters);
        let shared = floor_only(&world);
        let planner = Planner::new(&world, &shared, &skill, &terms(SILENT, 0.0, MOVE as f32));
        // The far face is at 124 in; a robot beyond 137 in has passed: the first grid point is at 144, place 12.
        let found = distances(&actions(&skill), 3..12, |_, to, _| to.0 == 12);
        assert_eq!(found.len(), 9 * 24);
        check_paths(&planner, &shared, &actions(&skill), &found, quarters);
    }
}

/// Only forwards, towards the charger, by 6, 12 or 18 in: the quadrature's three points. A value is a sum over the
/// three, in f64.
#[test]
fn values_under_noise_are_those_of_the_recursion() {
    let mut skill = docking();
    skill.children = vec![Child::Action(Action::Forward)];
    for (kind, actuator, weights) in [
        (NOISE_GAUSSIAN, 0.5 / 3.0_f64.sqrt(), [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]),
        (NOISE_UNIFORM, 0.5 / 0.6_f64.sqrt(), [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0]),
    ] {
        // Contact at 27 in: between the grid points of 6 in.
        let world = corridor(15.0, 0);
        let shared = floor_only(&world);
        let noise = Noise { kind, actuator: actuator as f32, ..SILENT };
        let planner = Planner::new(&world, &shared, &skill, &terms(noise, 5.0, 6.0));
        let mut exact: Vec<f64> = Vec::new();
        for place in 0..30 {
            let x = 30.0 + 6.0 * f64::from(place);
            let after = |half_moves: usize| {
                let end = x - 6.0 * half_moves as f64;
                if end < 27.0 { 100.0 } else { 0.9 * exact[place as usize - half_moves] }
            };
            let value = weights.iter().enumerate().map(|(i, weight)| weight * after(i + 1)).sum::<f64>();
            exact.push(value);
            let pose = on_line(x, 180.0, 0);
            close(planner.value(0, pose), value, || format!("noise of kind {kind} at {x} in"));
        }
        assert!((exact[0] - 100.0).abs() < 1.0e-9 && exact[29] < 30.0);
    }
}

/// Into a region at the corridor's far end, where every step costs 3, turns too.
#[test]
fn a_step_cost_and_a_region_make_the_shortest_paths() {
    let mut skill = docking();
    let text = |quarters| {
        let area = turned_box([138.0, 11.0, SIDE, 37.0], quarters);
        format!("[[regions]]\nname = \"end\"\nbox = {area:?}\n")
    };
    skill.regions = vec!["room:C".to_owned(), "end".to_owned()];
    skill.params.reward = rewards(&[(Event::Collision, -10.0), (Event::Acted, -3.0)]);
    skill.params.reward[RegionEvent::Entered.number(1)] = 100.0;
    for goal in [RegionEvent::Entered, RegionEvent::In] {
        skill.goal = 1 << goal.number(1);
        for quarters in 0..4 {
            let world = corridor_with(18.0, quarters, &text(quarters));
            let shared = floor_only(&world);
            let planner = Planner::new(&world, &shared, &skill, &terms(SILENT, 0.0, MOVE as f32));
            // Place 12 is at 144 in.
            let found = distances(&actions(&skill), 3..12, |_, to, _| to.0 == 12);
            check_dear_paths(&planner, &shared, &actions(&skill), &found, quarters, 3.0);
        }
    }
}

/// A door that pays and ends nothing: the robot goes to and fro through it. A crossing counts 13 in beyond the wall, at
/// place 12 eastwards and at place 8 westwards, four moves apart.
#[test]
fn a_door_pays_again_from_the_other_room() {
    let mut skill = docking();
    skill.params.reward = rewards(&[(Event::PassedDoor, 10.0)]);
    skill.goal = 0;
    let world = corridor(18.0, 0);
    let shared = floor_only(&world);
    let planner = Planner::new(&world, &shared, &skill, &terms(SILENT, 0.0, MOVE as f32));
    let round = 0.9_f64.powi(4);
    for (origin, place) in [(0, 8), (0, 9), (0, 11), (1, 12), (1, 10), (1, 9)] {
        let moves = if origin == 0 { 12 - place } else { place - 8 };
        let expected = 10.0 * 0.9_f64.powi(moves - 1) / (1.0 - round);
        let pose = on_line(f64::from(place * MOVE), 0.0, 0);
        close(planner.value(origin, pose), expected, || format!("place {place} from room {origin}"));
    }
}

/// Paid for every step in sight of the light: all there is on one side of a wall, nothing on the other.
#[test]
fn the_light_is_worth_its_reward_where_it_is_in_sight() {
    let mut skill = docking();
    skill.params.reward = rewards(&[(Event::Lit, 1.0)]);
    skill.goal = 0;
    let text = "size = [240, 96]\nwalls = [[120, 0, 120, 96]]\nlight = { at = [12, 48], range = 400 }\n\
        [[rooms]]\nname = \"A\"\nbox = [0, 0, 240, 96]\n";
    let world = parse(text, Path::new("halves.toml")).unwrap_or_else(|error| panic!("{error}"));
    let shared = floor_only(&world);
    let planner = Planner::new(&world, &shared, &skill, &terms(SILENT, 0.0, MOVE as f32));
    for (x, expected) in [(36.0, 1.0 / (1.0 - 0.9)), (84.0, 10.0), (156.0, 0.0), (204.0, 0.0)] {
        for heading in 0..24 {
            let pose = Pose { x, y: 48.0, heading: heading as f32 * 15.0 };
            let value = planner.value(0, pose);
            assert!((value - expected).abs() < 2.0e-3, "{pose:?}: {value} for {expected}");
        }
    }
}
