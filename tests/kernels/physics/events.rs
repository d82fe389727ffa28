//! Events, and what they are paid, on walks through a world with slanted walls, against geometry in f64.

use super::super::configs::{file, written};
use super::super::learner::Learner;
use super::super::oracle::{P, length, office, sub};
use super::super::random::random;
use skilltree::math::rng::Stream;
use skilltree::world::Pose;

/// Rectangles as the world's file has them.
const HALL: [f64; 4] = [0.0, 0.0, 140.0, 180.0];
const BY_LIGHT: [f64; 4] = [240.0, 0.0, 296.0, 56.0];

/// Each event is paid a power of two, so that a reward tells which of them happened.
const NAMES: [&str; 8] = [
    "step",
    "lit",
    "in(room:hall)",
    "entered(room:hall)",
    "left(room:hall)",
    "left(by-light)",
    "entered(by-light)",
    "in(by-light)",
];

/// What one action did, as the robot's record has it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Walked {
    before: [f32; 2],
    after: [f32; 3],
    earned: f32,
    goal: bool,
}

/// A walk of `steps` random actions, most of them forwards.
fn walk(learner: &mut Learner, start: Pose, seed: u64, steps: u32) -> Vec<Walked> {
    learner.act(|group| {
        let mut next = random(seed);
        let mut walked = Vec::new();
        group.reset(start);
        for step in 0..=steps {
            let stream = Stream { key: [1, 2], skill: 0, trial: 0, step, purpose: 0 };
            (group.forms.draw_step)(group, stream);
            let before = [group.agent.before_x, group.agent.before_y];
            group.observe_and_score(0);
            let after = [group.agent.x, group.agent.y, group.agent.heading];
            let goal = group.skill_events(0) & group.skills[0].ends != 0;
            walked.push(Walked { before, after, earned: group.agent.earned, goal });
            let action = if next() < 0.7 { 4 } else { (next() * 6.0) as u32 };
            group.apply_action(0, action.min(5));
        }
        walked
    })
}

#[test]
fn events_of_a_walk_are_those_of_exact_geometry() {
    let paid: Vec<String> = NAMES.iter().enumerate().map(|(i, name)| format!("\"{name}\" = {}", 1 << i)).collect();
    let world = file("configs/worlds/gallery.toml");
    let text = format!(
        "title = \"walks\"\nworld = {world:?}\nseeds = \"0\"\nrobot.noise = {{ actuator = 0.0, sonar = 0.0, light = 0.0, \
         compass = 0.0 }}\n[skill.walk]\ninputs = [\"sonar\"]\nreward = {{ {} }}\ngoal = [\"entered(by-light)\"]\n",
        paid.join(", ")
    );
    let mut learner = Learner::new(written(&text, &[]));
    let (_, plain) = office("gallery");
    let (field, (lamp, range)) = (plain.field(), plain.light.expect("a light"));
    let mut next = random(77);
    let mut seen = [0_u32; NAMES.len()];
    let mut dark = 0;
    for seed in 0..150 {
        let start = loop {
            let at = [next() * 296.0, next() * 180.0];
            if field.free(at, 12.5) {
                break Pose { x: at[0] as f32, y: at[1] as f32, heading: (next() * 359.0) as f32 };
            }
        };
        let walked = walk(&mut learner, start, seed, 60);
        assert_eq!((walked[0].earned, walked[0].goal), (0.0, false), "nothing has happened yet");
        for pair in walked.windows(2) {
            let (last, step) = (pair[0], pair[1]);
            assert_eq!(last.after[..2], step.before, "seed {seed}");
            let point = |of: &[f32]| -> P { [f64::from(of[0]), f64::from(of[1])] };
            let inside = |[x, y]: P, [left, low, right, high]: [f64; 4]| x >= left && x < right && y >= low && y < high;
            let (from, to) = (point(&step.before), point(&step.after));
            let (hall, was_hall) = (inside(to, HALL), inside(from, HALL));
            let (near, was_near) = (inside(to, BY_LIGHT), inside(from, BY_LIGHT));
            let Some(lit) = sees_lamp(&field, to, f64::from(step.after[2]), lamp, range) else { continue };
            let happened =
                [true, lit, hall, hall && !was_hall, was_hall && !hall, was_near && !near, near && !was_near, near];
            let expected = happened.iter().enumerate().map(|(i, event)| u32::from(*event) << i).sum::<u32>();
            assert_eq!(step.earned, expected as f32, "seed {seed}: {step:?}, expected {happened:?}");
            assert_eq!(step.goal, near && !was_near, "seed {seed}: {step:?}");
            for (count, event) in seen.iter_mut().zip(happened) {
                *count += u32::from(event);
            }
            dark += u32::from(!lit);
        }
    }
    assert!(seen.iter().all(|count| *count >= 10) && dark > 1000, "{seen:?} {dark}");
}

/// Whether some bearing is lit, by the definition of brightness; none where a hair decides.
fn sees_lamp(field: &super::Field, from: P, heading: f64, lamp: P, range: f64) -> Option<bool> {
    let way = sub(lamp, from);
    let far = length(way);
    let side = [-way[1] / far * 1.0e-3, way[0] / far * 1.0e-3];
    let views = [-1.0, 0.0, 1.0].map(|k| field.sees([from[0] + k * side[0], from[1] + k * side[1]], lamp));
    let sharp = 1.0 / 15.0_f64.to_radians().powi(2);
    let brightness = (0..24).map(|ray| {
        let off = way[1].atan2(way[0]) - (heading + 15.0 * f64::from(ray)).to_radians();
        (range / far).powi(2) * (sharp * (off.cos() - 1.0)).exp()
    });
    let most = brightness.fold(0.0, f64::max);
    let sure = views[1..].iter().all(|view| *view == views[0]) && (most - 1.0).abs() > 1.0e-4;
    sure.then_some(views[0] && most > 1.0)
}
