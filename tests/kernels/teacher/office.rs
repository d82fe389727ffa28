//! The planner's success in the office, for two skills, and the lessons that it leaves.

use super::super::configs::{file, written};
use super::super::learner::seen;
use super::super::lessons::Lesson;
use skilltree::backend::Backend;
use skilltree::backend::cpu::cpu_backend;
use skilltree::config::plan::Plan;
use skilltree::env::motion::{ACTED, BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, LIT, PASSED_DOOR};
use skilltree::layout::{Area, ELEMENTARY_STEP_WORDS, LESSON_HEADER_WORDS, NO_CHILD, Robot, Step, TERMINATED};
use skilltree::teacher::demonstrations::Demonstration;
use skilltree::train::batch_group::{BatchGroup, groups};
use skilltree::train::observation::{SILENT, SensorValues, robot_at};
use skilltree::world::Pose;

/// A lesson of a skill over actions.
fn read(words: &[u32]) -> Lesson {
    Lesson::read(words, ELEMENTARY_STEP_WORDS as u32)
}

fn office_config(skill: &str, extra: &str) -> Plan {
    let office = file("configs/worlds/office.toml");
    let text = format!(
        "title = \"teacher\"\nworld = {office:?}\nseeds = \"0\"\n{extra}\n[evaluate]\nat = []\nepisodes = 1\n\
         [teacher]\nlessons = 100\neval_episodes = 1000\n{skill}\n[arm.only]\n"
    );
    written(&text, &[])
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
fn check_lesson(words: &[u32], ends: u32, pay: [f32; 3]) {
    let lesson = read(words);
    // Every choice is a free one among all six actions.
    let open = 0x3f << 8 | 0x3f << 16 | 1 << 31;
    let (mut reward, mut collisions) = (0.0, 0);
    for (number, Step { choice: word, reward: earned, .. }) in (1..).zip(lesson.steps()) {
        let events = word >> 24 & 0x7f;
        assert!(word & 0xff < 6 && word & !(events << 24) & !0xff == open, "{word:x}");
        let due: f32 = (0..3).filter(|event| events >> event & 1 == 1).map(|event| pay[event]).sum();
        assert_eq!(*earned, due);
        reward += earned;
        collisions += events >> 1 & 1;
        let last = number == lesson.header.steps && lesson.header.end == TERMINATED;
        assert_eq!(events & ends != 0, last, "step {number} of {}", lesson.header.steps);
    }
    assert_eq!((lesson.header.reward, lesson.header.collisions), (reward, collisions));
    let last = lesson.records.last().expect("an observation closes the lesson");
    assert_eq!((last.choice, last.reward), (NO_CHILD | open, 0.0), "no action after the last observation");
    let used = LESSON_HEADER_WORDS + lesson.records.len() * ELEMENTARY_STEP_WORDS;
    assert!(words[used..].iter().all(|word| *word == 0));
}

fn check_bank(group: &BatchGroup, ends: u32, pay: [f32; 3]) {
    let skill = &group.shared.skills[0];
    assert_eq!((skill.bank_offset, skill.bank_lessons), (0, 100));
    let lessons: Vec<&[u32]> = group.shared.bank.chunks(skill.lesson_stride as usize).collect();
    assert_eq!(lessons.len(), 100);
    for (number, lesson) in lessons.iter().enumerate() {
        assert_eq!(read(lesson).header.end, TERMINATED, "lesson {number} achieved its goal");
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
    let inside = |area: &Area| area.x0 <= pose.x && pose.x < area.x1 && area.y0 <= pose.y && pose.y < area.y1;
    let rooms = &plan.room[..plan.rooms as usize];
    rooms.iter().position(inside).map_or(255, |room| room as u32)
}

/// Events that the readings after an action tell of: the nearest one 30 to 150 degrees to a side is 15 to 30 inches.
fn following_wall(senses: &SensorValues, action: u32, events: u32) -> u32 {
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
            let plan = &group.shared.floor.plan;
            let lesson = read(&test.lesson);
            let sense = |step: usize| {
                SensorValues::of(&Robot { sensed: lesson.records[step].observation, ..bytemuck::Zeroable::zeroed() })
            };
            let mut pose = test.start;
            let room = |pose: Pose| plan_room(&group, pose);
            let mut origin = room(pose);
            for step in 0..test.steps() as usize {
                let word = lesson.records[step].choice;
                sensed.push(sense(step));
                robots.push(robot_at(pose, &SILENT, 0, 0));
                let action = word & 0xff;
                let moved = seen(&group.shared, &[], &[], |robot| {
                    (robot.forms.move_body)(robot, pose.x, pose.y, pose.heading, action, 1.0)
                });
                let passed = plan.passed_door(origin, moved.x, moved.y);
                pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
                origin = if passed == 0 { origin } else { room(pose) };
                let after = sense(step + 1);
                let lit = if after.light.contains(&1) { LIT } else { 0 };
                let events = ACTED | lit | moved.events | passed | following_wall(&after, action, moved.events);
                assert_eq!(word >> 24 & 0x7f, events, "step {step}");
                hits += u32::from(events & COLLISION != 0);
                walls += u32::from(events & (BESIDE_LEFT | BESIDE_RIGHT) != 0);
                assert_eq!(events & ends != 0, step + 1 == test.steps() as usize && test.achieved());
            }
        }
        assert!(walls > 100, "{walls} steps beside walls");
        assert!(hits < 100, "{hits} collisions in 200 lessons");
        cpu_backend(2, None).expect("threads").step(&group.shared, &mut robots, 1).expect("the CPU steps");
        for (then, robot) in sensed.iter().zip(&robots) {
            let now = SensorValues::of(robot);
            assert_eq!((then.sonar, then.light, then.compass), (now.sonar, now.light, robot.heading));
        }
    }
}
