//! The planner against exact values: shortest paths by breadth-first search and a recursion in f64, in corridors whose
//! grid the robot's moves keep to. Then its success in the office, for two skills, and the lessons that it leaves.

use skilltree::backend::Backend;
use skilltree::backend::cpu::CpuBackend;
use skilltree::config::plan::{Action, Child, Noise, Plan, SkillPlan};
use skilltree::config::{Overrides, load};
use skilltree::env::events::passed_door;
use skilltree::env::motion::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, PASSED_DOOR, move_body};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::choices::{NOISE_GAUSSIAN, NOISE_UNIFORM};
use skilltree::layout::{BASE_WORDS, LESSON_HEADER, Robot};
use skilltree::learn::lesson::ENDED;
use skilltree::teacher::demonstrations::Demonstration;
use skilltree::teacher::value_iteration::{Planner, Terms};
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::observation::{Observation, SILENT, floor_only, robot_at};
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
    let _ = writeln!(text, "[charger]\nbox = {charger:?}\ntolerance = 20");
    parse(&text, Path::new("corridor.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// A pose on the corridor's line; the heading is relative to the corridor.
fn on_line(x: f64, heading: f64, quarters: u32) -> Pose {
    let [x, y] = turned([x, 24.0], quarters);
    let heading = (heading + 90.0 * f64::from(quarters)).rem_euclid(360.0);
    Pose { x: x as f32, y: y as f32, heading: heading as f32 }
}

fn docking() -> (Plan, SkillPlan) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/docking.toml");
    let plan = load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let skill = plan.arms[0].skills[0].clone();
    assert_eq!((skill.params.reward, skill.goal), ([100.0, -10.0, 0.0, 0.0, 0.0], DOCKED));
    (plan, skill)
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
    let worth = |distance: u32| 100.0 * f64::from(DISCOUNT).powi(distance as i32 - 1);
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
    let (_, skill) = docking();
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
    let (_, mut skill) = docking();
    skill.params.reward = [0.0, -10.0, 100.0, 0.0, 0.0];
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
    let (_, mut skill) = docking();
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
            let value = weights.iter().enumerate().map(|(i, weight)| weight * after(i + 1)).sum();
            exact.push(value);
            let pose = on_line(x, 180.0, 0);
            close(planner.value(0, pose), value, || format!("{kind:?} at {x} in"));
        }
        assert!((exact[0] - 100.0).abs() < 1.0e-9 && exact[29] < 30.0);
    }
}

// In the office.

fn office_config(skill: &str, extra: &str) -> Plan {
    let office = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/worlds/office.toml");
    let text = format!(
        "title = \"teacher\"\nworld = {office:?}\nseeds = \"0\"\n{extra}\n[evaluate]\nat = []\nepisodes = 1\n\
         [teacher]\nlessons = 100\neval_episodes = 1000\n{skill}\n[arm.only]\n"
    );
    let folder = tempfile::tempdir().expect("a folder for the config");
    let path = folder.path().join("teacher.toml");
    std::fs::write(&path, text).expect("the config is written");
    load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

const DOCK: &str = r#"
    [skill.dock]
    inputs = ["sonar(60)", "light", "bumpers"]
    children = ["turn+15", "turn-15", "turn+60", "turn-60", "move+12", "move-12"]
    reward = { docked = 100, collision = -10 }
    starts = { light-area = 0.8, anywhere = 0.2 }
    eval_starts = "light-area"
    goal = ["docked"]
    max_steps = 30
    lessons = 10
    trials = 10
"#;

const DOOR: &str = r#"
    [skill.door]
    inputs = ["sonar(60)", "compass"]
    children = ["turn+15", "turn-15", "turn+60", "turn-60", "move+12", "move-12"]
    reward = { passed-door = 100, collision = -10 }
    starts = { near-doors = 1.0 }
    eval_starts = "near-doors"
    goal = ["passed-door"]
    max_steps = 25
    lessons = 10
    trials = 10
"#;

fn only(plan: &Plan) -> BatchGroup {
    let mut groups = groups(plan).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(groups.len(), 1);
    groups.remove(0)
}

/// The planner's own tests of the only skill.
fn bounds(group: &BatchGroup) -> &[Demonstration] {
    group.bounds[0].as_deref().expect("the first group has the tests")
}

fn success(group: &BatchGroup) -> f64 {
    let tests = bounds(group);
    assert_eq!(tests.len(), 1000);
    tests.iter().filter(|test| test.achieved()).count() as f64 / 1000.0
}

/// A lesson's header against its own records. `pay` is what docking, collisions and doors bring.
fn check_lesson(lesson: &[u32], ends: u32, pay: [f32; 3]) {
    let steps = lesson[0] as usize;
    let record = |step: usize| &lesson[LESSON_HEADER + step * BASE_WORDS..][..BASE_WORDS];
    // Every choice is a free one among all six actions.
    let open = 0x3f << 8 | 0x3f << 16 | 1 << 31;
    let (mut reward, mut collisions) = (0.0, 0);
    for step in 0..steps {
        let word = record(step)[8];
        let events = word >> 24 & 0x7f;
        assert!(word & 0xff < 6 && word & !(events << 24) & !0xff == open, "{word:x}");
        let earned: f32 = (0..3).filter(|event| events >> event & 1 == 1).map(|event| pay[event]).sum();
        assert_eq!(f32::from_bits(record(step)[9]), earned);
        reward += earned;
        collisions += events >> 1 & 1;
        assert_eq!(events & ends != 0, step + 1 == steps && lesson[1] == ENDED, "step {step} of {steps}");
    }
    assert_eq!((f32::from_bits(lesson[2]), lesson[3]), (reward, collisions));
    assert_eq!(record(steps)[8..], [255 | open, 0], "no action after the last observation");
    assert!(lesson[LESSON_HEADER + (steps + 1) * BASE_WORDS..].iter().all(|word| *word == 0));
}

fn check_bank(group: &BatchGroup, ends: u32, pay: [f32; 3]) {
    let skill = &group.shared.skills[0];
    assert_eq!((skill.bank_offset, skill.bank_lessons), (0, 100));
    let lessons: Vec<&[u32]> = group.shared.bank.chunks(skill.lesson_stride as usize).collect();
    assert_eq!(lessons.len(), 100);
    for (number, lesson) in lessons.iter().enumerate() {
        assert_eq!(lesson[1], ENDED, "lesson {number} achieved its goal");
        check_lesson(lesson, ends, pay);
        assert!(lessons[..number].iter().all(|other| other != lesson), "lesson {number} is there twice");
    }
}

#[test]
fn the_planner_docks_in_the_office_and_leaves_sound_lessons() {
    let group = only(&office_config(DOCK, ""));
    assert!(success(&group) >= 0.99, "{}", success(&group));
    check_bank(&group, DOCKED, [100.0, -10.0, 0.0]);
    for test in bounds(&group) {
        check_lesson(&test.lesson, DOCKED, [100.0, -10.0, 0.0]);
    }
    // The same config gives the same lessons, another run seed others.
    assert!(only(&office_config(DOCK, "")).shared.bank == group.shared.bank);
    let other = only(&office_config(DOCK, "seed = 7"));
    assert!(other.shared.bank != group.shared.bank && success(&other) >= 0.99);
}

#[test]
fn the_planner_passes_doors_in_the_office_too() {
    let group = only(&office_config(DOOR, ""));
    assert!(success(&group) >= 0.95, "{}", success(&group));
    check_bank(&group, PASSED_DOOR, [0.0, -10.0, 100.0]);
}

/// Number of the room that holds a pose.
fn plan_room(group: &BatchGroup, pose: Pose) -> u32 {
    let plan = &group.shared.floor.plan;
    let inside = |area: &&skilltree::layout::Area| {
        area.x0 <= pose.x && pose.x < area.x1 && area.y0 <= pose.y && pose.y < area.y1
    };
    let rooms = &plan.room[..plan.rooms as usize];
    rooms.iter().position(|area| inside(&area)).map_or(255, |room| room as u32)
}

/// Events that the readings after an action tell of: the nearest one 30 to 150 degrees to a side is 15 to 30 inches.
fn following_wall(senses: &Observation, action: u32, events: u32) -> u32 {
    let near = |rays: std::ops::RangeInclusive<usize>| {
        let nearest = senses.sonar[rays].iter().min().copied().unwrap_or(0);
        action == FORWARD && events & (COLLISION | DOCKED) == 0 && (15..=30).contains(&nearest)
    };
    (if near(2..=10) { BESIDE_LEFT } else { 0 }) | (if near(14..=22) { BESIDE_RIGHT } else { 0 })
}

/// Without noise a lesson's actions, carried out again from its start, give its events and readings.
#[test]
fn lessons_without_noise_can_be_driven_again() {
    let silent = "[robot.noise]\nactuator = 0.0\nsonar = 0.0\nlight = 0.0\ncompass = 0.0";
    for (skill, ends) in [(DOCK, DOCKED), (DOOR, PASSED_DOOR)] {
        let group = only(&office_config(&format!("{silent}\n{skill}"), ""));
        let (mut hits, mut walls) = (0, 0);
        let (mut sensed, mut robots) = (Vec::new(), Vec::new());
        for test in bounds(&group).iter().take(200) {
            let floor = &group.shared.floor;
            let sense = |step: usize| {
                let mut record = [0; BASE_WORDS];
                record.copy_from_slice(&test.lesson[LESSON_HEADER + step * BASE_WORDS..][..BASE_WORDS]);
                Observation::of(&Robot { record, ..bytemuck::Zeroable::zeroed() })
            };
            let mut pose = test.start;
            let room = |pose: Pose| plan_room(&group, pose);
            let mut origin = room(pose);
            for step in 0..test.steps() as usize {
                let word = test.lesson[LESSON_HEADER + step * BASE_WORDS + 8];
                sensed.push(sense(step));
                robots.push(robot_at(pose, &SILENT, 0, 0));
                let action = word & 0xff;
                let moved = move_body(floor, pose.x, pose.y, pose.heading, action, 1.0);
                let passed = passed_door(&floor.plan, origin, moved.x, moved.y);
                pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
                origin = if passed == 0 { origin } else { room(pose) };
                let events = moved.events | passed | following_wall(&sense(step + 1), action, moved.events);
                assert_eq!(word >> 24 & 0x7f, events, "step {step}");
                hits += u32::from(events & COLLISION != 0);
                walls += u32::from(events & (BESIDE_LEFT | BESIDE_RIGHT) != 0);
                assert_eq!(events & ends != 0, step + 1 == test.steps() as usize && test.achieved());
            }
        }
        assert!(walls > 100, "{walls} steps beside walls");
        assert!(hits < 100, "{hits} collisions in 200 lessons");
        CpuBackend::new(2, None).expect("threads").step(&group.shared, &mut robots, 1).expect("the CPU steps");
        for (then, robot) in sensed.iter().zip(&robots) {
            let now = Observation::of(robot);
            assert_eq!((then.sonar, then.light, then.compass), (now.sonar, now.light, robot.heading));
        }
    }
}
