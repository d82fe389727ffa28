//! The sonar turned by the compass, against a recomputation in f64.

use super::super::configs::{SILENT, TREE, plan_with};
use super::super::learner::{Learner, seen};
use super::super::observations::{made_up, readings};
use super::super::oracle::Written;
use super::super::random::random;
use super::memories::apart;
use skilltree::layout::{MAX_INPUTS, Noise, Observation};
use skilltree::train::observation::floor_only;

/// A root that sees nothing but the sonar turned by the compass.
fn turned_sonar() -> (Learner, u32) {
    let set = [SILENT, "skill.top.inputs=['sonar-compass(40)']", "skill.top.applicable={}"];
    let learner = Learner::new(plan_with(TREE, &set));
    let root = learner.skill("top") as u32;
    (learner, root)
}

/// What a reading is coded as.
fn coded(reading: f64) -> f64 {
    2.0 * (-(reading - 12.0) / 40.0).exp() - 1.0
}

/// The inputs of the root for an observation.
fn inputs(learner: &Learner, root: u32, observation: Observation) -> [f32; MAX_INPUTS] {
    learner.seen(|group| {
        group.record.observation = observation;
        group.encode(root, false);
        group.inputs
    })
}

#[test]
fn turning_in_place_by_steps_of_the_sonar_changes_nothing() {
    let (learner, root) = turned_sonar();
    let room = Written { walls: vec![[150.0, 20.0, 110.0, 90.0]], ..Written::room(190.0, 130.0) };
    let (shared, field) = (floor_only(&room.world()), room.field());
    let (mut next, mut poses, mut spread) = (random(31), 0, 0.0_f32);
    let terms = Noise { kind: 0, actuator: 0.0, sonar: 0.0, light: 0.0, compass: 0.0 };
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
            let observation = seen(&shared, &[], &[], |group| {
                (group.forms.observe)(group, at[0] as f32, at[1] as f32, heading, 0, terms);
                group.record.observation
            });
            (observation.sonar, inputs(&learner, root, observation))
        };
        let (ahead, first) = look(lean);
        for steps in 1..24 {
            let (sonar, turned) = look(lean + 15.0 * steps as f32);
            assert!(sonar != ahead, "the robot has turned");
            for lane in 0..24 {
                let gap = (turned[lane] - first[lane]).abs();
                assert!(gap < 1.0e-5, "{at:?} {lean} turned {steps} times, bearing {lane}: {gap}");
            }
        }
        spread = spread.max(first[..24].iter().fold(0.0, |most, x| x.max(most)));
    }
    assert!(spread > 0.7, "{spread}");
}

/// The value of a direction lies between those of the two rays beside it, in the share of the angle.
#[test]
fn directions_between_rays_are_interpolated() {
    let (learner, root) = turned_sonar();
    let mut next = random(32);
    for round in 0..500 {
        let mut made = made_up(&mut next);
        // Whole steps too, and both ends of the compass.
        let compass = match round {
            0..24 => round as f32 * 15.0,
            24 => 359.999_97,
            25 => 1.0e-20,
            _ => made.compass,
        };
        made.compass = compass;
        let found = inputs(&learner, root, made);
        let sonar = readings(&made);
        for bearing in 0..24 {
            let direction = 15.0 * f64::from(bearing);
            let share = |ray: usize| {
                let off = apart(direction, f64::from(compass) + 15.0 * ray as f64).abs();
                (1.0 - off / 15.0).max(0.0)
            };
            let expected: f64 = (0..24).map(|ray| share(ray) * coded(sonar[ray])).sum();
            let found = f64::from(found[bearing as usize]);
            assert!((found - expected).abs() < 2.0e-5, "compass {compass}, bearing {bearing}: {found} for {expected}");
        }
    }
}
