//! `skilltree probe`: a robot is where and senses what geometry says.

use super::fixture::{Sandbox, edited};
use serde_json::Value;

/// A bare room of 360 by 420 inches with the charger in a corner and a light that reaches 200 inches.
fn bare_room() -> Sandbox {
    let sandbox = Sandbox::new();
    let world = "size = [360, 420]\n[[rooms]]\nname = \"hall\"\nbox = [0, 0, 360, 420]\n\
        [charger]\nbox = [0, 0, 24, 24]\ntolerance = 30\n[light]\nat = [12, 12]\nrange = 200\n\
        [places]\nmiddle = [180.5, 210.25, -90]\n";
    sandbox.write("worlds/bare.toml", world);
    sandbox.write("bare.toml", edited("docking.toml", "worlds/office.toml", "worlds/bare.toml"));
    sandbox
}

fn readings(sandbox: &Sandbox, line: &[&str]) -> Vec<Value> {
    let output = sandbox.give(&[&["probe", "bare.toml", "--json"], line].concat());
    assert!(output.status.success(), "{line:?} {}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(reading: &Value, key: &str) -> f64 {
    reading[key].as_f64().unwrap_or_else(|| panic!("{key} of {reading}"))
}

fn list(reading: &Value, key: &str) -> Vec<u64> {
    reading[key].as_array().unwrap().iter().map(|value| value.as_u64().unwrap()).collect()
}

#[test]
fn probe_prints_one_object_per_pose() {
    let sandbox = bare_room();
    let all = readings(&sandbox, &["--at", "200,200,350", "--actions", "turn+15, turn-60,move+12,,move-12"]);
    assert_eq!(all.len(), 5);
    let keys = ["x", "y", "heading", "room", "sonar", "light", "bumpers", "compass", "blocked", "docked"];
    for reading in &all {
        let found: Vec<&String> = reading.as_object().unwrap().keys().collect();
        assert_eq!(found.len(), keys.len());
        assert!(keys.iter().all(|key| reading.get(key).is_some()), "{reading}");
        for key in ["x", "y", "heading", "compass"] {
            assert!(number(reading, key).is_finite());
        }
        for key in ["heading", "compass"] {
            assert!((0.0..360.0).contains(&number(reading, key)), "{reading}");
        }
        assert_eq!(reading["room"], "hall");
        assert!(list(reading, "sonar").len() == 24 && list(reading, "sonar").iter().all(|inches| *inches <= 127));
        assert!(list(reading, "light").len() == 24 && list(reading, "light").iter().all(|bit| *bit <= 1));
        assert!(list(reading, "bumpers").len() == 4 && list(reading, "bumpers").iter().all(|bit| *bit <= 1));
        assert!(reading["blocked"].is_boolean() && reading["docked"].is_boolean());
    }
    // The same seed gives the same noise, another one gives another.
    let noisy = |seed: &str| readings(&sandbox, &["--at", "200,200,350", "--actions", "move+12", "--seed", seed]);
    assert_eq!(noisy("7"), noisy("7"));
    assert_ne!(noisy("7"), noisy("8"));
    assert_ne!(
        noisy("7")[1]["x"],
        readings(&sandbox, &["--at", "200,200,350", "--actions", "move+12", "--noise", "off"])[1]["x"]
    );
}

#[test]
fn probe_senses_what_geometry_says() {
    let sandbox = bare_room();
    for (x, y, heading) in [(300.0, 350.0, 0.0), (40.0, 380.0, 97.0), (330.0, 30.0, 359.5), (250.0, 250.0, -33.0)] {
        let at = format!("{x},{y},{heading}");
        let reading = &readings(&sandbox, &["--noise", "off", "--at", &at])[0];
        assert!((number(reading, "heading") - f64::rem_euclid(heading, 360.0)).abs() < 1e-4);
        assert_eq!(number(reading, "compass"), number(reading, "heading"));
        for (ray, inches) in list(reading, "sonar").into_iter().enumerate() {
            let (sine, cosine) = f64::to_radians(heading + 15.0 * ray as f64).sin_cos();
            let wall = |at: f64, size: f64, along: f64| match along {
                _ if along.abs() < 1e-9 => f64::INFINITY,
                _ if along > 0.0 => (size - at) / along,
                _ => -at / along,
            };
            // The charger is beyond the sonar's reach from all of these.
            let exact = wall(x, 360.0, cosine).min(wall(y, 420.0, sine)).min(127.0);
            assert!((inches as f64 - exact).abs() <= 0.501, "ray {ray} at {at}: {inches}, not {exact}");
        }
        // The light is lit on bearings where (range / d)^2 exp(k (cos - 1)) exceeds 1, k = 1 / (15 degrees)^2.
        let (dx, dy) = (12.0 - x, 12.0 - y);
        for (ray, bit) in list(reading, "light").into_iter().enumerate() {
            let off = f64::to_radians(heading + 15.0 * ray as f64) - f64::atan2(dy, dx);
            let bright = 200.0 * 200.0 / (dx * dx + dy * dy) * ((off.cos() - 1.0) / 15f64.to_radians().powi(2)).exp();
            assert!((bright - 1.0).abs() > 0.01, "the test's pose {at} is at the threshold");
            assert_eq!(bit == 1, bright > 1.0, "ray {ray} at {at}: {bright}");
        }
    }
    // A near light is seen on several bearings, symmetrically.
    let near = &readings(&sandbox, &["--noise", "off", "--at", "82,82,225"])[0];
    let light = list(near, "light");
    assert_eq!(light.iter().sum::<u64>() % 2, 1);
    assert!(light[0] == 1 && (1..12).all(|ray| light[ray] == light[24 - ray]), "{light:?}");
}

#[test]
fn probe_moves_as_told() {
    let sandbox = bare_room();
    let walk = |at: &str, actions: &str| readings(&sandbox, &["--noise", "off", "--at", at, "--actions", actions]);
    let close = |reading: &Value, x: f64, y: f64, heading: f64| {
        let off = [number(reading, "x") - x, number(reading, "y") - y, number(reading, "heading") - heading];
        assert!(off.iter().all(|off| off.abs() < 1e-3), "{reading}, not {x} {y} {heading}");
    };
    let turns = walk("200,200,10", "turn+15,turn-60,turn-15,turn+60");
    for (reading, heading) in turns.iter().zip([10.0, 25.0, 325.0, 310.0, 10.0]) {
        close(reading, 200.0, 200.0, heading);
        assert_eq!(reading["blocked"], false);
    }
    let moves = walk("200,200,30", "move+12,move-12,move-12");
    let (dx, dy) = (12.0 * 30f64.to_radians().cos(), 6.0);
    for (reading, steps) in moves.iter().zip([0.0, 1.0, 0.0, -1.0]) {
        close(reading, 200.0 + steps * dx, 200.0 + steps * dy, 30.0);
    }
    // Against the east wall: contact where the disc of 12 inches touches, the front bumper, no docking.
    let wall = walk("330,200,0", "move+12,move+12,turn+60,move+12");
    close(&wall[1], 342.0, 200.0, 0.0);
    close(&wall[2], 348.0, 200.0, 0.0);
    assert_eq!(
        (&wall[1]["blocked"], &wall[2]["blocked"], &wall[2]["docked"]),
        (&false.into(), &true.into(), &false.into())
    );
    assert_eq!((list(&wall[1], "bumpers"), list(&wall[2], "bumpers")), (vec![0; 4], vec![1, 0, 0, 0]));
    close(&wall[3], 348.0, 200.0, 60.0);
    assert_eq!(wall[4]["blocked"], true);
    // Into the charger: contact with its east face at x = 24 + 12, and docked.
    let dock = walk("50,12,180", "move+12,move+12");
    close(&dock[1], 38.0, 12.0, 180.0);
    close(&dock[2], 36.0, 12.0, 180.0);
    assert_eq!((&dock[2]["docked"], &dock[2]["blocked"]), (&true.into(), &true.into()));
    // Backwards is no way to dock. The wall touches the right side.
    let back = walk("50,12,0", "move-12,move-12");
    assert_eq!(
        (&back[2]["docked"], &back[2]["blocked"], list(&back[2], "bumpers")),
        (&false.into(), &true.into(), vec![0, 0, 1, 1])
    );
}

#[test]
fn probe_knows_places_and_prints_text() {
    let sandbox = bare_room();
    let reading = &readings(&sandbox, &["--noise", "off", "--at", "middle"])[0];
    assert_eq!((number(reading, "x"), number(reading, "y"), number(reading, "heading")), (180.5, 210.25, 270.0));
    let output =
        sandbox.give(&["probe", "bare.toml", "--noise", "off", "--at", "50,12,180", "--actions", "move+12,move+12"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 15, "{text}");
    assert!(
        lines[0].starts_with("start ") && lines[0].contains("x 50.00  y 12.00  heading 180.0  room hall"),
        "{text}"
    );
    assert!(lines[5].starts_with("move+12 ") && !lines[5].contains("DOCKED"), "{text}");
    assert!(lines[10].contains("x 36.00") && lines[10].ends_with("DOCKED"), "{text}");
    for (line, word) in lines[1..5].iter().zip(["sonar", "light", "bumpers", "compass"]) {
        assert!(line.trim_start().starts_with(word), "{text}");
    }
    assert_eq!(lines[1].split_whitespace().count(), 25);
}

#[test]
fn poses_and_actions_that_cannot_be_are_refused() {
    let sandbox = Sandbox::new();
    for (at, says) in [
        ("150,120,0", "does not fit"),
        ("170,140,0", "does not fit"),
        ("11,300,0", "does not fit"),
        ("-60,60,0", "does not fit"),
        ("1e30,60,0", "does not fit"),
        ("NaN,60,0", "finite"),
        ("60,inf,0", "finite"),
        ("60,60,NaN", "finite"),
        ("60,60,1e39", "finite"),
        ("60,60", "three"),
        ("60,60,0,0", "three"),
        ("60,60,north", "three"),
        ("60;60;0", "three"),
        ("L9", "L1, L2, L3"),
        ("", "--at"),
        (",,", "three"),
    ] {
        sandbox.refuses(&["probe", "docking.toml", "--at", at], 2, &["--at", says]);
    }
    let probe = ["probe", "docking.toml", "--at", "60,60,0"];
    for (more, says) in [
        (&["--actions", "move+12,fly"][..], &["`fly`", "move+12"][..]),
        (&["--actions", "move+13"], &["`move+13`"]),
        (&["--noise", "loud"], &["loud", "on, off"]),
        (&["--seed", "-1"], &["-1"]),
        (&["--set", "robot.noise.sonar=2"], &["robot.noise.sonar=2"]),
    ] {
        sandbox.refuses(&[&probe[..], more].concat(), 2, says);
    }
}
