//! Noise: its moments, its independence, and that robots do not share it.

use super::super::observations::sees_light;
use super::super::oracle::Written;
use super::super::random::random;
use super::{Place, offices, stepped};
use skilltree::backend::UNWRITTEN;
use skilltree::backend::parity;
use skilltree::config::plan::Noise;
use skilltree::env::motion::{COLLISION, FORWARD, NO_ACTION};
use skilltree::layout::choices::{NOISE_GAUSSIAN, NOISE_UNIFORM};
use skilltree::layout::{Observation, Robot};
use skilltree::train::observation::{SILENT, SensorValues, robot_at};
use skilltree::world::Pose;

/// Mean, standard deviation and greatest deviation from 0.
fn moments(values: &[f64]) -> (f64, f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, square.sqrt(), values.iter().fold(0.0, |most, v| most.max(v.abs())))
}

fn check_moments(what: &str, values: &[f64], deviation: f64, bound: f64) {
    let (mean, found, most) = moments(values);
    let root = (values.len() as f64).sqrt();
    assert!(mean.abs() < 4.0 * deviation / root, "{what}: mean {mean}");
    // No distribution here has a kurtosis above the normal one's.
    assert!((found - deviation).abs() < 4.0 * deviation / (2.0_f64.sqrt() * root), "{what}: deviation {found}");
    assert!(most <= bound, "{what}: {most} beyond {bound}");
}

/// Robots in the middle of a square room, one step each under the same action.
fn crowd(action: u32, noise: &Noise, count: u32) -> Vec<Robot> {
    let place = Place::of("square", Written::room(120.0, 120.0));
    let pose = Pose { x: 60.0, y: 60.0, heading: 0.0 };
    let robots: Vec<Robot> = (0..count).map(|seed| Robot { action, ..robot_at(pose, noise, 1993, seed) }).collect();
    stepped(&place.shared, &robots, 1)
}

#[test]
fn noise_has_the_stated_mean_deviation_and_bounds() {
    let count = 60_000;
    for kind in [NOISE_GAUSSIAN, NOISE_UNIFORM] {
        let noise = Noise { kind, actuator: 0.08, sonar: 0.10, light: 0.0, compass: 2.865 };
        // The bell has unit deviation and ends at sqrt(12) of them; flat noise has its amount as half-width.
        let (unit, end) = match kind {
            NOISE_GAUSSIAN => (1.0, 12.0_f64.sqrt() + 1.0e-3),
            _ => (1.0 / 3.0_f64.sqrt(), 1.0 + 1.0e-4),
        };
        let forward = crowd(FORWARD, &noise, count);
        let slips: Vec<f64> = forward.iter().map(|r| (f64::from(r.x) - 60.0) / 12.0 - 1.0).collect();
        check_moments("travel", &slips, 0.08 * unit, 0.08 * end);
        for (action, size) in [(0, 15.0), (3, -60.0)] {
            let turned = crowd(action, &noise, count);
            let slip = |r: &Robot| ((f64::from(r.heading) + 540.0 - size) % 360.0 - 180.0) / size;
            check_moments("turn", &turned.iter().map(slip).collect::<Vec<_>>(), 0.08 * unit, 0.08 * end);
        }
        let still = crowd(255, &noise, count);
        let senses: Vec<SensorValues> = still.iter().map(SensorValues::of).collect();
        let compass: Vec<f64> = senses.iter().map(|s| (f64::from(s.compass) + 180.0) % 360.0 - 180.0).collect();
        check_moments("compass", &compass, 2.865 * unit, 2.865 * end);
        let mut sides = Vec::new();
        for side in 0..4 {
            // Rounding to whole inches adds 1 / 12 to the variance of 6 in.
            let errors: Vec<f64> = senses.iter().map(|s| f64::from(s.sonar[side * 6]) - 60.0).collect();
            let deviation = ((6.0 * unit).powi(2) + 1.0 / 12.0).sqrt();
            check_moments("sonar", &errors, deviation, 6.0 * end + 0.5);
            sides.push((errors, deviation));
        }
        // Rays, and rays and the compass, err independently: correlations stay within four standard errors.
        sides.push((compass, 2.865 * unit));
        for (i, (one, s)) in sides.iter().enumerate() {
            for (two, t) in &sides[..i] {
                let product = one.iter().zip(two).map(|(a, b)| a * b).sum::<f64>() / f64::from(count);
                assert!((product / (s * t)).abs() < 4.0 / f64::from(count).sqrt(), "rays share noise: {product}");
            }
        }
    }
    let quiet = crowd(FORWARD, &SILENT, 100);
    assert!(quiet.iter().all(|r| (r.x, r.y, r.heading) == (72.0, 60.0, 0.0)));
    assert!(quiet.iter().all(|r| SensorValues::of(r).compass == 0.0 && SensorValues::of(r).sonar[0] == 48));
}

/// The CPU moves robots side by side: in any number, with and without an action, and with anything in what a step writes.
#[test]
fn a_robot_among_others_is_the_robot_alone() {
    let place = &offices()[0];
    let noise = Noise { kind: NOISE_GAUSSIAN, actuator: 0.08, sonar: 0.10, light: 0.10, compass: 2.865 };
    let mut next = random(31);
    let mut robot = |number: u32| {
        let kind = if number % 5 == 1 { NOISE_UNIFORM } else { NOISE_GAUSSIAN };
        let mut robot = robot_at(place.pose(&mut next, 0.0), &Noise { kind, ..noise }, 7, number);
        robot.action = if number % 7 == 6 { NO_ACTION } else { number % 6 };
        robot.sensed = bytemuck::cast([UNWRITTEN; size_of::<Observation>() / 4]);
        robot
    };
    let robots: Vec<Robot> = (0..75).map(&mut robot).collect();
    let alone: Vec<Robot> = robots.iter().flat_map(|robot| stepped(&place.shared, &[*robot], 3)).collect();
    assert!(alone.iter().any(|robot| sees_light(&robot.sensed)), "no light was seen");
    assert!(alone.iter().any(|robot| robot.events == COLLISION), "nothing was touched");
    for count in [2, 15, 16, 17, 33, 75] {
        let together = stepped(&place.shared, &robots[..count], 3);
        let same = bytemuck::cast_slice::<_, u8>(&together) == bytemuck::cast_slice::<_, u8>(&alone[..count]);
        assert!(same, "{:?}", parity::step(&alone[..count], &together));
    }
}

/// Share of draws of the sum of four uniforms, centred and of unit deviation, that lie above `z`.
fn tail(z: f64) -> f64 {
    let x = z * (4.0_f64 / 12.0).sqrt() + 2.0;
    let term = |k: i32, ways: f64| ways * (x - f64::from(k)).max(0.0).powi(4);
    1.0 - (term(0, 1.0) - term(1, 4.0) + term(2, 6.0) - term(3, 4.0) + term(4, 1.0)) / 24.0
}

#[test]
fn light_noise_lights_bearings_as_often_as_the_bell_says() {
    let written = Written { light: Some(([20.0, 100.0], 60.0)), ..Written::room(200.0, 200.0) };
    let place = Place::of("lamp", written);
    let noise = Noise { light: 0.10, ..SILENT };
    let count = 40_000;
    // 60 in from the light's range of 60: the bearing at it has brightness (60 / d)^2.
    for distance in [55.0_f64, 58.0, 60.0, 61.0, 64.0] {
        let pose = Pose { x: 20.0 + distance as f32, y: 100.0, heading: 180.0 };
        let robots: Vec<Robot> = (0..count).map(|seed| robot_at(pose, &noise, 5, seed)).collect();
        let lit = stepped(&place.shared, &robots, 1);
        let lit = lit.iter().filter(|robot| robot.sensed.light_bumpers & 1 == 1).count() as f64;
        let bright = (60.0 / distance).powi(2);
        let expected = tail((1.0 / bright - 1.0) / 0.10);
        let error = (expected * (1.0 - expected) / f64::from(count)).sqrt();
        let found = lit / f64::from(count);
        assert!((found - expected).abs() < 4.0 * error + 1.0e-4, "{distance} in: {found} for {expected}");
    }
    // The test's own tail: symmetric, and nothing beyond.
    assert!((tail(0.0) - 0.5).abs() < 1.0e-12 && tail(3.5).abs() < 1.0e-12);
}
