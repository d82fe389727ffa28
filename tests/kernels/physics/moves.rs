//! Motion: turns, free travel, and stops at contact.

use super::super::oracle::{P, Written, ahead, length, sub};
use super::super::random::random;
use super::{BODY, CLOSE, Place, at, carry, places};
use skilltree::env::motion::{BACKWARD, COLLISION, DOCKED, FORWARD};
use skilltree::layout::Moved;
use skilltree::world::Pose;

#[test]
fn turns_are_exact_and_wrap() {
    let place = Place::of("room", Written::room(200.0, 150.0));
    let sizes: [i32; 4] = [15, -15, 60, -60];
    for degrees in 0..360 {
        for (action, size) in sizes.iter().enumerate() {
            let pose = Pose { x: 100.0, y: 75.0, heading: degrees as f32 };
            let moved = carry(&place, pose, action as u32, 1.0);
            let expected = (degrees + size).rem_euclid(360) as f32;
            let same = Moved { x: 100.0, y: 75.0, heading: expected, bumpers: 0, events: 0 };
            assert_eq!(moved, same);
        }
    }
    let half = carry(&place, Pose { x: 100.0, y: 75.0, heading: 10.0 }, 2, 0.5);
    assert_eq!(half.heading, 40.0);
    let back = carry(&place, Pose { x: 100.0, y: 75.0, heading: 10.0 }, 3, 1.5);
    assert_eq!(back.heading, 280.0);
}

#[test]
fn free_travel_is_a_straight_line_of_the_length_asked_for() {
    let place = Place::of("room", Written::room(200.0, 150.0));
    for degrees in 0..360 {
        for (action, sign) in [(FORWARD, 1.0), (BACKWARD, -1.0)] {
            for slip in [1.0, 0.75, 1.5] {
                let pose = Pose { x: 100.0, y: 75.0, heading: degrees as f32 };
                let moved = carry(&place, pose, action, slip);
                let end = ahead([100.0, 75.0], f64::from(degrees), sign * 12.0 * f64::from(slip));
                assert!((f64::from(moved.x) - end[0]).abs() < 2.0e-5, "{pose:?}");
                assert!((f64::from(moved.y) - end[1]).abs() < 2.0e-5, "{pose:?}");
                assert_eq!((moved.events, moved.heading, moved.bumpers), (0, pose.heading, 0));
            }
        }
    }
    // A slip below -1 does not turn travel round.
    let held = carry(&place, Pose { x: 100.0, y: 75.0, heading: 30.0 }, FORWARD, -0.5);
    assert_eq!((held.x, held.y), (100.0, 75.0));
}

/// One move against the oracle; says whether contact cut it and whether the start was clear of everything.
fn judge(place: &Place, pose: Pose, action: u32, slip: f32, moved: &Moved) -> (bool, bool) {
    let bearing = f64::from(pose.heading) + if action == BACKWARD { 180.0 } else { 0.0 };
    let wanted = 12.0 * f64::from(slip);
    let here = at(pose);
    let gone = length(sub([f64::from(moved.x), f64::from(moved.y)], here));
    let say = || format!("{}: {pose:?} action {action} slip {slip}: went {gone}, {moved:?}", place.name);
    let line = ahead(here, bearing, gone);
    assert!(length(sub([f64::from(moved.x), f64::from(moved.y)], line)) < CLOSE, "{}", say());

    let clear = place.field.clearance(here);
    assert!(clear > BODY - CLOSE, "{}: starts in a wall", say());
    let stopped = moved.events & (COLLISION | DOCKED) != 0;
    let thin = place.field.disc(here, bearing, (BODY - 5.0e-4).min(clear - 1.0e-6), 0.0, wanted);
    assert!(gone <= thin + CLOSE, "{}: contact after {thin}", say());
    let apart = clear > BODY + 5.0e-4;
    // From a touch, a move that opens a gap at once counts from there on.
    let opening = place.field.clearance(ahead(here, bearing, 0.05)) > clear + 0.01;
    if apart || opening {
        let start = if apart { 0.0 } else { 0.05 };
        let fat = place.field.disc(here, bearing, BODY + 4.0e-4, start, wanted);
        assert!(gone >= fat - CLOSE, "{}: free for {fat}", say());
        if fat >= wanted {
            assert!(!stopped, "{}: nothing was in the way", say());
        }
    }
    if thin < wanted {
        assert!(stopped, "{}: contact after {thin} of {wanted}", say());
    }
    (stopped, apart)
}

#[test]
fn moves_stop_at_contact_and_nothing_is_entered_or_jumped_on_long_walks() {
    for place in places() {
        let mut next = random(13);
        let (mut stops, mut touching, mut left, mut precise, mut moves) = (0, 0, 0, 0, 0);
        for _robot in 0..200 {
            let mut pose = place.pose(&mut next, 0.0);
            for _step in 0..500 {
                let action = [0, 1, 2, 3, FORWARD, FORWARD, FORWARD, BACKWARD][(next() * 8.0) as usize];
                let slip = (1.0 + 0.08 * (next() + next() + next() + next() - 2.0) * 1.73) as f32;
                let moved = carry(&place, pose, action, slip);
                if action >= FORWARD {
                    let (stopped, apart) = judge(&place, pose, action, slip, &moved);
                    moves += 1;
                    stops += u32::from(stopped);
                    touching += u32::from(!apart);
                    left += u32::from(!apart && !stopped);
                    if apart {
                        let bearing = f64::from(pose.heading) + if action == BACKWARD { 180.0 } else { 0.0 };
                        let exact = place.field.disc(at(pose), bearing, BODY, 0.0, 12.0 * f64::from(slip));
                        let end = ahead(at(pose), bearing, exact);
                        let off = length(sub(end, [f64::from(moved.x), f64::from(moved.y)]));
                        precise += u32::from(off <= CLOSE);
                    }
                } else {
                    assert_eq!((moved.x, moved.y, moved.events), (pose.x, pose.y, 0));
                }
                pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
                assert!(place.field.free(at(pose), BODY - CLOSE), "{}: {pose:?} is in a wall", place.name);
            }
        }
        // The stop itself is within 1e-3 in wherever contact is not a mere graze.
        let from_apart = moves - touching;
        assert!((from_apart - precise) * 2000 < from_apart, "{}: {precise} of {from_apart}", place.name);
        assert!(stops > 2000 && touching > 2000 && left * 4 > touching, "{}: {stops} {touching} {left}", place.name);
    }
}

#[test]
fn contact_has_closed_forms() {
    let posts = Written {
        walls: vec![[0.0, 100.0, 80.0, 100.0], [100.0, 100.0, 200.0, 100.0], [140.0, 40.0, 180.0, 40.0]],
        ..Written::room(200.0, 200.0)
    };
    let place = Place::of("posts", posts);
    let go = |x: f64, y: f64, heading: f64| {
        let moved = carry(&place, Pose { x: x as f32, y: y as f32, heading: heading as f32 }, FORWARD, 1.0);
        ([f64::from(moved.x), f64::from(moved.y)], moved.events)
    };
    let near = |got: (P, u32), x: f64, y: f64| {
        assert!((got.0[0] - x).abs() < CLOSE && (got.0[1] - y).abs() < CLOSE, "{got:?} for {x}, {y}");
        assert_eq!(got.1, COLLISION);
    };
    // Straight at a wall, and at 30 degrees off its normal.
    near(go(40.0, 80.0, 90.0), 40.0, 88.0);
    near(go(40.0, 83.0, 60.0), 40.0 + 5.0 / 3.0_f64.sqrt(), 88.0);
    // Past a wall's end: the rim meets a point 5 in off the path; the chord is 2 sqrt(144 - 25).
    near(go(135.0, 25.0, 90.0), 135.0, 40.0 - 119.0_f64.sqrt());
    // Between two posts 20 in apart, too narrow: both ends meet the rim at once.
    near(go(90.0, 85.0, 90.0), 90.0, 100.0 - 44.0_f64.sqrt());
    // Into the corner of the room.
    near(go(17.0, 17.0, 225.0), 12.0, 12.0);
    // Along a wall with a hair of room, and away from one that is touched.
    assert_eq!(go(40.0, 87.99, 0.0).1, 0);
    let touching = go(40.0, 80.0, 90.0).0;
    let (away, events) = go(touching[0], touching[1], 270.0);
    assert!((away[1] - 76.0).abs() < CLOSE && events == 0);
    let (still, events) = go(touching[0], touching[1], 90.0);
    assert!((still[1] - 88.0).abs() < CLOSE && events == COLLISION);
}
