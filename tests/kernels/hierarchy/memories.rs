//! What a robot remembers within a trial, and the doors it passes, against a recomputation in f64.

use super::super::configs::{SILENT, TREE, plan_with};
use super::super::learner::Learner;
use super::super::lessons::{Lesson, remembered};
use super::super::observations::{readings, sees_light};
use super::super::oracle::P;
use super::super::work::END;
use super::three_levels::{only_group, reach};
use bytemuck::Zeroable;
use skilltree::backend::Backend;
use skilltree::backend::cpu::cpu_backend;
use skilltree::env::motion::PASSED_DOOR;
use skilltree::layout::{Agent, ELEMENTARY_STEP_WORDS, HyperParams, Observation, STEP_WORDS, Step};
use skilltree::math::rng::Stream;
use skilltree::world::Pose;

/// The random numbers of one step of the tests' robots.
pub(super) fn stream(trial: u32, step: u32) -> Stream {
    Stream { key: [3, 4], skill: 0, trial, step, purpose: 1 }
}

/// Degrees from one direction to another, -180 to 180.
pub(super) fn apart(from: f64, to: f64) -> f64 {
    (to - from + 540.0).rem_euclid(360.0) - 180.0
}

/// The memories in a recorded step.
fn memories_of(step: &Step) -> [f32; 6] {
    [step.east_west, step.north_south, step.light_trace, step.door_trace, step.door_cosine, step.door_sine]
}

/// A walk through the door of the small world and back, and about in both rooms.
fn walk() -> Vec<u32> {
    let forward = |steps: usize| vec![4; steps];
    let turn = [2, 2, 2];
    [
        forward(6),       // from A through the door, past the far side of the frame
        turn.to_vec(),    // round, to face A again
        forward(5),       // back through it
        vec![0, 1, 3, 2], // about on the spot
        turn.to_vec(),    // towards B
        forward(3),       // into the frame
        vec![5, 5, 5],    // and out of it, backwards, without having passed
        vec![0, 0, 4, 1, 1, 4, 4, 1, 4, 0, 4, 4],
        turn.to_vec(),
        vec![4, 0, 4, 4, 1, 4, 4, 4, 3, 4, 4, 2, 4],
    ]
    .concat()
}

/// Room of the small world that holds a point, as its file has them.
fn room(at: P) -> Option<usize> {
    let inside = |b: [f64; 4]| at[0] >= b[0] && at[0] < b[2] && at[1] >= b[1] && at[1] < b[3];
    [[0.0, 0.0, 104.0, 120.0], [108.0, 0.0, 168.0, 120.0]].into_iter().position(inside)
}

/// Whether a point lies in the frame of its door, which leads through a wall at x = 104 to 108 and is 44 inches wide at
/// y = 62: a radius wider on each side, 13 inches deeper on both faces.
fn in_frame(at: P) -> bool {
    (at[0] - 106.0).abs() < 2.0 + 13.0 && (at[1] - 62.0).abs() < 22.0 + 12.0
}

/// What a robot should remember, as one would write it down.
struct Memory {
    light: f64,
    door: [f64; 3],
    means: [f64; 2],
}

impl Memory {
    fn take(&mut self, step: usize, seen: &Observation, passed: bool, params: &HyperParams) {
        let compass = f64::from(seen.compass);
        let sonar = readings(seen);
        let looking = |direction: f64| {
            let off = |ray: &usize| apart(compass + 15.0 * *ray as f64, direction).abs();
            sonar[(0..24).min_by(|a, b| off(a).total_cmp(&off(b))).expect("24 rays")]
        };
        // 254 inches of free way in both directions count 1, none -1.
        let now = [looking(0.0) + looking(180.0), looking(90.0) + looking(270.0)].map(|sum| sum / 127.0 - 1.0);
        let past = if step == 0 { 0.0 } else { f64::from(params.range_decay) };
        for (mean, now) in self.means.iter_mut().zip(now) {
            *mean = past * *mean + (1.0 - past) * now;
        }
        self.light = if sees_light(seen) { 1.0 } else { self.light * f64::from(params.light_decay) };
        let (sine, cosine) = compass.to_radians().sin_cos();
        self.door = if passed { [1.0, cosine, sine] } else { self.door.map(|d| d * f64::from(params.door_decay)) };
    }
}

#[test]
fn memories_and_doors_along_a_walk() {
    let inputs = "skill.top.inputs=['door-trace', 'range-means', 'light-trace', 'lit', 'room', 'running']";
    // The last walk is noisy, so that the compass is off and readings differ.
    let noisy = "robot.noise={ actuator = 0.02, sonar = 0.1, light = 0.1, compass = 3.0 }";
    for noise in [SILENT, noisy] {
        let traces =
            ["robot.memory={ light_decay = 0.75, door_decay = 0.875, range_decay = 0.6 }", "skill.top.applicable={}"];
        let learner = Learner::new(plan_with(TREE, &[&[noise, inputs], traces.as_slice()].concat()));
        let root = learner.skill("top");
        let (skill, params) = (&learner.shared.skills[root], &learner.params[root]);
        assert_eq!((params.light_decay, params.door_decay, params.range_decay), (0.75, 0.875, 0.6));
        let told = learner.seen(|group| {
            let root = root as u32;
            // Heading a little off, so that no reading is equally near to two directions.
            group.reset(Pose { x: 60.0, y: 62.0, heading: 0.25 });
            let mut told = Vec::new();
            for step in 0..=walk().len() {
                (group.forms.draw_step)(group, stream(9, step as u32));
                group.observe_and_score(root);
                group.write_high_level(root);
                group.encode(root, false);
                told.push((group.agent, group.record, group.inputs));
                if let Some(action) = walk().get(step) {
                    group.apply_action(root, *action);
                }
            }
            told
        });
        let mut expected = Memory { light: 0.0, door: [0.0; 3], means: [0.0; 2] };
        let (mut origin, mut crossings, mut in_between) = (room([60.0, 62.0]), Vec::new(), 0);
        for (step, (agent, record, inputs)) in told.iter().enumerate() {
            let at = [f64::from(agent.x), f64::from(agent.y)];
            let here = room(at);
            let passed = step > 0 && here.is_some() && here != origin && !in_frame(at);
            assert_eq!(agent.events & PASSED_DOOR != 0, passed, "step {step}: {at:?}");
            in_between += u32::from(here != origin && !passed);
            if passed {
                crossings.push((origin, here));
                origin = here;
            }
            expected.take(step, &record.observation, passed, params);
            let lit = sees_light(&record.observation);
            let in_room = |number: usize| f64::from(u8::from(here == Some(number)));
            let words = [
                expected.door[0],
                expected.door[1],
                expected.door[2],
                expected.means[0],
                expected.means[1],
                expected.light,
                f64::from(u8::from(lit)),
                in_room(0),
                in_room(1),
                0.0,
                0.0,
                0.0,
                0.0,
            ];
            assert_eq!(skill.inputs as usize, words.len());
            for (lane, word) in words.iter().enumerate() {
                let found = f64::from(inputs[lane]);
                assert!((found - word).abs() < 1.0e-5, "step {step}, input {lane}: {found} for {word}");
            }
        }
        println!("{crossings:?} {in_between}");
        if noise == SILENT {
            // There and back, and there once more; the walk into the frame and out again is no crossing.
            assert_eq!(crossings[..2], [(Some(0), Some(1)), (Some(1), Some(0))]);
            assert!(in_between > 3);
        }
        assert!(crossings.len() >= 3, "{crossings:?}");
    }
}

/// Readings that stay in memory are those of a record; skills without such words have none.
#[test]
fn memories_have_their_words_in_the_record() {
    let learner = Learner::new(plan_with(TREE, &[]));
    let root = learner.skill("top");
    for (number, skill) in learner.shared.skills.iter().enumerate() {
        assert_eq!(skill.record_words as usize, if number == root { STEP_WORDS } else { ELEMENTARY_STEP_WORDS });
    }
    let mut agent = Agent::zeroed();
    (agent.east_west, agent.north_south, agent.light) = (0.1, 0.2, 0.3);
    (agent.door, agent.door_cosine, agent.door_sine) = (0.4, 0.5, 0.6);
    let record = learner.seen(|group| {
        group.agent = agent;
        group.write_high_level(root as u32);
        group.record
    });
    assert_eq!(memories_of(&record), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
}

/// A skill over actions may remember too: its lessons and trials then have the words of both parts of a record.
#[test]
fn lessons_of_skills_that_remember_hold_what_they_do() {
    let set = [
        "root=door",
        "skill.door.inputs=['sonar(60)', 'door-trace', 'range-means', 'light-trace', 'room']",
        // It goes on after each door.
        "skill.door.goal=[]",
        "skill.door.lessons=4",
        "skill.door.trials=30",
        "skill.door.max_steps=40",
        "teacher.lessons=8",
        "learning.pretrain_epochs=1",
        "learning.replays=1",
        "robot.memory={ light_decay = 0.75, door_decay = 0.875, range_decay = 0.6 }",
    ];
    let plan = plan_with(TREE, &set);
    let group = only_group(&plan);
    let skill = group.shared.skills[0];
    assert_eq!((skill.record_words as usize, skill.children, skill.bank_lessons), (STEP_WORDS, 6, 8));
    let mut backend = cpu_backend(1, None).expect("threads");
    backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
    reach(&mut backend, END);
    let cohort = backend.memory().expect("memory");
    let params = &cohort.params[0];
    let stride = skill.lesson_stride as usize;
    let taught = group.shared.bank.chunks(stride).take(8);
    let taught = taught.map(|lesson| Lesson::read(lesson, skill.record_words));
    let tried = remembered(cohort, 0, 0);
    assert_eq!(tried.len(), 30);
    let (mut doors, mut lights) = (0, 0);
    for (number, lesson) in taught.chain(tried).enumerate() {
        let mut expected = Memory { light: 0.0, door: [0.0; 3], means: [0.0; 2] };
        let mut passed = false;
        assert_eq!(lesson.records.len(), 41, "lesson {number}");
        for (step, record) in lesson.records.iter().enumerate() {
            expected.take(step, &record.observation, passed, params);
            let memory = [&expected.means[..], &[expected.light], &expected.door].concat();
            for (word, expected) in memory.iter().enumerate() {
                let found = f64::from(memories_of(record)[word]);
                assert!((found - expected).abs() < 1.0e-5, "lesson {number}, step {step}, {word}: {found} {expected}");
            }
            passed = (record.choice >> 24) & PASSED_DOOR != 0;
            doors += u32::from(passed);
            lights += u32::from(expected.light > 0.0 && expected.light < 1.0);
        }
    }
    println!("{doors} {lights}");
    assert!(doors >= 5 && lights > 20, "{doors} {lights}");
}
