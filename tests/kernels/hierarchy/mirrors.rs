//! Left and right exchanged: lessons seen in a mirror, and skills that are the mirror image of another one.

use super::super::configs::{SILENT, TREE, plan_with};
use super::super::learner::{Learner, lesson_words, seen};
use super::super::observations::{made_up, reflected, sees_light};
use super::super::oracle::Written;
use super::super::random::random;
use bytemuck::Zeroable;
use skilltree::config::plan::Event;
use skilltree::env::motion::{ACTED, COLLISION, FORWARD, LIT};
use skilltree::env::segments::SegmentGrid;
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{NO_CHILD, Step, TERMINATED, TRUNCATED};
use skilltree::math::rng::Stream;
use skilltree::train::allocate::Shape;
use skilltree::world::{Pose, World};

/// No noise, and skills whose children stand in no tidy order.
const SET: [&str; 5] = [
    SILENT,
    "skill.dock.children=['move+12', 'turn-60', 'turn+15', 'move-12', 'turn+60', 'turn-15']",
    "skill.right.children=['turn-60', 'move+12', 'turn+15']",
    "skill.dock.learning.mirror_replays=true",
    "skill.top.applicable={}",
];

/// What one replay leaves of the nets.
fn replayed(learner: &Learner, lesson: &[u32], mirrored: u32, mirror_replays: u32) -> (Vec<u32>, u32) {
    let number = learner.skill("dock");
    let mut own = learner.clone();
    own.state.skill = number as u32;
    own.params[number].mirror_replays = mirror_replays;
    own.lessons = lesson.to_vec();
    own.act(|group| {
        group.begin_replay(0, 0, mirrored);
        while group.state.replay_left > 0 || group.state.replay_open == 1 {
            group.replay_step();
        }
    });
    (own.nets.iter().map(|w| w.to_bits()).collect(), own.state.updates)
}

#[test]
fn a_lesson_seen_in_a_mirror_teaches_what_the_mirrored_lesson_does() {
    let more = ["skill.dock.learning.timeout_terminal=false", "skill.dock.learning.inverse_temperature_start=4.0"];
    let learner = Learner::new(plan_with(TREE, &[SET.as_slice(), &more].concat()));
    let skill = learner.shared.skills[learner.skill("dock")];
    // Positions of the actions that a mirror exchanges: turns of one size.
    let image = [0, 4, 5, 3, 1, 2];
    let mut next = random(7);
    let (mut updates, mut differing) = (0, 0);
    for round in 0..60 {
        let steps = 5 + (next() * 6.0) as usize;
        let end = if round % 2 == 0 { TERMINATED } else { TRUNCATED };
        let (mut plain, mut turned) = (Vec::new(), Vec::new());
        for step in 0..=steps {
            let made = made_up(&mut next);
            let blocked = if next() < 0.3 { Some((next() * 6.0) as u32) } else { None };
            let allowed = blocked.map_or(0x3f, |child| 0x3f & !(1 << child));
            let child = (0..6).cycle().skip((next() * 6.0) as usize).find(|c| allowed >> c & 1 == 1).expect("a child");
            let reward = if next() < 0.4 { (next() * 200.0 - 100.0) as f32 } else { 0.0 };
            let mirror = |bits: u32| (0..6).filter(|c| bits >> c & 1 == 1).fold(0, |out, c| out | 1 << image[c]);
            let word = |child: u32, allowed: u32| child | allowed << 8 | allowed << 16 | 1 << 31;
            let closes = step == steps;
            let (child, other) = if closes { (NO_CHILD, NO_CHILD) } else { (child, image[child as usize]) };
            let reward = if closes { 0.0 } else { reward };
            let blank = Step { reward, ..Step::zeroed() };
            plain.push(Step { observation: made, choice: word(child, allowed), ..blank });
            turned.push(Step { observation: reflected(&made), choice: word(other, mirror(allowed)), ..blank });
        }
        let [plain, turned] = [plain, turned].map(|records| lesson_words(&skill, end, &records));
        let (seen, learned) = replayed(&learner, &plain, 1, 1);
        assert!((seen, learned) == replayed(&learner, &turned, 0, 1), "round {round}");
        // Twice in a mirror is not at all, and without the key there is none.
        let (straight, learned) = replayed(&learner, &plain, 0, 1);
        assert!((straight.clone(), learned) == replayed(&learner, &turned, 1, 1), "round {round}: back again");
        assert!((straight.clone(), learned) == replayed(&learner, &plain, 1, 0), "round {round}: switched off");
        updates += learned;
        differing += u32::from(straight != replayed(&learner, &plain, 1, 1).0);
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

fn shared_in(learner: &Learner, world: &World) -> CohortData {
    let shape = Shape::new(world, &[&learner.plan.arms[0]]).expect("the skills fit");
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
    let learner = Learner::new(plan_with(&text, &set));
    let (plain, mirror) = (crooked(), mirrored(&crooked()));
    let (left, right) = (shared_in(&learner, &plain.world()), shared_in(&learner, &mirror.world()));
    let field = plain.field();
    let stream = Stream { key: [1, 2], skill: 0, trial: 0, step: 0, purpose: 1 };
    let mut next = random(21);
    let (mut compared, mut skipped, mut lit, mut touching, mut beside) = (0, 0, 0, 0, [0, 0]);
    for (source, image) in [("dock", "kcod"), ("right", "left")] {
        let (source, image) = (learner.skill(source), learner.skill(image));
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
                let skill = skill as u32;
                seen(shared, &learner.params, &learner.nets, |group| {
                    group.reset(pose);
                    (group.forms.draw_step)(group, stream);
                    group.observe_and_score(skill);
                    group.apply_action(skill, FORWARD);
                    group.observe_and_score(skill);
                    group.q_values(skill);
                    (group.agent, group.record.observation, group.q)
                })
            };
            let (here, seen, q) = look(&left, pose, source);
            let (there, turned, other_q) = look(&right, other, image);
            // Coordinates differ in their last places, so a reading may be rounded to another inch.
            let image_of = reflected(&seen);
            if (image_of.sonar, image_of.light_bumpers) != (turned.sonar, turned.light_bumpers) {
                skipped += 1;
                continue;
            }
            compared += 1;
            assert_eq!(q.map(f32::to_bits), other_q.map(f32::to_bits), "{pose:?}");
            assert_eq!(here.earned, there.earned, "{pose:?}");
            let swapped = here.events & (7 | LIT | ACTED) | (here.events >> 3 & 1) << 4 | (here.events >> 4 & 1) << 3;
            assert_eq!(swapped, there.events, "{pose:?}");
            lit += u32::from(sees_light(&seen));
            touching += u32::from(here.events & COLLISION != 0 && seen.light_bumpers >> 24 & 0xa != 0);
            for (side, event) in [Event::BesideRight, Event::BesideLeft].into_iter().enumerate() {
                beside[side] += u32::from(here.events & event.bit() != 0);
            }
        }
    }
    println!("{compared} {skipped} {lit} {touching} {beside:?}");
    assert!(compared > 2900 && lit > 300 && touching > 20 && beside.iter().all(|count| *count > 100));
}
