//! What `bench --export` writes is what its README says, and what the peers read.

use safetensors::SafeTensors;
use serde_json::Value;
use skilltree::env::observe::{DRAW_ACTUATOR, DRAW_COMPASS, DRAW_LIGHT};
use skilltree::layout::RAYS;
use skilltree::math::rng::{Purpose, StepRandom, Stream};
use std::path::Path;
use std::process::Command;

fn floats(tensors: &SafeTensors<'_>, name: &str) -> Vec<f64> {
    let tensor = tensors.tensor(name).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (words, _) = tensor.data().as_chunks::<4>();
    match tensor.dtype() {
        safetensors::Dtype::F32 => words.iter().map(|word| f64::from(f32::from_le_bytes(*word))).collect(),
        safetensors::Dtype::I32 => words.iter().map(|word| f64::from(i32::from_le_bytes(*word))).collect(),
        _ => tensor.data().iter().map(|byte| f64::from(*byte)).collect(),
    }
}

fn numbers(bytes: &[u8]) -> Value {
    let (_, header) = SafeTensors::read_metadata(bytes).expect("a header");
    let entries = header.metadata().as_ref().expect("metadata");
    serde_json::from_str(&entries["skilltree"]).expect("JSON")
}

#[test]
fn exported_work_is_what_the_readme_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_skilltree"))
        .args(["bench", "--learners", "2", "--export"])
        .arg(folder.path())
        .output()
        .expect("runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let readme = std::fs::read_to_string(folder.path().join("README.md")).expect("a README");
    for file in ["simulate.safetensors", "replay.safetensors"] {
        let bytes = std::fs::read(folder.path().join(file)).expect("a file");
        for (name, _) in SafeTensors::deserialize(&bytes).expect("tensors").tensors() {
            assert!(readme.contains(&format!("| `{name}` |")), "{name}");
        }
    }
    walk_again(&folder.path().join("simulate.safetensors"));
    replay_again(&folder.path().join("replay.safetensors"));
}

/// Turns and sonar in f64, straight from the README.
fn walk_again(path: &Path) {
    let bytes = std::fs::read(path).expect("a file");
    let tensors = SafeTensors::deserialize(&bytes).expect("tensors");
    let of = |name: &str| floats(&tensors, name);
    let (start, pose, action, slip) = (of("start"), of("expected.pose"), of("action"), of("noise.slip"));
    let (segment, noise, sonar) = (of("segment"), of("noise.sonar"), of("expected.sonar"));
    let robots = start.len() / 3;
    let steps = action.len() / robots;
    let (mut turned, mut heard, mut near) = (0, 0, 0);
    for place in 0..robots * steps {
        let before = if place < robots { &start[3 * place..] } else { &pose[3 * (place - robots)..] };
        let now = &pose[3 * place..];
        let turn = [15.0, -15.0, 60.0, -60.0, 0.0, 0.0][action[place] as usize];
        let heading = (before[2] + turn * slip[place]).rem_euclid(360.0);
        let off = (heading - now[2]).abs();
        assert!(off.min(360.0 - off) < 1.0e-3, "{heading} {}", now[2]);
        turned += usize::from(turn != 0.0);
        // A sample of the rays: every robot has its own.
        let ray = place % 24;
        let (sine, cosine) = (now[2] + 15.0 * ray as f64).to_radians().sin_cos();
        let range = segment.chunks(7).filter_map(|s| crossing([s[0], s[1]], [s[2], s[3]], now, cosine, sine));
        let range = range.fold(127.0, f64::min) * noise[24 * place + ray];
        let reading = range.clamp(0.0, 127.0) + 0.5;
        if (reading - reading.round()).abs() < 1.0e-3 {
            near += 1;
        } else {
            heard += usize::from(reading.floor() == sonar[24 * place + ray]);
        }
    }
    assert!(turned > robots && near < robots, "{turned} {near}");
    // A ray that just touches the end of a wall may go either way.
    assert!(heard + near > robots * steps - robots / 100, "{heard} + {near} of {}", robots * steps);
}

fn crossing(a: [f64; 2], b: [f64; 2], at: &[f64], cosine: f64, sine: f64) -> Option<f64> {
    let along = |p: [f64; 2]| (p[0] - at[0]) * cosine + (p[1] - at[1]) * sine;
    let aside = |p: [f64; 2]| (p[1] - at[1]) * cosine - (p[0] - at[0]) * sine;
    let (left, right) = (aside(a), aside(b));
    if (left > 0.0) == (right > 0.0) {
        return None;
    }
    let distance = along(a) + (along(b) - along(a)) * left / (left - right);
    (distance >= 0.0).then_some(distance)
}

/// One pass of TD(lambda) with Adam in f64, straight from the README.
fn replay_again(path: &Path) {
    let bytes = std::fs::read(path).expect("a file");
    let tensors = SafeTensors::deserialize(&bytes).expect("tensors");
    let of = |name: &str| floats(&tensors, name);
    let numbers = numbers(&bytes);
    let number = |name: &str| numbers[name].as_f64().unwrap_or_else(|| panic!("{name}"));
    let (inputs, hidden, children, steps, lessons) = (52, 32, 6, 30, 10);
    let (length, given, input) = (of("lesson.length"), of("lesson"), of("lesson.input"));
    let (child, reward) = (of("lesson.child"), of("lesson.reward"));
    let layers = ["hidden.weight", "hidden.bias", "output.weight", "output.bias"];
    let load = |stage: &str| layers.map(|layer| of(&format!("{stage}.{layer}")));
    let [mut w1, mut b1, mut w2, mut b2] = load("initial");
    let learners = given.len() / lessons;
    let adam = |weight: &mut f64, moments: &mut (f64, f64), slope: f64, clock: i32| {
        moments.0 = number("beta1") * moments.0 + (1.0 - number("beta1")) * slope;
        moments.1 = number("beta2") * moments.1 + (1.0 - number("beta2")) * slope * slope;
        let rate = number("rate") * (1.0 - number("beta2").powi(clock)).sqrt() / (1.0 - number("beta1").powi(clock));
        *weight += rate * moments.0 / (moments.1 + number("epsilon2")).sqrt();
    };
    let mut updates = 0;
    for learner in 0..learners {
        let mut clocks = vec![0; children];
        let (mut m1, mut n1) = (vec![(0.0, 0.0); w1.len()], vec![(0.0, 0.0); b1.len()]);
        let (mut m2, mut n2) = (vec![(0.0, 0.0); w2.len()], vec![(0.0, 0.0); b2.len()]);
        for lesson in &given[learner * lessons..(learner + 1) * lessons] {
            let (mut best, mut back) = (0.0, 0.0);
            for step in (0..length[*lesson as usize] as usize).rev() {
                let row = *lesson as usize * steps + step;
                let x = &input[row * inputs..(row + 1) * inputs];
                let net = |number: usize| {
                    let unit = |k: usize| {
                        let own = (learner * children + number) * hidden + k;
                        let sum: f64 = x.iter().zip(&w1[own * inputs..]).map(|(x, w)| x * w).sum();
                        (sum + b1[own]).tanh()
                    };
                    let units: Vec<f64> = (0..hidden).map(unit).collect();
                    let own = learner * children + number;
                    let sum: f64 = units.iter().zip(&w2[own * hidden..]).map(|(h, w)| h * w).sum();
                    (units, (sum + b2[own]).tanh())
                };
                let nets: Vec<_> = (0..children).map(net).collect();
                let greatest = nets.iter().map(|net| net.1).fold(-2.0, f64::max);
                let future = (1.0 - number("lambda")) * best + number("lambda") * back;
                let limit = number("target_clip");
                let goal = (reward[row] + number("gamma") * future).clamp(-limit, limit);
                let taken = child[row] as usize;
                let (units, q) = &nets[taken];
                let own = learner * children + taken;
                clocks[taken] += 1;
                updates += 1;
                let clock = clocks[taken];
                let error = (goal - q) * (1.0 - q * q);
                for (k, h) in units.iter().enumerate() {
                    let at = own * hidden + k;
                    let slope = error * w2[at] * (1.0 - h * h);
                    for (j, x) in x.iter().enumerate() {
                        adam(&mut w1[at * inputs + j], &mut m1[at * inputs + j], slope * x, clock);
                    }
                    adam(&mut b1[at], &mut n1[at], slope, clock);
                    adam(&mut w2[at], &mut m2[at], error * h, clock);
                }
                adam(&mut b2[own], &mut n2[own], error, clock);
                (best, back) = (greatest, goal);
            }
        }
    }
    assert_eq!(updates as f64 * number("passes"), number("transitions"));
    let (ours, initial) = (load("once"), load("initial"));
    for (((layer, again), ours), initial) in layers.iter().zip([w1, b1, w2, b2]).zip(&ours).zip(&initial) {
        let off = again.iter().zip(ours).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let moved = ours.iter().zip(initial).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 2.0e-5 && moved > 1.0e-3, "{layer}: off by {off}, moved by {moved}");
    }
}

/// The peers draw the noise that we draw; nothing in CI runs them.
#[test]
fn peers_know_which_draws_are_for_what() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/workload.py");
    let text = std::fs::read_to_string(path).expect("the peers' workload");
    let told = text.lines().find_map(|line| line.strip_prefix("PURPOSE, SHARED, ACTUATOR, COMPASS, BEAMS = "));
    let told: Vec<usize> =
        told.expect("a line with the draws").split(", ").map(|word| word.parse().expect("a number")).collect();
    // The first bearing that has a word of the first one's draw.
    let mut random = StepRandom::default();
    random.draw_step(Stream { key: [1, 2], skill: 3, trial: 4, step: 5, purpose: 6 });
    let first = [random.x[0], random.y[0], random.z[0], random.w[0]];
    let shared = (1..RAYS).find(|bearing| first.contains(&random.bearing_word(0, *bearing))).expect("a second word");
    assert_eq!(told, [Purpose::Given as usize, shared, DRAW_ACTUATOR, DRAW_COMPASS, DRAW_LIGHT]);
}
