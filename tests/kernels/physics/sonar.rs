//! Sonar: ranges and readings.

use super::super::oracle::Written;
use super::super::random::random;
use super::{CLOSE, Place, agreed, at, places, ranges, sense};
use skilltree::world::Pose;

#[test]
fn sonar_ranges_and_readings_match_rays_walked_through_the_distance_field() {
    for place in places() {
        let mut next = random(11);
        let poses: Vec<Pose> = (0..3000).map(|_| place.pose(&mut next, 0.0)).collect();
        let senses = sense(&place.shared, &poses);
        let (mut rays_in_all, mut grazing, mut near_half, mut echoes) = (0, 0, 0, 0);
        for (pose, senses) in poses.iter().zip(&senses) {
            let found = agreed(ranges(&place.shared, *pose));
            for (ray, (found, reading)) in found.iter().zip(senses.sonar).enumerate() {
                rays_in_all += 1;
                let bearing = f64::from(pose.heading) + 15.0 * ray as f64;
                let exact = place.field.ray(at(*pose), bearing, 127.0);
                let error = (f64::from(*found) - exact).abs();
                if error > CLOSE {
                    // Only a ray that grazes an end may differ: turned by the last place of its direction it hits.
                    let turned = |by: f64| place.field.ray(at(*pose), bearing + by, 127.0);
                    let other = [-2.0e-5, 2.0e-5].map(turned);
                    let excused = other.iter().any(|other| (f64::from(*found) - other).abs() <= CLOSE);
                    assert!(excused, "{}: {pose:?} ray {ray}: {found} for {exact}", place.name);
                    grazing += 1;
                    continue;
                }
                echoes += usize::from(exact < 127.0);
                if ((exact + 0.5).fract() - 0.5).abs() > 0.5 - CLOSE {
                    near_half += 1;
                    continue;
                }
                assert_eq!(reading, (exact + 0.5).floor() as u32, "{}: {pose:?} ray {ray}", place.name);
            }
        }
        assert!(grazing * 1000 < rays_in_all && near_half * 100 < rays_in_all, "{}: {grazing}", place.name);
        assert!(echoes * 2 > rays_in_all, "{}: {echoes} of {rays_in_all} rays met something", place.name);
    }
}

#[test]
fn sonar_is_exact_in_whole_inches_along_the_axes() {
    let place = Place::of("room", Written::room(200.0, 150.0));
    let cut = |d: i32| d.min(127) as u32;
    let mut poses = Vec::new();
    for x in 12..=188 {
        for y in (12..=138).step_by(7) {
            for turn in 0..4 {
                poses.push(Pose { x: x as f32, y: y as f32, heading: turn as f32 * 90.0 });
            }
        }
    }
    for (pose, senses) in poses.iter().zip(sense(&place.shared, &poses)) {
        let (x, y) = (pose.x as i32, pose.y as i32);
        let east_north_west_south = [cut(200 - x), cut(150 - y), cut(x), cut(y)];
        let turn = (pose.heading / 90.0) as usize;
        for side in 0..4 {
            assert_eq!(senses.sonar[side * 6], east_north_west_south[(turn + side) % 4], "{pose:?} side {side}");
        }
        // 60 degrees off the axis a wall is twice as far, as long as no other wall comes first.
        for (ray, ahead, beside) in [(4, 0, 1), (20, 0, 3)] {
            let [ahead, beside] = [ahead, beside].map(|side: usize| match (turn + side) % 4 {
                0 => 200 - x,
                1 => 150 - y,
                2 => x,
                _ => y,
            });
            if f64::from(beside) > 2.0 * f64::from(ahead) * 0.9 {
                assert_eq!(senses.sonar[ray], cut(2 * ahead), "{pose:?} ray {ray}");
            }
        }
    }
}
