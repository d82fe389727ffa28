//! Walls beside the robot, against geometry by distance fields.

use super::super::configs::{SILENT, TREE, plan_with};
use super::super::learner::{Learner, seen};
use super::super::oracle::{Written, ahead};
use super::super::random::random;
use super::memories::stream;
use bytemuck::Zeroable;
use skilltree::env::motion::{ACTED, BESIDE_LEFT, BESIDE_RIGHT, COLLISION, DOCKED, FORWARD};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::{Agent, HyperParams, SkillShape};
use skilltree::train::observation::floor_only;
use skilltree::world::Pose;

/// A floor, and a skill that is about no region.
fn with_a_skill(written: &Written) -> CohortData {
    CohortData { skills: vec![SkillShape::zeroed()], ..floor_only(&written.world()) }
}

/// Drives one step and looks; the events, but for that of every step.
#[track_caller]
fn drive(shared: &CohortData, params: &HyperParams, pose: Pose, action: u32) -> (Agent, u32) {
    let agent = seen(shared, std::slice::from_ref(params), &[], |group| {
        group.reset(pose);
        (group.forms.draw_step)(group, stream(0, 0));
        group.observe_and_score(0);
        assert_eq!(group.agent.events, 0, "nothing has happened yet");
        group.apply_action(0, action);
        (group.forms.draw_step)(group, stream(0, 1));
        group.observe_and_score(0);
        group.agent
    });
    assert_eq!(agent.events & ACTED, ACTED, "an action was taken");
    (agent, agent.events & !ACTED)
}

#[test]
fn walls_at_known_distances_are_beside_the_robot() {
    let learner = Learner::new(plan_with(TREE, &[SILENT]));
    let params = &learner.params[0];
    assert_eq!((params.beside_near, params.beside_far), (15, 30));
    let shared = with_a_skill(&Written::room(400.0, 400.0));
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
    let band = ["robot.beside={ near = 18, far = 25 }", SILENT];
    for (set, near, far) in [(&band[1..], 15.0, 30.0), (&band[..], 18.0, 25.0)] {
        let learner = Learner::new(plan_with(TREE, set));
        let params = &learner.params[0];
        let (shared, field) = (with_a_skill(&written), written.field());
        let (mut next, mut counts, mut docked) = (random(33), [0; 4], 0);
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
