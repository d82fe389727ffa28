//! Random words, sensors and motion.

use super::super::observations::sees_light;
use super::super::physics::{Place, places};
use super::super::random::random;
use super::{beside, compare};
use skilltree::backend::cpu::lanes::draws::draws;
use skilltree::env::motion::{COLLISION, DOCKED, NO_ACTION};
use skilltree::env::observe::DRAW_LIGHT;
use skilltree::env::workgroup::{CohortData, HotForms, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{Noise, Observation};
use skilltree::math::rng::Stream;
use skilltree::world::Pose;

/// A random stream.
fn stream(next: &mut impl FnMut() -> f64) -> Stream {
    let mut word = || (next() * 4_294_967_296.0) as u32;
    let (key, skill, trial, step) = ([word(), word()], word(), word(), word());
    Stream { key, skill, trial, step, purpose: word() & 0xff }
}

/// The words that every form draws at once, of a workgroup in a bare place.
fn drawn(shared: &CohortData, forms: &HotForms, stream: Stream) -> Vec<u32> {
    let mut group = Workgroup::new(shared, &[], forms);
    (forms.draw_step)(&mut group, stream);
    let random = &group.random;
    [&random.x[..16], &random.y[..16], &random.z[..16], &random.w[..16]].concat()
}

#[test]
fn random_words_are_those_of_the_plain_form() {
    let shared = &places()[0].shared;
    let mut next = random(71);
    let streams: Vec<Stream> = (0..2000).map(|_| stream(&mut next)).collect();
    let faulty = HotForms {
        draw_step: |group, stream| {
            group.random.draw_step(stream);
            group.random.w[15] ^= 1;
        },
        ..PLAIN
    };
    compare(&streams, &faulty, |forms, stream| drawn(shared, forms, *stream));
    // Those of the light are drawn when it is seen.
    for stream in streams {
        let mut group = Workgroup::new(shared, &[], &PLAIN);
        group.random.draw_step(stream);
        let light = DRAW_LIGHT..DRAW_LIGHT + 6;
        let [x, y, z, w] = draws(stream, DRAW_LIGHT as u32);
        let random = &group.random;
        assert_eq!(
            [&x[..6], &y[..6], &z[..6], &w[..6]],
            [&random.x, &random.y, &random.z, &random.w].map(|words| &words[light.clone()])
        );
    }
}

/// A look round at a pose.
struct Look {
    pose: Pose,
    bumpers: u32,
    noise: Noise,
    stream: Stream,
}

impl Look {
    fn random(place: &Place, next: &mut impl FnMut() -> f64) -> Self {
        let noise = Noise {
            kind: (next() * 2.0) as u32,
            actuator: 0.08,
            sonar: (next() * 0.2) as f32,
            light: (next() * 0.2) as f32,
            compass: (next() * 5.0) as f32,
        };
        Self { pose: place.pose(next, 0.0), bumpers: (next() * 16.0) as u32, noise, stream: stream(next) }
    }

    fn seen(&self, shared: &CohortData, forms: &HotForms) -> Observation {
        let mut group = Workgroup::new(shared, &[], forms);
        (forms.draw_step)(&mut group, self.stream);
        let Pose { x, y, heading } = self.pose;
        (forms.observe)(&mut group, x, y, heading, self.bumpers, self.noise);
        group.record.observation
    }
}

#[test]
fn observations_are_those_of_the_plain_form() {
    let faulty = HotForms {
        observe: |group, x, y, heading, bumpers, noise| group.observe(x, y, beside(heading), bumpers, noise),
        ..PLAIN
    };
    for place in places() {
        let mut next = random(72);
        let looks: Vec<Look> = (0..3000).map(|_| Look::random(&place, &mut next)).collect();
        compare(&looks, &faulty, |forms, look| bytemuck::cast_slice(&[look.seen(&place.shared, forms)]).to_vec());
        let lit = looks.iter().filter(|look| sees_light(&look.seen(&place.shared, &PLAIN))).count();
        assert!(lit > 200 && lit < 2900, "{}: {lit}", place.name);
    }
}

/// A move.
struct Move {
    pose: Pose,
    action: u32,
    slip: f32,
}

#[test]
fn moves_are_those_of_the_plain_form() {
    let faulty = HotForms {
        move_body: |group, x, y, heading, action, slip| group.move_body(x, y, heading, action, beside(slip)),
        ..PLAIN
    };
    for place in places() {
        let mut next = random(73);
        let moves: Vec<Move> = (0..5000)
            .map(|_| {
                let action = [0, 1, 2, 3, 4, 4, 4, 5, 5, NO_ACTION][(next() * 10.0) as usize];
                // Some want to go farther than the lists of a cell reach, and some not at all.
                let pose = if next() < 0.3 { place.pose_by_charger(&mut next) } else { place.pose(&mut next, 0.0) };
                Move { pose, action, slip: (next() * 2.2 - 0.2) as f32 }
            })
            .collect();
        let moved = |forms: &HotForms, Move { pose, action, slip }: &Move| {
            let group = Workgroup::new(&place.shared, &[], forms);
            (forms.move_body)(&group, pose.x, pose.y, pose.heading, *action, *slip)
        };
        compare(&moves, &faulty, |forms, case| bytemuck::cast_slice(&[moved(forms, case)]).to_vec());
        let events = |bit: u32| moves.iter().filter(|case| moved(&PLAIN, case).events & bit != 0).count();
        let (collisions, docked) = (events(COLLISION), events(DOCKED));
        assert!(collisions > 200 && docked > 10, "{}: {collisions}, {docked}", place.name);
    }
}
