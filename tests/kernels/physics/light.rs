//! Light and compass.

use super::super::oracle::{Written, length, sub};
use super::super::random::random;
use super::{Place, agreed, at, light_in_sight, places, sense};
use skilltree::layout::RAYS;
use skilltree::world::Pose;

#[test]
fn light_bits_follow_brightness_and_line_of_sight() {
    for place in places() {
        let (lamp, range) = place.written.light.expect("the world has a light");
        let sharp = 1.0 / 15.0_f64.to_radians().powi(2);
        let mut next = random(15);
        let poses: Vec<Pose> = (0..4000).map(|_| place.pose(&mut next, 0.0)).collect();
        let (mut seen, mut hidden, mut lit, mut dark, mut skipped) = (0, 0, 0, 0, 0);
        for (pose, senses) in poses.iter().zip(sense(&place.shared, &poses)) {
            let way = sub(lamp, at(*pose));
            let far = length(way);
            let side = [-way[1] / far * 1.0e-3, way[0] / far * 1.0e-3];
            let views = [-1.0, 0.0, 1.0]
                .map(|k| place.field.sees([at(*pose)[0] + k * side[0], at(*pose)[1] + k * side[1]], lamp));
            if views.iter().any(|view| *view != views[0]) {
                skipped += 1;
                continue;
            }
            let visible = views[0];
            assert_eq!(agreed(light_in_sight(&place.shared, pose.x, pose.y)), visible, "{}: {pose:?}", place.name);
            *(if visible { &mut seen } else { &mut hidden }) += 1;
            for (ray, bit) in senses.light.iter().enumerate() {
                let off = way[1].atan2(way[0]) - (f64::from(pose.heading) + 15.0 * ray as f64).to_radians();
                let bright = (range / far).powi(2) * (sharp * (off.cos() - 1.0)).exp();
                if (bright - 1.0).abs() < 1.0e-4 {
                    continue;
                }
                let expected = visible && bright > 1.0;
                assert_eq!(*bit == 1, expected, "{}: {pose:?} ray {ray}, brightness {bright}", place.name);
                *(if expected { &mut lit } else { &mut dark }) += 1;
            }
        }
        assert!(seen > 400 && hidden > 100 && lit > 1000 && dark > 1000, "{}: {seen} {hidden} {lit}", place.name);
        assert!(skipped < 8, "{}: {skipped}", place.name);
    }
}

#[test]
fn without_a_light_nothing_is_lit_and_the_compass_reads_the_heading() {
    let place = Place::of("dark", Written::room(200.0, 150.0));
    let poses: Vec<Pose> = (0..360).map(|degrees| Pose { x: 70.0, y: 60.0, heading: degrees as f32 + 0.25 }).collect();
    for (pose, senses) in poses.iter().zip(sense(&place.shared, &poses)) {
        assert_eq!(senses.light, [0; RAYS]);
        assert_eq!(senses.compass, pose.heading);
        assert_eq!(senses.bumpers, [0; 4]);
    }
}
