//! Inputs and events of skills over skills, against plain recomputations in f64 and geometry by distance fields.

use super::bench::{Bench, TREE, made_up, plan_with, random, readings, scratch_of};
use super::oracle::{P, Written, ahead, stream};
use super::trees::{DONE, only_group, reach};
use bytemuck::Zeroable;
use skilltree::backend::Backend;
use skilltree::backend::cpu::CpuBackend;
use skilltree::env::motion::{BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD, PASSED_DOOR};
use skilltree::env::observe::observe;
use skilltree::env::workgroup::{CohortData, Scratch};
use skilltree::layout::{Agent, BASE_WORDS, HyperParams, LESSON_HEADER, MEMORY_WORD, RECORD_WORDS};
use skilltree::math::rng::{StepRandom, Stream, draw_step};
use skilltree::policy::features::encode;
use skilltree::policy::hierarchy::{execute, place, sense};
use skilltree::policy::persistence::extend;
use skilltree::train::observation::floor_only;
use skilltree::world::Pose;

const SILENT: &str = "robot.noise={ actuator = 0.0, sonar = 0.0, light = 0.0, compass = 0.0 }";

fn draws_of(trial: u32, step: u32) -> StepRandom {
    draw_step(Stream { key: [3, 4], skill: 0, trial, step, purpose: 1 })
}

/// Degrees from one direction to another, -180 to 180.
fn apart(from: f64, to: f64) -> f64 {
    (to - from + 540.0).rem_euclid(360.0) - 180.0
}

// The sonar by the compass.

/// A root that sees nothing but the sonar turned by the compass.
fn turned_sonar() -> (Bench, usize) {
    let bench = Bench::new(TREE, &[SILENT, "skill.top.inputs=['sonar-compass(40)']", "skill.top.applicable={}"]);
    let root = bench.skill("top");
    (bench, root)
}

/// What a reading is coded as.
fn coded(reading: f64) -> f64 {
    2.0 * (-(reading - 12.0) / 40.0).exp() - 1.0
}

#[test]
fn turning_in_place_by_steps_of_the_sonar_changes_nothing() {
    let (bench, root) = turned_sonar();
    let room = Written { walls: vec![[150.0, 20.0, 110.0, 90.0]], ..Written::room(190.0, 130.0) };
    let (shared, field) = (floor_only(&room.world()), room.field());
    let (mut next, mut poses, mut spread) = (stream(31), 0, 0.0_f32);
    let terms = skilltree::layout::Noise { kind: 0, actuator: 0.0, sonar: 0.0, light: 0.0, compass: 0.0 };
    while poses < 150 {
        let at = [next() * 190.0, next() * 130.0];
        let lean = (next() * 15.0) as f32;
        // Another rounding of the ray's direction must not give another inch.
        let edge = |ray: usize| (field.ray(at, f64::from(lean) + 15.0 * ray as f64, 127.0) - 0.5).rem_euclid(1.0);
        if !field.free(at, 12.0) || (0..24).any(|ray| !(0.01..0.99).contains(&edge(ray))) {
            continue;
        }
        poses += 1;
        let look = |heading: f32| {
            let mut scratch = scratch_of(&[]);
            observe(&shared, &mut scratch.record, &draws_of(0, 0), at[0] as f32, at[1] as f32, heading, 0, terms);
            encode(&bench.shared, &mut scratch, &bench.shared.skills[root], false);
            scratch
        };
        let first = look(lean);
        let moved: Vec<Scratch> = (1..24).map(|steps| look(lean + 15.0 * steps as f32)).collect();
        for (steps, scratch) in moved.iter().enumerate() {
            assert!(scratch.record[..6] != first.record[..6], "the robot has turned");
            for lane in 0..24 {
                let gap = (scratch.inputs[lane] - first.inputs[lane]).abs();
                assert!(gap < 1.0e-5, "{at:?} {lean} turned {} times, bearing {lane}: {gap}", steps + 1);
            }
        }
        spread = spread.max(first.inputs[..24].iter().fold(0.0, |most, x| x.max(most)));
    }
    assert!(spread > 0.7, "{spread}");
}

/// The value of a direction lies between those of the two rays beside it, in the share of the angle.
#[test]
fn directions_between_rays_are_interpolated() {
    let (bench, root) = turned_sonar();
    let mut next = random(32);
    for round in 0..500 {
        let mut record = made_up(&mut next);
        // Whole steps too, and both ends of the compass.
        let compass = match round {
            0..24 => round as f32 * 15.0,
            24 => 359.999_97,
            25 => 1.0e-20,
            _ => f32::from_bits(record[7]),
        };
        record[7] = compass.to_bits();
        let mut scratch = scratch_of(&record);
        encode(&bench.shared, &mut scratch, &bench.shared.skills[root], false);
        let sonar = readings(&record);
        for bearing in 0..24 {
            let direction = 15.0 * f64::from(bearing);
            let share = |ray: usize| {
                let off = apart(direction, f64::from(compass) + 15.0 * ray as f64).abs();
                (1.0 - off / 15.0).max(0.0)
            };
            let expected: f64 = (0..24).map(|ray| share(ray) * coded(sonar[ray])).sum();
            let found = f64::from(scratch.inputs[bearing as usize]);
            assert!((found - expected).abs() < 2.0e-5, "compass {compass}, bearing {bearing}: {found} for {expected}");
        }
    }
}

// Memories and doors.

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
    fn take(&mut self, step: usize, record: &[u32], passed: bool, params: &HyperParams) {
        let compass = f64::from(f32::from_bits(record[7]));
        let sonar = readings(record);
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
        self.light = if record[6] & 0xff_ffff != 0 { 1.0 } else { self.light * f64::from(params.light_decay) };
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
        let bench = Bench::new(TREE, &[&[noise, inputs], traces.as_slice()].concat());
        let root = bench.skill("top");
        let (skill, params) = (&bench.shared.skills[root], &bench.params[root]);
        assert_eq!((params.light_decay, params.door_decay, params.range_decay), (0.75, 0.875, 0.6));
        let (mut agent, mut scratch) = (Agent::zeroed(), Scratch::default());
        // Heading a little off, so that no reading is equally near to two directions.
        place(&mut agent, &bench.shared, Pose { x: 60.0, y: 62.0, heading: 0.25 });
        let mut expected = Memory { light: 0.0, door: [0.0; 3], means: [0.0; 2] };
        let (mut origin, mut crossings, mut in_between) = (room([60.0, 62.0]), Vec::new(), 0);
        for step in 0..=walk().len() {
            sense(&mut agent, &bench.shared, &mut scratch, params, &draws_of(9, step as u32));
            let at = [f64::from(agent.x), f64::from(agent.y)];
            let here = room(at);
            let passed = step > 0 && here.is_some() && here != origin && !in_frame(at);
            assert_eq!(agent.events & PASSED_DOOR != 0, passed, "step {step}: {at:?}");
            in_between += u32::from(here != origin && !passed);
            if passed {
                crossings.push((origin, here));
                origin = here;
            }
            expected.take(step, &scratch.record, passed, params);
            extend(&agent, &bench.shared.floor.plan, &mut scratch, skill, params, root as u32);
            encode(&bench.shared, &mut scratch, skill, false);
            let lit = scratch.record[6] & 0xff_ffff != 0;
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
                let found = f64::from(scratch.inputs[lane]);
                assert!((found - word).abs() < 1.0e-5, "step {step}, input {lane}: {found} for {word}");
            }
            if let Some(action) = walk().get(step) {
                execute(&mut agent, &bench.shared, params, *action, &draws_of(9, step as u32));
            }
        }
        println!("{crossings:?} {in_between} {}", agent.collisions);
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
    let bench = Bench::new(TREE, &[]);
    let root = bench.skill("top");
    for (number, skill) in bench.shared.skills.iter().enumerate() {
        assert_eq!(skill.record_words as usize, if number == root { RECORD_WORDS } else { BASE_WORDS });
    }
    let mut agent = Agent::zeroed();
    (agent.east_west, agent.north_south, agent.light) = (0.1, 0.2, 0.3);
    (agent.door, agent.door_cosine, agent.door_sine) = (0.4, 0.5, 0.6);
    let mut scratch = Scratch::default();
    let (plan, params) = (&bench.shared.skills[root], &bench.params[root]);
    extend(&agent, &bench.shared.floor.plan, &mut scratch, plan, params, root as u32);
    let words: Vec<f32> = scratch.record[MEMORY_WORD..MEMORY_WORD + 6].iter().map(|w| f32::from_bits(*w)).collect();
    assert_eq!(words, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
}

// Walls beside the robot.

/// Drives one step and looks; the events.
fn drive(shared: &CohortData, params: &HyperParams, pose: Pose, action: u32) -> (Agent, u32) {
    let (mut agent, mut scratch) = (Agent::zeroed(), Scratch::default());
    place(&mut agent, shared, pose);
    sense(&mut agent, shared, &mut scratch, params, &draws_of(0, 0));
    assert_eq!(agent.events, 0, "nothing has happened yet");
    execute(&mut agent, shared, params, action, &draws_of(0, 0));
    sense(&mut agent, shared, &mut scratch, params, &draws_of(0, 1));
    (agent, agent.events)
}

#[test]
fn walls_at_known_distances_are_beside_the_robot() {
    let bench = Bench::new(TREE, &[SILENT]);
    let params = &bench.params[0];
    assert_eq!((params.beside_near, params.beside_far), (15, 30));
    let shared = floor_only(&Written::room(400.0, 400.0).world());
    for tenths in 121..400_u16 {
        let distance = f64::from(tenths) / 10.0;
        // Whole inches: from 14.5 to below 30.5. Halves are left out.
        if (distance - 0.5).fract() == 0.0 {
            continue;
        }
        let expected = (14.5..30.5).contains(&distance);
        // East along the south wall, which is on the right, and west along it.
        let there = |heading: f32| Pose { x: 200.0, y: distance as f32, heading };
        let (_, events) = drive(&shared, params, there(0.0), FORWARD);
        assert_eq!(events, if expected { BESIDE_RIGHT } else { 0 }, "{distance}");
        let (_, events) = drive(&shared, params, there(180.0), FORWARD);
        assert_eq!(events, if expected { BESIDE_LEFT } else { 0 }, "{distance}");
        // Backing up or turning is not following.
        for action in [0, 1, 2, 3, 5] {
            assert_eq!(drive(&shared, params, there(0.0), action).1, 0, "{distance}, action {action}");
        }
        // Nor is pushing against the wall ahead.
        let corner = Pose { x: 386.0, y: distance as f32, heading: 0.0 };
        assert_eq!(drive(&shared, params, corner, FORWARD).1, COLLISION, "{distance}");
    }
}

#[test]
fn events_beside_walls_are_those_of_the_geometry() {
    let written = Written {
        walls: vec![[60.0, 90.0, 110.0, 120.0], [170.0, 20.0, 185.0, 80.0]],
        boxes: vec![[70.0, 0.0, 84.0, 45.0], [130.0, 100.0, 160.0, 118.0]],
        charger: Some([0.0, 50.0, 24.0, 74.0]),
        ..Written::room(220.0, 160.0)
    };
    let band = ["robot.beside={ near = 18.0, far = 25.0 }", SILENT];
    for (set, near, far) in [(&band[1..], 15.0, 30.0), (&band[..], 18.0, 25.0)] {
        let bench = Bench::new(TREE, set);
        let params = &bench.params[0];
        let (shared, field) = (floor_only(&written.world()), written.field());
        let (mut next, mut counts, mut docked) = (stream(33), [0; 4], 0);
        for _ in 0..6000 {
            let at = [next() * 220.0, next() * 160.0];
            let pose = Pose { x: at[0] as f32, y: at[1] as f32, heading: (next() * 360.0) as f32 };
            if !field.free(at, 12.01) {
                continue;
            }
            let (agent, events) = drive(&shared, params, pose, FORWARD);
            let (end, heading) = ([f64::from(agent.x), f64::from(agent.y)], f64::from(agent.heading));
            let went = ahead(at, heading, 12.0);
            let short = (went[0] - end[0]).hypot(went[1] - end[1]);
            let blocked = short > 1.0e-3;
            let ranges: Vec<f64> = (0..24).map(|ray| field.ray(end, heading + 15.0 * f64::from(ray), 127.0)).collect();
            // 30 to 150 degrees to each side; all that rounds to whole inches in the band.
            let nearest = |degrees: std::ops::RangeInclusive<i32>| {
                degrees.step_by(15).map(|d| ranges[(d / 15) as usize]).fold(f64::INFINITY, f64::min)
            };
            let (left, right) = (nearest(30..=150), nearest(210..=330));
            let unclear = |range: f64| (range - near + 0.5).abs() < 0.01 || (range - far - 0.5).abs() < 0.01;
            if unclear(left) || unclear(right) || (!blocked && short > 1.0e-4) {
                continue;
            }
            let beside = |range: f64| !blocked && (near - 0.5..far + 0.5).contains(&range);
            assert_eq!(events & BESIDE_LEFT != 0, beside(left), "{pose:?} {left}");
            assert_eq!(events & BESIDE_RIGHT != 0, beside(right), "{pose:?} {right}");
            counts[usize::from(beside(left)) + 2 * usize::from(beside(right))] += 1;
            docked += u32::from(events & DOCKED != 0);
            assert_eq!(events & (COLLISION | DOCKED) != 0, blocked, "{pose:?}");
        }
        println!("{counts:?} {docked}");
        assert!(counts.iter().all(|count| *count > 60) && docked > 5, "{counts:?} {docked}");
    }
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
    assert_eq!((skill.record_words as usize, skill.children, skill.bank_lessons), (RECORD_WORDS, 6, 8));
    let mut backend = CpuBackend::new(1, None).expect("threads");
    backend.load(group.cohort(&plan, &group.learners(&plan))).expect("memory");
    reach(&mut backend, DONE);
    let cohort = backend.memory().expect("memory");
    let params = &cohort.params[0];
    let stride = skill.lesson_stride as usize;
    let taught = group.shared.bank.chunks(stride).take(8);
    let tried = cohort.lessons[skill.memory_offset as usize..].chunks(stride).take(30);
    let (mut doors, mut lights) = (0, 0);
    for (number, lesson) in taught.chain(tried).enumerate() {
        let mut expected = Memory { light: 0.0, door: [0.0; 3], means: [0.0; 2] };
        let mut passed = false;
        assert_eq!(lesson[0], 40, "lesson {number}");
        for (step, record) in lesson[LESSON_HEADER..].chunks(RECORD_WORDS).take(41).enumerate() {
            expected.take(step, record, passed, params);
            let memory = [&expected.means[..], &[expected.light], &expected.door].concat();
            for (word, expected) in memory.iter().enumerate() {
                let found = f64::from(f32::from_bits(record[MEMORY_WORD + word]));
                assert!((found - expected).abs() < 1.0e-5, "lesson {number}, step {step}, {word}: {found} {expected}");
            }
            passed = (record[8] >> 24) & PASSED_DOOR != 0;
            doors += u32::from(passed);
            lights += u32::from(expected.light > 0.0 && expected.light < 1.0);
        }
    }
    println!("{doors} {lights}");
    assert!(doors >= 5 && lights > 20, "{doors} {lights}");
}
