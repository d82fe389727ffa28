//! The simulator against closed forms and an independent geometry in f64 (`oracle`): sonar, motion, bumpers, light,
//! compass, docking, doors, noise. Slanted walls included.

mod oracle;

use oracle::{Field, P, Written, ahead, office, stream};
use skilltree::backend::Backend;
use skilltree::backend::cpu::CpuBackend;
use skilltree::backend::parity::{self, UNWRITTEN};
use skilltree::env::contact::{bumpers, sweep};
use skilltree::env::events::{passed_door, room_of};
use skilltree::env::light::in_sight;
use skilltree::env::motion::{BACKWARD, COLLISION, DOCKED, FORWARD, Moved, NO_ACTION, PASSED_DOOR, move_body};
use skilltree::env::segments::{LISTED_TRAVEL, SegmentGrid};
use skilltree::env::sonar::{ranges, rays};
use skilltree::env::workgroup::CohortData;
use skilltree::layout::Noise;
use skilltree::layout::choices::{NOISE_GAUSSIAN, NOISE_UNIFORM};
use skilltree::layout::{BASE_WORDS, RAYS, Robot};
use skilltree::math::functions::sin_cos;
use skilltree::math::rng::place_of;
use skilltree::train::observation::{Observation, SILENT, floor_only, robot_at};
use skilltree::world::{Pose, World};

/// What the brief allows between f32 and exact geometry, inches.
const CLOSE: f64 = 1.0e-3;
const BODY: f64 = 12.0;

/// A world with its exact geometry.
struct Place {
    name: String,
    world: World,
    field: Field,
    written: Written,
    shared: CohortData,
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
    fn pose(&self, next: &mut impl FnMut() -> f64, room: f64) -> Pose {
        loop {
            let x = (next() * f64::from(self.world.size.x)) as f32;
            let y = (next() * f64::from(self.world.size.y)) as f32;
            if self.field.free([f64::from(x), f64::from(y)], BODY + room) {
                return Pose { x, y, heading: (next() * 359.99) as f32 };
            }
        }
    }

    fn ranges(&self, pose: Pose) -> [f32; RAYS] {
        let (sine, cosine) = sin_cos(pose.heading);
        let (ux, uy) = rays(cosine, sine);
        let found = ranges(&self.shared.floor, pose.x, pose.y, &ux, &uy);
        std::array::from_fn(|ray| found[place_of(ray)])
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

fn places() -> Vec<Place> {
    let mut places = offices();
    places.extend(slanted());
    places
}

fn cpu() -> CpuBackend {
    CpuBackend::new(2, None).expect("two threads can be started")
}

/// What a robot without noise senses, through the shipped kernel.
fn sense(shared: &CohortData, poses: &[Pose]) -> Vec<Observation> {
    let mut robots: Vec<Robot> = poses.iter().map(|pose| robot_at(*pose, &SILENT, 1, 2)).collect();
    cpu().step(shared, &mut robots, 1).expect("the CPU steps");
    robots.iter().map(Observation::of).collect()
}

fn at(pose: Pose) -> P {
    [f64::from(pose.x), f64::from(pose.y)]
}

// Sonar.

#[test]
fn sonar_ranges_and_readings_match_rays_walked_through_the_distance_field() {
    for place in places() {
        let mut next = stream(11);
        let poses: Vec<Pose> = (0..3000).map(|_| place.pose(&mut next, 0.0)).collect();
        let senses = sense(&place.shared, &poses);
        let (mut rays_in_all, mut grazing, mut near_half, mut echoes) = (0, 0, 0, 0);
        for (pose, senses) in poses.iter().zip(&senses) {
            let found = place.ranges(*pose);
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

/// A floor whose cells list all segments.
fn unculled(place: &Place) -> SegmentGrid {
    let mut plan = place.shared.floor.plan;
    let cells = plan.cell_columns * plan.cell_rows;
    let starts = (0..=cells).map(|cell| cells + 1 + cell * plan.segments);
    let tables: Vec<u32> = starts.chain((0..cells).flat_map(|_| 0..plan.segments)).collect();
    (plan.cell_starts, plan.sight_starts) = (0, 0);
    SegmentGrid::new(&plan, &tables)
}

#[test]
fn culled_segment_lists_change_no_bit_of_any_sense() {
    for place in places() {
        let (culled, full) = (&place.shared.floor, unculled(&place));
        let mut next = stream(12);
        let (mut shorter, mut dark) = (0, 0);
        for _ in 0..4000 {
            let pose = place.pose(&mut next, 0.0);
            let (x, y) = (pose.x, pose.y);
            let (sine, cosine) = sin_cos(pose.heading);
            let (ux, uy) = rays(cosine, sine);
            let found = [culled, &full].map(|floor| ranges(floor, x, y, &ux, &uy).map(f32::to_bits));
            assert_eq!(found[0], found[1], "{}: {pose:?}", place.name);
            assert_eq!(in_sight(culled, x, y), in_sight(&full, x, y), "{}: {pose:?}", place.name);
            dark += u32::from(!in_sight(culled, x, y));
            shorter += u32::from(culled.audible(x, y).1 < full.audible(x, y).1);
        }
        assert!(shorter > 1000, "{}: the lists leave something out at {shorter} poses", place.name);
        assert!(dark > 200, "{}: the light is hidden at {dark} poses", place.name);
    }
}

#[test]
fn lists_of_what_can_be_touched_change_no_bit_of_any_move() {
    for place in places() {
        let floor = &place.shared.floor;
        let cosine_of_docking = floor.plan.dock_cosine;
        let mut next = stream(17);
        let (mut shorter, mut stops) = (0, 0);
        for _ in 0..20_000 {
            let pose = place.pose(&mut next, 0.0);
            let reach = next() as f32 * LISTED_TRAVEL;
            let (uy, ux) = sin_cos(pose.heading);
            let near = floor.touchable(pose.x, pose.y, reach);
            let [some, all] = [near, &floor.all].map(|list| {
                let travel = sweep(list, cosine_of_docking, pose.x, pose.y, ux, uy, reach);
                let (x, y) = (pose.x + ux * travel.distance, pose.y + uy * travel.distance);
                (travel, bumpers(list, x, y, ux, uy))
            });
            assert_eq!(some, all, "{}: {pose:?} for {reach}", place.name);
            shorter += u32::from(near.len() < floor.all.len());
            stops += u32::from(all.0.blocked);
        }
        assert!(stops > 1000, "{}: {stops} moves were stopped", place.name);
        assert!(place.name != "office" || shorter > 10_000, "{}: {shorter} lists leave something out", place.name);
        assert_eq!(floor.touchable(100.0, 100.0, 1.01 * LISTED_TRAVEL).len(), floor.all.len());
    }
}

// Motion.

fn carry(place: &Place, pose: Pose, action: u32, slip: f32) -> Moved {
    move_body(&place.shared.floor, pose.x, pose.y, pose.heading, action, slip)
}

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
    let gone = oracle::length(oracle::sub([f64::from(moved.x), f64::from(moved.y)], here));
    let say = || format!("{}: {pose:?} action {action} slip {slip}: went {gone}, {moved:?}", place.name);
    let line = ahead(here, bearing, gone);
    assert!(oracle::length(oracle::sub([f64::from(moved.x), f64::from(moved.y)], line)) < CLOSE, "{}", say());

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
        let mut next = stream(13);
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
                        let off = oracle::length(oracle::sub(end, [f64::from(moved.x), f64::from(moved.y)]));
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

// Bumpers.

#[test]
fn bumpers_feel_four_sectors_within_the_gap() {
    let place = Place::of("room", Written::room(200.0, 200.0));
    let feel = |x: f32, y: f32, heading: f32| {
        let (sine, cosine) = sin_cos(heading);
        bumpers(place.shared.floor.touchable(x, y, 0.0), x, y, cosine, sine)
    };
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
        let mut next = stream(14);
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
            let (sine, cosine) = sin_cos(pose.heading);
            let near = place.shared.floor.touchable(pose.x, pose.y, 0.0);
            let found = bumpers(near, pose.x, pose.y, cosine, sine);
            assert_eq!(found, expected, "{}: {pose:?} {touches:?}", place.name);
            judged += 1;
            for (side, count) in felt.iter_mut().enumerate() {
                *count += (found >> side) & 1;
            }
        }
        assert!(felt.iter().all(|count| *count > 300) && skipped < 400, "{}: {felt:?} {skipped}", place.name);
    }
}

// Light and compass.

#[test]
fn light_bits_follow_brightness_and_line_of_sight() {
    for place in places() {
        let (lamp, range) = place.written.light.expect("the world has a light");
        let sharp = 1.0 / 15.0_f64.to_radians().powi(2);
        let mut next = stream(15);
        let poses: Vec<Pose> = (0..4000).map(|_| place.pose(&mut next, 0.0)).collect();
        let (mut seen, mut hidden, mut lit, mut dark, mut skipped) = (0, 0, 0, 0, 0);
        for (pose, senses) in poses.iter().zip(sense(&place.shared, &poses)) {
            let way = oracle::sub(lamp, at(*pose));
            let far = oracle::length(way);
            let side = [-way[1] / far * 1.0e-3, way[0] / far * 1.0e-3];
            let views = [-1.0, 0.0, 1.0]
                .map(|k| place.field.sees([at(*pose)[0] + k * side[0], at(*pose)[1] + k * side[1]], lamp));
            if views.iter().any(|view| *view != views[0]) {
                skipped += 1;
                continue;
            }
            let visible = views[0];
            assert_eq!(in_sight(&place.shared.floor, pose.x, pose.y), visible, "{}: {pose:?}", place.name);
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

// Docking and doors.

/// A robot that would touch the charger at `contact` with the body's centre on bearing `from` of it, driving with its
/// heading `off` degrees beside the contact point, from `away` inches before contact.
fn approach(contact: P, from: f64, off: f64, away: f64) -> Pose {
    let centre = ahead(contact, from, BODY);
    let heading = (from + 180.0 + off).rem_euclid(360.0);
    let start = ahead(centre, heading, -away);
    Pose { x: start[0] as f32, y: start[1] as f32, heading: heading as f32 }
}

#[test]
fn docking_needs_the_charger_within_thirty_degrees_of_the_heading() {
    let island = Written { charger: Some([90.0, 90.0, 114.0, 114.0]), ..Written::room(200.0, 200.0) };
    let place = Place::of("island", island);
    // Middles of all four sides, then all four corners from three bearings each.
    let mut contacts =
        vec![([114.0, 101.0], 0.0), ([101.0, 114.0], 90.0), ([90.0, 101.0], 180.0), ([101.0, 90.0], 270.0)];
    for (corner, bearing) in
        [([114.0, 114.0], 45.0), ([90.0, 114.0], 135.0), ([90.0, 90.0], 225.0), ([114.0, 90.0], 315.0)]
    {
        contacts.extend([-25.0, 0.0, 25.0].map(|more| (corner, bearing + more)));
    }
    for (contact, from) in contacts {
        for off in [0.0, 10.0, -10.0, 29.0, -29.0, 31.0, -31.0, 50.0, -50.0] {
            let expected = if f64::abs(off) < 30.0 { DOCKED } else { COLLISION };
            let pose = approach(contact, from, off, 5.0);
            let moved = carry(&place, pose, FORWARD, 1.0);
            assert_eq!(moved.events, expected, "{contact:?} from {from}, {off} off: {pose:?}");
            let end = ahead(contact, from, BODY);
            let gap = oracle::length(oracle::sub(end, [f64::from(moved.x), f64::from(moved.y)]));
            assert!(gap < CLOSE, "{contact:?} from {from}, {off} off: {gap}");
            // Once it touches, another push docks all the same, and backing into it never does.
            let there = Pose { x: moved.x, y: moved.y, heading: pose.heading };
            assert_eq!(carry(&place, there, FORWARD, 1.0).events, expected, "{contact:?} from {from}, {off} off again");
            let turned = Pose { heading: (pose.heading + 180.0).rem_euclid(360.0), ..pose };
            assert_eq!(carry(&place, turned, BACKWARD, 1.0).events, COLLISION, "{contact:?} from {from}, {off} off");
            // Too short a move touches nothing.
            assert_eq!(carry(&place, pose, FORWARD, 4.9 / 12.0).events, 0);
        }
    }
    let walls_only = Place::of("bare", Written::room(200.0, 200.0));
    assert_eq!(carry(&walls_only, Pose { x: 15.0, y: 100.0, heading: 180.0 }, FORWARD, 1.0).events, COLLISION);
}

/// A robot that touches a wall and the charger at once, and pushes against both, docks, whichever lanes the segments
/// fall on: a world of more than 32 segments is dealt out to the lanes in turns.
#[test]
fn docking_beside_a_wall_does_not_depend_on_the_number_of_segments() {
    for extra in 0..40 {
        let walls = (0..extra).map(|i| [60.0, 60.0 + f64::from(i), 70.0, 60.0 + f64::from(i)]).collect();
        let corner = Written { walls, charger: Some([0.0, 0.0, 24.0, 24.0]), ..Written::room(200.0, 150.0) };
        let place = Place::of("corner", corner);
        let pose = Pose { x: 36.0, y: 12.0, heading: 185.0 };
        assert_eq!(carry(&place, pose, FORWARD, 1.0).events, DOCKED, "with {extra} walls elsewhere");
    }
}

#[test]
fn doors_are_passed_beyond_the_doorway_in_another_room() {
    for place in offices() {
        let plan = &place.shared.floor.plan;
        let mut next = stream(16);
        let room = |p: P| {
            place.world.rooms.iter().position(|room| {
                let (low, high) = (room.area.min, room.area.max);
                p[0] >= f64::from(low.x)
                    && p[0] < f64::from(high.x)
                    && p[1] >= f64::from(low.y)
                    && p[1] < f64::from(high.y)
            })
        };
        let (mut passed, mut waiting) = (0, 0);
        for _ in 0..20_000 {
            let pose = place.pose(&mut next, 0.0);
            // In the shipped worlds every door leads up through a wall 8 in thick: its frame is a radius wider on each
            // side, and 13 in deeper on both faces.
            let in_frame = place.world.doors.iter().any(|door| {
                let (dx, dy) = (at(pose)[0] - f64::from(door.centre.x), at(pose)[1] - f64::from(door.centre.y));
                (-37.0..37.0).contains(&dx) && (-17.0..17.0).contains(&dy)
            });
            for origin in 0..3 {
                let elsewhere = room(at(pose)).is_some_and(|room| room != origin);
                let expected = elsewhere && !in_frame;
                let found = passed_door(plan, origin as u32, pose.x, pose.y) == PASSED_DOOR;
                assert_eq!(found, expected, "{}: {pose:?} from room {origin}", place.name);
                passed += u32::from(expected);
                waiting += u32::from(elsewhere && in_frame);
            }
        }
        assert!(passed > 10_000 && waiting > 300, "{}: {passed} {waiting}", place.name);
    }
    // A drive through the left door of the office: nothing until the body is clear on the far side.
    let place = &offices()[0];
    let mut pose = Pose { x: 64.0, y: 150.0, heading: 90.0 };
    let mut heights = Vec::new();
    let origin = room_of(&place.shared.floor.plan, pose.x, pose.y);
    for _ in 0..10 {
        let moved = carry(place, pose, FORWARD, 1.0);
        pose = Pose { x: moved.x, y: moved.y, heading: moved.heading };
        if passed_door(&place.shared.floor.plan, origin, pose.x, pose.y) == PASSED_DOOR {
            heights.push(pose.y);
        }
    }
    assert_eq!(heights, [222.0, 234.0, 246.0, 258.0, 270.0]);
}

// Noise.

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
    let mut robots: Vec<Robot> = (0..count).map(|seed| Robot { action, ..robot_at(pose, noise, 1993, seed) }).collect();
    cpu().step(&place.shared, &mut robots, 1).expect("the CPU steps");
    robots
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
        let senses: Vec<Observation> = still.iter().map(Observation::of).collect();
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
    assert!(quiet.iter().all(|r| Observation::of(r).compass == 0.0 && Observation::of(r).sonar[0] == 48));
}

/// The CPU moves robots side by side: in any number, with and without an action, and with anything in what a step writes.
#[test]
fn a_robot_among_others_is_the_robot_alone() {
    let place = &offices()[0];
    let noise = Noise { kind: NOISE_GAUSSIAN, actuator: 0.08, sonar: 0.10, light: 0.10, compass: 2.865 };
    let mut next = stream(31);
    let mut robot = |number: u32| {
        let kind = if number % 5 == 1 { NOISE_UNIFORM } else { NOISE_GAUSSIAN };
        let mut robot = robot_at(place.pose(&mut next, 0.0), &Noise { kind, ..noise }, 7, number);
        robot.action = if number % 7 == 6 { NO_ACTION } else { number % 6 };
        robot.record = [UNWRITTEN; BASE_WORDS];
        robot
    };
    let robots: Vec<Robot> = (0..75).map(&mut robot).collect();
    let alone: Vec<Robot> = robots
        .iter()
        .flat_map(|robot| {
            let mut alone = [*robot];
            cpu().step(&place.shared, &mut alone, 3).expect("the CPU steps");
            alone
        })
        .collect();
    // As a workgroup leaves what no step writes.
    assert!(alone.iter().all(|robot| robot.record[8..] == [0, 0]));
    assert!(alone.iter().any(|robot| robot.record[6] & 0xff_ffff != 0), "no light was seen");
    assert!(alone.iter().any(|robot| robot.events == COLLISION), "nothing was touched");
    for count in [2, 15, 16, 17, 33, 75] {
        let mut together = robots[..count].to_vec();
        cpu().step(&place.shared, &mut together, 3).expect("the CPU steps");
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
        let mut robots: Vec<Robot> = (0..count).map(|seed| robot_at(pose, &noise, 5, seed)).collect();
        cpu().step(&place.shared, &mut robots, 1).expect("the CPU steps");
        let lit = robots.iter().filter(|robot| robot.record[6] & 1 == 1).count() as f64;
        let bright = (60.0 / distance).powi(2);
        let expected = tail((1.0 / bright - 1.0) / 0.10);
        let error = (expected * (1.0 - expected) / f64::from(count)).sqrt();
        let found = lit / f64::from(count);
        assert!((found - expected).abs() < 4.0 * error + 1.0e-4, "{distance} in: {found} for {expected}");
    }
    // The test's own tail: symmetric, and nothing beyond.
    assert!((tail(0.0) - 0.5).abs() < 1.0e-12 && tail(3.5).abs() < 1.0e-12);
}
