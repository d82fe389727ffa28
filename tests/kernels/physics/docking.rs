//! Docking and doors.

use super::super::oracle::{P, Written, ahead, length, sub};
use super::super::random::random;
use super::{BODY, CLOSE, Place, at, carry, offices};
use skilltree::env::motion::{BACKWARD, COLLISION, DOCKED, FORWARD, PASSED_DOOR};
use skilltree::world::Pose;

/// A robot that would touch the charger at `contact` with the body's centre on bearing `from` of it, driving with its
/// heading `off` degrees beside the contact point, from `away` inches before contact.
fn approach(contact: P, from: f64, off: f64, away: f64) -> Pose {
    let centre = ahead(contact, from, BODY);
    let heading = (from + 180.0 + off).rem_euclid(360.0);
    let start = ahead(centre, heading, -away);
    Pose { x: start[0] as f32, y: start[1] as f32, heading: heading as f32 }
}

#[test]
fn docking_needs_the_charger_within_thirty_degrees_of_the_heading() {
    let island = Written { charger: Some([90.0, 90.0, 114.0, 114.0]), ..Written::room(200.0, 200.0) };
    let place = Place::of("island", island);
    // Middles of all four sides, then all four corners from three bearings each.
    let mut contacts =
        vec![([114.0, 101.0], 0.0), ([101.0, 114.0], 90.0), ([90.0, 101.0], 180.0), ([101.0, 90.0], 270.0)];
    for (corner, bearing) in
        [([114.0, 114.0], 45.0), ([90.0, 114.0], 135.0), ([90.0, 90.0], 225.0), ([114.0, 90.0], 315.0)]
    {
        contacts.extend([-25.0, 0.0, 25.0].map(|more| (corner, bearing + more)));
    }
    for (contact, from) in contacts {
        for off in [0.0, 10.0, -10.0, 29.0, -29.0, 31.0, -31.0, 50.0, -50.0] {
            let expected = if f64::abs(off) < 30.0 { DOCKED } else { COLLISION };
            let pose = approach(contact, from, off, 5.0);
            let moved = carry(&place, pose, FORWARD, 1.0);
            assert_eq!(moved.events, expected, "{contact:?} from {from}, {off} off: {pose:?}");
            let end = ahead(contact, from, BODY);
            let gap = length(sub(end, [f64::from(moved.x), f64::from(moved.y)]));
            assert!(gap < CLOSE, "{contact:?} from {from}, {off} off: {gap}");
            // Once it touches, another push docks all the same, and backing into it never does.
            let there = Pose { x: moved.x, y: moved.y, heading: pose.heading };
            assert_eq!(carry(&place, there, FORWARD, 1.0).events, expected, "{contact:?} from {from}, {off} off again");
            let turned = Pose { heading: (pose.heading + 180.0).rem_euclid(360.0), ..pose };
            assert_eq!(carry(&place, turned, BACKWARD, 1.0).events, COLLISION, "{contact:?} from {from}, {off} off");
            // Too short a move touches nothing.
            assert_eq!(carry(&place, pose, FORWARD, 4.9 / 12.0).events, 0);
        }
    }
    let walls_only = Place::of("bare", Written::room(200.0, 200.0));
    assert_eq!(carry(&walls_only, Pose { x: 15.0, y: 100.0, heading: 180.0 }, FORWARD, 1.0).events, COLLISION);
}

/// A robot that touches a wall and the charger at once, and pushes against both, docks, whichever lanes the segments
/// fall on: a world of more than 32 segments is dealt out to the lanes in turns.
#[test]
fn docking_beside_a_wall_does_not_depend_on_the_number_of_segments() {
    for extra in 0..40 {
        let walls = (0..extra).map(|i| [60.0, 60.0 + f64::from(i), 70.0, 60.0 + f64::from(i)]).collect();
        let corner = Written { walls, charger: Some([0.0, 0.0, 24.0, 24.0]), ..Written::room(200.0, 150.0) };
        let place = Place::of("corner", corner);
        let pose = Pose { x: 36.0, y: 12.0, heading: 185.0 };
        assert_eq!(carry(&place, pose, FORWARD, 1.0).events, DOCKED, "with {extra} walls elsewhere");
    }
}

#[test]
fn doors_are_passed_beyond_the_doorway_in_another_room() {
    for place in offices() {
        let plan = &place.shared.floor.plan;
        let mut next = random(16);
        let room = |p: P| {
            place.world.rooms.iter().position(|room| {
                let (low, high) = (room.area.min, room.area.max);
                p[0] >= f64::from(low.x)
                    && p[0] < f64::from(high.x)
                    && p[1] >= f64::from(low.y)
                    && p[1] < f64::from(high.y)
            })
        };
        let (mut passed, mut waiting) = (0, 0);
        for _ in 0..20_000 {
            let pose = place.pose(&mut next, 0.0);
            // In the shipped worlds every door leads up through a wall 8 in thick: its frame is a radius wider on each
            // side, and 13 in deeper on both faces.
            let in_frame = place.world.doors.iter().any(|door| {
                let (dx, dy) = (at(pose)[0] - f64::from(door.centre.x), at(pose)[1] - f64::from(door.centre.y));
                (-37.0..37.0).contains(&dx) && (-17.0..17.0).contains(&dy)
            });
            for origin in 0..3 {
                let elsewhere = room(at(pose)).is_some_and(|room| room != origin);
                let expected = elsewhere && !in_frame;
                let found = plan.passed_door(origin as u32, pose.x, pose.y) == PASSED_DOOR;
                assert_eq!(found, expected, "{}: {pose:?} from room {origin}", place.name);
                passed += u32::from(expected);
                waiting += u32::from(elsewhere && in_frame);
            }
        }
        assert!(passed > 10_000 && waiting > 300, "{}: {passed} {waiting}", place.name);
    }
    // A drive through the left door of the office: nothing until the body is clear on the far side.
    let place = &offices()[0];
    let mut pose = Pose { x: 64.0, y: 150.0, heading: 90.0 };
    let mut heights = Vec::new();
    let origin = place.shared.floor.plan.room_of(pose.x, pose.y);
    for _ in 0..10 {
        let moved = carry(place, pose, FORWARD, 1.0);
        pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
        if place.shared.floor.plan.passed_door(origin, pose.x, pose.y) == PASSED_DOOR {
            heights.push(pose.y);
        }
    }
    assert_eq!(heights, [222.0, 234.0, 246.0, 258.0, 270.0]);
}
