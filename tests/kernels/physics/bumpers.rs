//! Bumpers.

use super::super::oracle::{Written, ahead};
use super::super::random::random;
use super::{BODY, Place, agreed, at, slanted};
use skilltree::backend::cpu::lanes;
use skilltree::env::workgroup::Workgroup;
use skilltree::kernels::plain::PLAIN;
use skilltree::math::functions::sin_cos;
use skilltree::world::Pose;

/// Bits of the bumpers that touch something.
fn feel(place: &Place, pose: Pose) -> u32 {
    let (sine, cosine) = sin_cos(pose.heading);
    let plain = Workgroup::new(&place.shared, &[], &PLAIN).touching_bumpers(pose.x, pose.y, cosine, sine);
    let near = place.shared.floor.touchable(pose.x, pose.y, 0.0);
    agreed([plain, lanes::contact::touching_bumpers(near, pose.x, pose.y, cosine, sine)])
}

#[test]
fn bumpers_feel_four_sectors_within_the_gap() {
    let place = Place::of("room", Written::room(200.0, 200.0));
    let feel = |x: f32, y: f32, heading: f32| feel(&place, Pose { x, y, heading });
    for degrees in 0..360_i32 {
        if (degrees - 45) % 90 == 0 {
            continue;
        }
        // The wall's bearing, seen from the robot, is 180 degrees less its heading.
        let relative = (180 - degrees).rem_euclid(360);
        let sector = [1, 2, 4, 8][((relative + 45).rem_euclid(360) / 90) as usize];
        assert_eq!(feel(12.0, 100.0, degrees as f32), sector, "{degrees}");
        assert_eq!(feel(12.39, 100.0, degrees as f32), sector, "{degrees}");
        assert_eq!(feel(12.41, 100.0, degrees as f32), 0, "{degrees}");
    }
    assert_eq!(feel(12.2, 12.2, 180.0), 1 | 2);
    assert_eq!(feel(12.2, 12.2, 270.0), 1 | 8);
    assert_eq!(feel(100.0, 187.8, 90.0), 1);
}

#[test]
fn bumpers_match_the_oracle_at_poses_of_contact() {
    let reach = BODY + 0.4;
    for place in slanted() {
        let mut next = random(14);
        let (mut judged, mut skipped, mut felt) = (0, 0, [0; 4]);
        while judged < 4000 {
            let start = place.pose(&mut next, 0.0);
            let run = place.field.disc(at(start), f64::from(start.heading), BODY + next() * 0.6, 0.0, 300.0);
            let stop = ahead(at(start), f64::from(start.heading), run);
            let pose = Pose { x: stop[0] as f32, y: stop[1] as f32, heading: (next() * 359.0) as f32 };
            let touches = place.field.touches(at(pose), f64::from(pose.heading), reach + 1.0e-3);
            // The oracle's nearest point comes from a search, good to some 1e-6 in.
            let unclear = |(distance, bearing): &(f64, f64)| {
                (distance - reach).abs() < 1.0e-4 || ((bearing.abs() - 90.0).abs() - 45.0).abs() < 1.0e-2
            };
            if touches.iter().any(unclear) {
                skipped += 1;
                continue;
            }
            let sector = |bearing: f64| match bearing.abs() {
                b if b < 45.0 => 1,
                b if b > 135.0 => 4,
                _ => {
                    if bearing > 0.0 {
                        2
                    } else {
                        8
                    }
                }
            };
            let expected = touches.iter().filter(|t| t.0 < reach).fold(0, |bits, t| bits | sector(t.1));
            let found = feel(&place, pose);
            assert_eq!(found, expected, "{}: {pose:?} {touches:?}", place.name);
            judged += 1;
            for (side, count) in felt.iter_mut().enumerate() {
                *count += (found >> side) & 1;
            }
        }
        assert!(felt.iter().all(|count| *count > 300) && skipped < 400, "{}: {felt:?} {skipped}", place.name);
    }
}
