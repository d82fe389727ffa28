//! The simulator against closed forms and an independent geometry in f64 (`oracle`). Slanted walls included. Whatever
//! is asked of it, the plain twins and the CPU's tuned forms give the same bits.

mod bumpers;
mod docking;
mod events;
mod light;
mod lists;
mod moves;
mod noise;
mod sonar;

use super::learner::seen;
use super::oracle::{Field, P, Written, office};
use skilltree::backend::cpu::cpu_backend;
use skilltree::backend::cpu::lanes;
use skilltree::backend::cpu::lanes::draws::place_of;
use skilltree::backend::reference::reference_backend;
use skilltree::backend::{Backend, parity};
use skilltree::env::sonar::line_direction;
use skilltree::env::workgroup::{CohortData, Workgroup};
use skilltree::kernels::plain::PLAIN;
use skilltree::layout::{LANES, Moved, RAYS, Robot};
use skilltree::math::functions::sin_cos;
use skilltree::math::reduce::Lanes;
use skilltree::train::observation::{SILENT, SensorValues, floor_only, robot_at};
use skilltree::world::{Pose, World};

/// What is allowed between f32 and exact geometry, inches.
const CLOSE: f64 = 1.0e-3;
const BODY: f64 = 12.0;

/// A world with its exact geometry.
pub(super) struct Place {
    pub(super) name: String,
    world: World,
    field: Field,
    written: Written,
    pub(super) shared: CohortData,
}

/// Directions of the lines on which the rays of a robot lie.
fn lines(heading: f32) -> (Lanes, Lanes) {
    let (sine, cosine) = sin_cos(heading);
    let (mut ux, mut uy) = ([0.0; LANES], [0.0; LANES]);
    for lane in 0..LANES {
        (ux[lane], uy[lane]) = line_direction(lane, cosine, sine);
    }
    (ux, uy)
}

/// Distance along each ray to what it meets, in the plain form and in the CPU's.
fn ranges(shared: &CohortData, pose: Pose) -> [[f32; RAYS]; 2] {
    let (ux, uy) = lines(pose.heading);
    let plain = Workgroup::new(shared, &[], &PLAIN).ranges(pose.x, pose.y, &ux, &uy);
    let (sine, cosine) = sin_cos(pose.heading);
    let (ux, uy) = lanes::sonar::rays(cosine, sine);
    let tuned = lanes::sonar::ranges(&shared.floor, pose.x, pose.y, &ux, &uy);
    [std::array::from_fn(|ray| plain[ray]), std::array::from_fn(|ray| tuned[place_of(ray)])]
}

/// Whether the light is in sight, in the plain form and in the CPU's.
fn light_in_sight(shared: &CohortData, x: f32, y: f32) -> [bool; 2] {
    let plain = Workgroup::new(shared, &[], &PLAIN).light_in_sight(x, y);
    [plain, lanes::light::light_in_sight(&shared.floor, x, y)]
}

/// The one thing that both forms found.
#[track_caller]
fn agreed<T: PartialEq + Copy + std::fmt::Debug>(found: [T; 2]) -> T {
    assert_eq!(found[0], found[1], "the tuned form finds something else");
    found[0]
}

impl Place {
    fn new(name: &str, world: World, written: Written) -> Self {
        let (field, shared) = (written.field(), floor_only(&world));
        Self { name: name.to_owned(), world, field, written, shared }
    }

    fn of(name: &str, written: Written) -> Self {
        Self::new(name, written.world(), written)
    }

    /// A random pose with some room round the body, its numbers exactly as f32 holds them.
    pub(super) fn pose(&self, next: &mut impl FnMut() -> f64, room: f64) -> Pose {
        loop {
            let x = (next() * f64::from(self.world.size.x)) as f32;
            let y = (next() * f64::from(self.world.size.y)) as f32;
            if self.field.free([f64::from(x), f64::from(y)], BODY + room) {
                return Pose { x, y, heading: (next() * 359.99) as f32 };
            }
        }
    }

    /// A random pose at most 30 in from the charger.
    pub(super) fn pose_by_charger(&self, next: &mut impl FnMut() -> f64) -> Pose {
        let [left, low, right, high] = self.written.charger.expect("a charger");
        loop {
            let mut between = |from: f64, to: f64| (from - 30.0 + next() * (to - from + 60.0)).max(0.0) as f32;
            let (x, y) = (between(left, right), between(low, high));
            if self.field.free([f64::from(x), f64::from(y)], BODY) {
                return Pose { x, y, heading: (next() * 359.99) as f32 };
            }
        }
    }
}

fn offices() -> Vec<Place> {
    let place = |name: &str| {
        let (world, written) = office(name);
        Place::new(name, world, written)
    };
    ["office", "office-easy", "office-hard"].map(place).into()
}

fn slanted() -> Vec<Place> {
    let charger = Some([0.0, 0.0, 24.0, 24.0]);
    let beams = Written {
        walls: vec![
            [50.0, 150.0, 110.0, 100.0],
            [150.0, 40.0, 200.0, 95.0],
            [130.0, 130.0, 131.0, 190.0],
            [170.0, 150.0, 230.0, 148.0],
            [80.0, 20.0, 80.01, 20.02],
        ],
        charger,
        light: Some(([12.0, 12.0], 230.0)),
        ..Written::room(240.0, 200.0)
    };
    let posts = Written {
        walls: vec![
            [0.0, 100.0, 90.0, 110.0],
            [118.0, 113.0, 240.0, 120.0],
            [60.0, 30.0, 120.0, 60.0],
            [120.0, 60.0, 180.0, 25.0],
            [200.0, 150.0, 215.0, 165.0],
        ],
        boxes: vec![[40.0, 140.0, 60.0, 160.0]],
        charger,
        light: Some(([12.0, 12.0], 300.0)),
        ..Written::room(240.0, 200.0)
    };
    // A diamond that a robot fits in, and a fan of walls that share an end.
    let fan = Written {
        walls: vec![
            [100.0, 60.0, 140.0, 100.0],
            [140.0, 100.0, 100.0, 140.0],
            [100.0, 140.0, 60.0, 100.0],
            [60.0, 100.0, 100.0, 60.0],
            [250.0, 250.0, 300.0, 250.5],
            [250.0, 250.0, 290.0, 281.0],
            [250.0, 250.0, 263.7, 300.0],
            [250.0, 250.0, 199.3, 263.1],
            [250.0, 250.0, 231.0, 191.0],
        ],
        boxes: vec![[180.0, 90.0, 230.0, 130.0], [220.0, 110.0, 270.0, 150.0]],
        charger,
        light: Some(([12.0, 12.0], 400.0)),
        ..Written::room(340.0, 320.0)
    };
    vec![Place::of("beams", beams), Place::of("posts", posts), Place::of("fan", fan)]
}

pub(super) fn places() -> Vec<Place> {
    let mut places = offices();
    places.extend(slanted());
    places
}

/// Robots after some steps, which both backends carry out.
fn stepped(shared: &CohortData, robots: &[Robot], steps: u32) -> Vec<Robot> {
    let [plain, tuned] = [reference_backend(2, None), cpu_backend(2, None)].map(|backend| {
        let mut robots = robots.to_vec();
        backend.expect("two threads can be started").step(shared, &mut robots, steps).expect("the CPU steps");
        robots
    });
    assert_eq!(parity::step(&plain, &tuned), None);
    plain
}

/// What a robot without noise senses, through the shipped kernel.
fn sense(shared: &CohortData, poses: &[Pose]) -> Vec<SensorValues> {
    let robots: Vec<Robot> = poses.iter().map(|pose| robot_at(*pose, &SILENT, 1, 2)).collect();
    stepped(shared, &robots, 1).iter().map(SensorValues::of).collect()
}

/// The body after an action whose length is off by the factor `slip`.
#[track_caller]
fn carry(place: &Place, pose: Pose, action: u32, slip: f32) -> Moved {
    seen(&place.shared, &[], &[], |group| (group.forms.move_body)(group, pose.x, pose.y, pose.heading, action, slip))
}

fn at(pose: Pose) -> P {
    [f64::from(pose.x), f64::from(pose.y)]
}
