//! Left and right exchanged: lessons seen in a mirror, and skills that are the mirror image of another one.

use super::bench::{Bench, TREE, made_up, random, reflected};
use super::oracle::{Written, stream};
use bytemuck::Zeroable;
use skilltree::config::plan::Event;
use skilltree::env::motion::{COLLISION, FORWARD};
use skilltree::env::segments::SegmentGrid;
use skilltree::env::workgroup::{CohortData, Scratch};
use skilltree::layout::Agent;
use skilltree::learn::lesson::{CUT, ENDED};
use skilltree::learn::td_lambda::{begin_replay, replay_step};
use skilltree::math::rng::{Stream, draw_step};
use skilltree::policy::hierarchy::{execute, place, sense, think};
use skilltree::train::allocate::Shape;
use skilltree::world::{Pose, World};

/// No noise, and skills whose children stand in no tidy order.
const SET: [&str; 5] = [
    "robot.noise={ actuator = 0.0, sonar = 0.0, light = 0.0, compass = 0.0 }",
    "skill.dock.children=['move+12', 'turn-60', 'turn+15', 'move-12', 'turn+60', 'turn-15']",
    "skill.right.children=['turn-60', 'move+12', 'turn+15']",
    "skill.dock.learning.mirror_replays=true",
    "skill.top.applicable={}",
];

/// What one replay leaves of the nets.
fn replayed(bench: &Bench, lesson: &[u32], mirrored: u32, mirror_replays: u32) -> (Vec<u32>, u32) {
    let number = bench.skill("dock");
    let mut nets = bench.nets.clone();
    let mut state = bench.state;
    state.skill = number as u32;
    let mut params = bench.params.clone();
    params[number].mirror_replays = mirror_replays;
    let mut lessons = lesson.to_vec();
    let mut learner = skilltree::env::workgroup::Learner {
        shared: &bench.shared,
        params: &params,
        state: &mut state,
        nets: &mut nets,
        lessons: &mut lessons,
        rows: &mut [],
    };
    let mut scratch = Scratch::default();
    begin_replay(&mut learner, 0, 0, mirrored);
    while learner.state.replay_left > 0 || learner.state.replay_open == 1 {
        replay_step(&mut learner, &mut scratch, 0);
    }
    let updates = state.updates;
    (nets.iter().map(|w| w.to_bits()).collect(), updates)
}

#[test]
fn a_lesson_seen_in_a_mirror_teaches_what_the_mirrored_lesson_does() {
    let more = ["skill.dock.learning.timeout_terminal=false", "skill.dock.learning.inverse_temperature_start=4.0"];
    let bench = Bench::new(TREE, &[SET.as_slice(), &more].concat());
    // Positions of the actions that a mirror exchanges: turns of one size.
    let image = [0, 4, 5, 3, 1, 2];
    let mut next = random(7);
    let (mut updates, mut differing) = (0, 0);
    for round in 0..60 {
        let steps = 5 + (next() * 6.0) as usize;
        let end = if round % 2 == 0 { ENDED } else { CUT };
        let mut plain = vec![steps as u32, end, 0, 0];
        let mut turned = plain.clone();
        for step in 0..=steps {
            let mut record = made_up(&mut next);
            let blocked = if next() < 0.3 { Some((next() * 6.0) as u32) } else { None };
            let allowed = blocked.map_or(0x3f, |child| 0x3f & !(1 << child));
            let child = (0..6).cycle().skip((next() * 6.0) as usize).find(|c| allowed >> c & 1 == 1).expect("a child");
            record[9] = (if next() < 0.4 { (next() * 200.0 - 100.0) as f32 } else { 0.0 }).to_bits();
            let mirror = |bits: u32| (0..6).filter(|c| bits >> c & 1 == 1).fold(0, |out, c| out | 1 << image[c]);
            let word = |child: u32, allowed: u32| child | allowed << 8 | allowed << 16 | 1 << 31;
            let mut other = reflected(&record);
            if step == steps {
                (record[8], other[8]) = (word(255, allowed), word(255, mirror(allowed)));
                (record[9], other[9]) = (0, 0);
            } else {
                (record[8], other[8]) = (word(child, allowed), word(image[child as usize] as u32, mirror(allowed)));
            }
            plain.extend(record);
            turned.extend(other);
        }
        let (seen, learned) = replayed(&bench, &plain, 1, 1);
        assert!((seen, learned) == replayed(&bench, &turned, 0, 1), "round {round}");
        // Twice in a mirror is not at all, and without the key there is none.
        let (straight, learned) = replayed(&bench, &plain, 0, 1);
        assert!((straight.clone(), learned) == replayed(&bench, &turned, 1, 1), "round {round}: back again");
        assert!((straight.clone(), learned) == replayed(&bench, &plain, 1, 0), "round {round}: switched off");
        updates += learned;
        differing += u32::from(straight != replayed(&bench, &plain, 1, 1).0);
    }
    assert!(updates > 200 && differing == 60, "{updates} {differing}");
}

/// A floor plan with no symmetry at all.
fn crooked() -> Written {
    Written {
        walls: vec![[60.0, 90.0, 110.0, 120.0], [170.0, 20.0, 185.0, 80.0]],
        boxes: vec![[70.0, 0.0, 84.0, 45.0], [130.0, 100.0, 160.0, 118.0]],
        charger: Some([0.0, 50.0, 24.0, 74.0]),
        light: Some(([12.0, 62.0], 130.0)),
        ..Written::room(220.0, 160.0)
    }
}

/// The floor plan in a mirror that stands upright at x = 110.
fn mirrored(plan: &Written) -> Written {
    let swap = |b: &[f64; 4]| [220.0 - b[2], b[1], 220.0 - b[0], b[3]];
    Written {
        size: plan.size,
        walls: plan.walls.iter().map(|w| [220.0 - w[0], w[1], 220.0 - w[2], w[3]]).collect(),
        boxes: plan.boxes.iter().map(swap).collect(),
        charger: plan.charger.as_ref().map(swap),
        light: plan.light.map(|([x, y], range)| ([220.0 - x, y], range)),
    }
}

fn shared_in(bench: &Bench, world: &World) -> CohortData {
    let shape = Shape::new(world, &[&bench.plan.arms[0]]).expect("the skills fit");
    CohortData {
        floor: SegmentGrid::new(&shape.tables.plan, &shape.tables.words),
        skills: shape.skills,
        tables: shape.tables.words,
        bank: vec![0],
    }
}

#[test]
fn mirrored_skills_do_in_a_mirrored_world_what_theirs_do() {
    let text = format!("{TREE}\n[skill.kcod]\nmirror = \"dock\"");
    let set = [SET.as_slice(), &["skill.top.children=['dock', 'kcod', 'right', 'left']"]].concat();
    let bench = Bench::new(&text, &set);
    let (plain, mirror) = (crooked(), mirrored(&crooked()));
    let (left, right) = (shared_in(&bench, &plain.world()), shared_in(&bench, &mirror.world()));
    let field = plain.field();
    let random = draw_step(Stream { key: [1, 2], skill: 0, trial: 0, step: 0, purpose: 1 });
    let mut next = stream(21);
    let (mut compared, mut skipped, mut lit, mut touching, mut beside) = (0, 0, 0, 0, [0, 0]);
    for (source, image) in [("dock", "kcod"), ("right", "left")] {
        let (source, image) = (bench.skill(source), bench.skill(image));
        assert_eq!(left.skills[source].nets_offset, left.skills[image].nets_offset, "one set of nets");
        // Children of the image are those of its source with turns the other way.
        let children = |skill: usize| left.skills[skill].child[..left.skills[skill].children as usize].to_vec();
        let turned: Vec<u32> = children(source).iter().map(|code| [1, 0, 3, 2, 4, 5][*code as usize]).collect();
        assert_eq!(children(image), turned);
        let mut poses = 0;
        while poses < 1500 {
            let at = [next() * 220.0, next() * 160.0];
            if !field.free(at, 12.01) {
                continue;
            }
            poses += 1;
            let heading = (next() * 360.0) as f32;
            let pose = Pose { x: at[0] as f32, y: at[1] as f32, heading };
            let other = Pose { x: 220.0 - pose.x, y: pose.y, heading: (540.0 - heading) % 360.0 };
            let look = |shared: &CohortData, pose: Pose, skill: usize| {
                let params = &bench.params[skill];
                let (mut agent, mut scratch) = (Agent::zeroed(), Scratch::default());
                place(&mut agent, shared, pose);
                sense(&mut agent, shared, &mut scratch, params, &random);
                execute(&mut agent, shared, params, FORWARD, &random);
                sense(&mut agent, shared, &mut scratch, params, &random);
                think(&agent, shared, &mut scratch, &bench.params, &bench.nets, 0, skill as u32);
                (agent, scratch)
            };
            let (here, seen) = look(&left, pose, source);
            let (there, turned) = look(&right, other, image);
            // Coordinates differ in their last places, so a reading may be rounded to another inch.
            if reflected(&seen.record)[..7] != turned.record[..7] {
                skipped += 1;
                continue;
            }
            compared += 1;
            let q = |scratch: &Scratch| scratch.q.map(f32::to_bits);
            assert_eq!(q(&seen), q(&turned), "{pose:?}");
            assert_eq!(here.earned, there.earned, "{pose:?}");
            let swapped = here.events & 7 | (here.events >> 3 & 1) << 4 | (here.events >> 4 & 1) << 3;
            assert_eq!(swapped, there.events, "{pose:?}");
            lit += u32::from(seen.record[6] & 0xff_ffff != 0);
            touching += u32::from(here.events & COLLISION != 0 && seen.record[6] >> 24 & 0xa != 0);
            for (side, event) in [Event::BesideRight, Event::BesideLeft].into_iter().enumerate() {
                beside[side] += u32::from(here.events & event.bit() != 0);
            }
        }
    }
    println!("{compared} {skipped} {lit} {touching} {beside:?}");
    assert!(compared > 2900 && lit > 300 && touching > 20 && beside.iter().all(|count| *count > 100));
}
