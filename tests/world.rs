//! Worlds: geometry against brute force, complete lists, safe start cells, and a good message for every mistake.

use glam::{DVec2, Vec2};
use skilltree::config::{ConfigError, Place};
use skilltree::world::tables::{LIST_CELL, Tables};
use skilltree::world::{WallSegment, World, load, parse};
use std::path::{Path, PathBuf};

const OFFICES: [&str; 3] = ["office", "office-easy", "office-hard"];

fn office(name: &str) -> World {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("configs/worlds/{name}.toml"));
    load(&path).unwrap_or_else(|error| panic!("{error}")).0
}

/// A small repeatable stream of numbers in 0..1, for picking points.
fn stream(mut state: u64) -> impl FnMut() -> f64 {
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Distance to a segment by walking along it: too large by at most half a stride, and far away by much less.
fn walked_distance(at: DVec2, segment: &WallSegment, stride: f64) -> f64 {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let steps = (a.distance(b) / stride).ceil().max(1.0) as u32;
    (0..=steps).map(|i| at.distance(a.lerp(b, f64::from(i) / f64::from(steps)))).fold(f64::INFINITY, f64::min)
}

fn in_box(at: DVec2, low: Vec2, high: Vec2) -> bool {
    let (low, high) = (low.as_dvec2(), high.as_dvec2());
    at.x > low.x && at.x < high.x && at.y > low.y && at.y < high.y
}

fn solid(world: &World, at: DVec2) -> bool {
    world.boxes.iter().any(|b| in_box(at, b.min, b.max))
}

#[test]
fn offices_have_the_published_parts() {
    for name in OFFICES {
        let world = office(name);
        assert_eq!(world.name, name);
        assert_eq!(world.size, Vec2::new(360.0, 420.0));
        let rooms: Vec<&str> = world.rooms.iter().map(|room| room.name.as_str()).collect();
        assert_eq!(rooms, ["A", "B", "C"]);
        assert_eq!(world.doors.len(), 2);
        for door in &world.doors {
            assert_eq!((door.depth, door.normal, door.width), (8.0, Vec2::Y, 50.0));
        }
        let room_of = |place: usize| {
            let pose = world.places[place].1;
            world.room_of(Vec2::new(pose.x, pose.y)).map(|i| world.rooms[i].name.clone())
        };
        assert_eq!(room_of(0).as_deref(), Some("B"));
        assert_eq!(room_of(1).as_deref(), Some("A"));
        let light = world.light.expect("the office has a light");
        let l2 = world.places[1].1;
        assert!(world.sees(Vec2::new(l2.x, l2.y), light.at));
    }
}

#[test]
fn clearance_matches_walking_along_every_side() {
    for name in OFFICES {
        let world = office(name);
        let mut next = stream(7);
        let stride = 0.25;
        // The outline as the file has it, hidden sides included, written down again from the boxes.
        let mut outline = Vec::new();
        let mut add = |low: Vec2, high: Vec2| {
            let c = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
            outline.extend((0..4).map(|i| WallSegment { a: c[i], b: c[(i + 1) % 4], charger: false }));
        };
        add(Vec2::ZERO, world.size);
        world.boxes.iter().for_each(|b| add(b.min, b.max));
        let charger = world.charger.expect("the office has a charger").area;
        add(charger.min, charger.max);
        for _ in 0..1000 {
            let at = DVec2::new(next() * 360.0, next() * 420.0);
            let got = f64::from(world.clearance(at.as_vec2()));
            if solid(&world, at) || in_box(at, charger.min, charger.max) {
                assert!(got <= 0.0, "{name} {at}: {got}");
            } else {
                let want = outline.iter().map(|s| walked_distance(at, s, stride)).fold(f64::INFINITY, f64::min);
                assert!(got <= want + 1e-3 && got >= want - stride / 2.0, "{name} {at}: {got} {want}");
            }
        }
        assert!(world.clearance(Vec2::new(-3.0, 100.0)) < 0.0);
        assert!(world.clearance(Vec2::new(100.0, 425.0)) < 0.0);
    }
}

#[test]
fn line_of_sight_matches_sampling_the_line() {
    for name in OFFICES {
        let world = office(name);
        let mut next = stream(11);
        let (mut seen, mut hidden) = (0, 0);
        for _ in 0..1500 {
            let from = DVec2::new(next() * 360.0, next() * 420.0);
            let to = DVec2::new(next() * 360.0, next() * 420.0);
            if solid(&world, from) || solid(&world, to) {
                continue;
            }
            let at = |i: u32| from.lerp(to, f64::from(i) / 2000.0);
            // A line that only grazes a corner may fall between samples: leave such pairs out.
            let depth = |b: &skilltree::world::Rect, p: DVec2| {
                (p.x - f64::from(b.min.x))
                    .min(f64::from(b.max.x) - p.x)
                    .min((p.y - f64::from(b.min.y)).min(f64::from(b.max.y) - p.y))
            };
            let deepest = (0..=2000)
                .flat_map(|i| world.boxes.iter().map(move |b| depth(b, at(i))))
                .fold(f64::NEG_INFINITY, f64::max);
            if deepest.abs() < 0.3 {
                continue;
            }
            assert_eq!(world.sees(from.as_vec2(), to.as_vec2()), deepest < 0.0, "{name} {from} {to}");
            if deepest < 0.0 { seen += 1 } else { hidden += 1 }
        }
        assert!(seen > 100 && hidden > 100, "{seen} {hidden}");
    }
}

#[test]
fn the_charger_hides_nothing_and_walls_do() {
    let world = office("office");
    assert!(world.sees(Vec2::new(60.0, 60.0), Vec2::new(12.0, 12.0)));
    assert!(!world.sees(Vec2::new(200.0, 30.0), Vec2::new(12.0, 12.0)));
    // Along a wall, and on both sides of its end.
    let thin = parse("size=[100,100]\nwalls=[[50,0,50,60]]\nrooms=[{name='A',box=[0,0,100,100]}]", Path::new("t.toml"))
        .expect("a thin wall");
    assert!(thin.sees(Vec2::new(50.0, 70.0), Vec2::new(50.0, 90.0)));
    assert!(!thin.sees(Vec2::new(50.0, 70.0), Vec2::new(50.0, 20.0)));
    assert!(!thin.sees(Vec2::new(40.0, 60.0), Vec2::new(60.0, 60.0)));
    assert!(thin.sees(Vec2::new(40.0, 60.1), Vec2::new(60.0, 60.1)));
}

/// Distance at which a ray meets a segment, by Cramer's rule.
fn met(from: DVec2, way: DVec2, segment: &WallSegment) -> Option<f64> {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let along = b - a;
    let determinant = along.perp_dot(way);
    let share = (from - a).perp_dot(way) / determinant;
    let range = (from - a).perp_dot(along) / determinant;
    (determinant != 0.0 && (0.0..=1.0).contains(&share) && range > 0.0).then_some(range)
}

#[test]
fn lists_hold_whatever_a_robot_can_hear() {
    for name in OFFICES {
        let world = office(name);
        let tables = Tables::new(&world);
        let plan = &tables.plan;
        assert_eq!((plan.cell_columns, plan.cell_rows), (30, 35));
        let list = |cell: u32| {
            let at = (plan.cell_starts + cell) as usize;
            &tables.words[tables.words[at] as usize..tables.words[at + 1] as usize]
        };
        let mut next = stream(13);
        let (mut left_out, mut heard) = (0, 0);
        for _ in 0..3000 {
            let at = DVec2::new(next() * 360.0, next() * 420.0);
            let cell = (at / LIST_CELL).floor();
            let near = list(cell.y as u32 * plan.cell_columns + cell.x as u32);
            assert!(near.is_sorted() && near.windows(2).all(|pair| pair[0] != pair[1]));
            // Not everything is listed: farther than the reach and a cell's diagonal is left out.
            for (i, segment) in world.segments.iter().enumerate() {
                let listed = near.contains(&(i as u32));
                let distance = walked_distance(at, segment, 1.0);
                assert!(!listed || distance < 127.5 + 17.0 + 0.1, "{name} {at}: segment {i} at {distance}");
                left_out += usize::from(!listed);
            }
            if !world.is_free(at.as_vec2()) {
                continue;
            }
            // Whatever a ray meets first is listed.
            for _ in 0..24 {
                let way = DVec2::from_angle(next() * std::f64::consts::TAU);
                let hits = world.segments.iter().enumerate().filter_map(|(i, s)| Some((met(at, way, s)?, i as u32)));
                let Some((range, first)) = hits.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
                assert!(range > 127.0 || near.contains(&first), "{name} {at} {way}: segment {first} at {range}");
                heard += usize::from(range < 127.0);
            }
        }
        assert!(left_out > 0 && heard > 10_000, "{left_out} {heard}");
    }
}

#[test]
fn the_plan_repeats_the_world() {
    let world = office("office");
    let mut tables = Tables::new(&world);
    let plan = tables.plan;
    assert_eq!((plan.segments as usize, plan.rooms, plan.doors, plan.lit), (world.segments.len(), 3, 2, 1));
    assert_eq!((plan.light_x, plan.light_y, plan.light_range2), (12.0, 12.0, 52_900.0));
    assert_eq!(plan.dock_cosine, (30.0_f64.to_radians().cos()) as f32);
    let door = plan.doorway[0];
    assert_eq!((door.x0, door.x1, door.y0, door.y1), (27.0, 101.0, 187.0, 221.0));
    let charging = world.segments.iter().filter(|s| s.charger).count();
    assert_eq!(charging, 2, "two sides of the charger stand against the outer walls");
    for (segment, written) in plan.segment.iter().zip(&world.segments) {
        assert_eq!((segment.ax, segment.ay), (written.a.x, written.a.y));
        assert_eq!((segment.bx, segment.by), (written.b.x, written.b.y));
        assert!((segment.tx.hypot(segment.ty) - 1.0).abs() < 1e-6);
        assert!((segment.length - written.a.distance(written.b)).abs() < 1e-4);
    }
    let before = tables.words.len();
    assert_eq!(tables.add_cells(&[5, 6]), (before as u32, 2));
    assert_eq!(tables.add_table(&[0.5]), before as u32 + 2);
    assert_eq!(tables.words[before..], [5, 6, 0.5_f32.to_bits()]);
}

#[test]
fn robots_fit_anywhere_in_every_start_cell() {
    for name in OFFICES {
        let world = office(name);
        let names = world.region_names();
        assert_eq!(names, ["anywhere", "light-area", "near-doors", "room:A", "room:B", "room:C"]);
        let mut next = stream(17);
        for region in names {
            let cells = world.region_cells(&region).expect("a listed region");
            assert!(cells.len() > 100, "{name} {region}: {}", cells.len());
            // A few of them: walking along every side is slow.
            for cell in cells.into_iter().step_by(11) {
                let corner = DVec2::new(f64::from(cell & 0xffff), f64::from(cell >> 16)) * 2.0;
                for _ in 0..3 {
                    let at = corner + DVec2::new(next(), next()) * 2.0;
                    let near = world.segments.iter().map(|s| walked_distance(at, s, 0.5)).fold(f64::INFINITY, f64::min);
                    assert!(near >= 12.0 - 1e-4 && !solid(&world, at), "{name} {region} {at}: {near}");
                }
                let room = world.room_of((corner + 1.0).as_vec2()).map(|i| &world.rooms[i].name);
                assert!(room.is_some());
                if let Some(wanted) = region.strip_prefix("room:") {
                    assert_eq!(room.map(String::as_str), Some(wanted));
                }
                if region == "light-area" {
                    assert!((corner + 1.0).distance(DVec2::splat(12.0)) <= 140.0 && room.is_some_and(|r| r == "A"));
                }
            }
        }
        assert!(world.region_cells("room:D").is_none());
        assert!(world.region_cells("room:").is_none());
    }
}

#[test]
fn a_world_may_name_regions() {
    let text = "size=[100,100]\nrooms=[{name='A',box=[0,0,100,100]}]\nregions=[{name='corner',box=[0,0,40,40]}]";
    let world = parse(text, Path::new("t.toml")).expect("a world with a region");
    assert_eq!(world.region_names(), ["anywhere", "room:A", "corner"]);
    let cells = world.region_cells("corner").expect("the region");
    // Centres from 15 to 39 inches, every 2 inches, in both directions.
    assert_eq!(cells.len(), 13 * 13);
    assert!(world.region_cells("light-area").is_none(), "no light, no light area");
}

const BASE: &str = "\
size = [200, 200]
boxes = [[0, 96, 80, 104], [130, 96, 200, 104]]
rooms = [{ name = 'A', box = [0, 0, 200, 96] }, { name = 'B', box = [0, 104, 200, 200] }]
doors = [{ name = 'd', rooms = ['A', 'B'], centre = [105, 100], width = 50 }]
charger = { box = [0, 0, 24, 24] }
light = { at = [12, 12], range = 100 }
places = { L1 = [100, 50, -90] }
";

fn complaint(from: &str, to: &str) -> ConfigError {
    assert!(BASE.contains(from), "{from}");
    match parse(&BASE.replacen(from, to, 1), Path::new("worlds/w.toml")) {
        Ok(_) => panic!("accepted: {to}"),
        Err(error) => error,
    }
}

#[test]
fn the_base_of_the_mistakes_is_fine() {
    let world = parse(BASE, Path::new("worlds/w.toml")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(world.name, "w");
    assert_eq!(world.places[0].1.heading, 270.0);
    assert_eq!(world.charger.map(|c| c.tolerance), Some(30.0));
    assert_eq!(world.light.map(|l| l.area), Some(140.0));
}

#[test]
fn every_mistake_has_its_line_and_a_hint() {
    // What is replaced, by what, the line of the complaint (0: the file), words of its message, words of its hint.
    let mistakes: &[(&str, &str, usize, &str, &str)] = &[
        ("light =", "ligth =", 6, "unknown key `ligth`", "did you mean `light`"),
        ("range = 100", "rnge = 100", 6, "`light.range` is missing", "`rnge` was found; did you mean `range`"),
        ("light = { at", "light = { glow = 3, at", 6, "unknown key `light.glow`", "`at`, `range`, `area`"),
        ("size = [200, 200]", "size = 'big'", 1, "must be a list of 2 numbers", "[width, height]"),
        ("size = [200, 200]", "size = [200]", 1, "must have 2 numbers, not 1", "[width, height]"),
        ("size = [200, 200]", "size = [200, -200]", 1, "out of range", "between 48 and 2000"),
        ("size = [200, 200]", "size = [200, nan]", 1, "`nan` is not a number", "finite"),
        ("size = [200, 200]", "size = [inf, 200]", 1, "`inf` is not a number", "finite"),
        ("size = [200, 200]", "size = [200, 1e999]", 1, "not a number", "finite"),
        ("size = [200, 200]", "size = [200, 99999999999999999999]", 1, "too large", "digits"),
        ("size = [200, 200]", "size = [2000000, 200]", 1, "out of range", "between 48 and 2000"),
        ("size = [200, 200]\n", "", 0, "`size` is missing", "size = [360, 420]"),
        ("size = [200, 200]", "size = [200 200]", 1, "not valid TOML", "lists need commas"),
        ("boxes = [[0", "boxes = [[-5", 2, "outside the floor", "0, 0 to 200, 200"),
        ("boxes = [[0, 96, 80, 104]", "boxes = [[80, 96, 0, 104]", 2, "no area", "x1 < x2"),
        ("boxes = [[0, 96, 80, 104]", "boxes = [[0, 96, 0, 104]", 2, "no area", "x1 < x2"),
        ("boxes = ", "walls = [[5, 5, 5, 5]]\nboxes = ", 2, "no length", "differ"),
        ("boxes = ", "walls = [[5, 5, 5, 500]]\nboxes = ", 2, "outside the floor", "200, 200"),
        ("boxes = ", "walls = 5\nboxes = ", 2, "must be a list, not a whole number", "[ ..., ... ]"),
        ("box = [0, 104,", "box = [0, 90,", 3, "`A` and `B` overlap", "both hold 0, 90 to 200, 96"),
        ("name = 'B'", "name = 'A'", 3, "`A` is there already", "once"),
        ("name = 'B'", "name = 'B room'", 3, "cannot be a name", "letters"),
        ("['A', 'B']", "['A', 'b']", 4, "`b` is not one of the rooms", "did you mean `B`"),
        ("['A', 'B']", "['A']", 4, "joins two rooms", "rooms ="),
        ("['A', 'B']", "['A', 'A']", 4, "joins `A` to itself", "two rooms"),
        ("centre = [105, 100]", "centre = [105, 120]", 4, "not between its rooms", "y must lie between 96 and 104"),
        ("centre = [105, 100]", "centre = [190, 100]", 4, "reaches beyond its rooms", "from 0 to 200"),
        ("centre = [105, 100]", "centre = [90, 100]", 4, "blocked by something solid", "free"),
        ("boxes = [", "boxes = [[90, 104, 120, 110], ", 4, "blocked by something solid", "free"),
        ("boxes = [", "boxes = [[95, 106, 120, 110], ", 4, "blocked by something solid", "free"),
        ("boxes = ", "walls = [[110, 90, 110, 110]]\nboxes = ", 5, "blocked by something solid", "free"),
        ("width = 50", "width = 24", 4, "too narrow", "24 inches across"),
        ("width = 50", "width = -1", 4, "out of range", "more than 0"),
        ("box = [0, 104, 200, 200]", "box = [150, 104, 160, 200]", 4, "reaches beyond", "from 150 to 160"),
        ("charger = { box = [0, 0, 24, 24] }", "charger = { box = [190, 0, 214, 24] }", 5, "outside the floor", "200"),
        ("24, 24] }", "24, 24], tolerance = 0 }", 5, "out of range", "more than 0 and at most 180"),
        ("at = [12, 12]", "at = [12, 212]", 6, "outside the floor", "200"),
        ("at = [12, 12]", "at = [40, 100]", 6, "inside something solid", "charger"),
        ("range = 100", "range = 0", 6, "out of range", "more than 0"),
        ("range = 100", "range = 100, area = -3", 6, "out of range", "more than 0"),
        ("L1 = [100, 50, -90]", "L1 = [40, 100, 0]", 7, "does not fit at the place `L1`", "inside something solid"),
        ("L1 = [100, 50, -90]", "L1 = [100, 5, 0]", 7, "does not fit at the place `L1`", "5.0 inches away"),
        ("L1 = [100, 50, -90]", "L1 = [30, 30, 0]", 7, "does not fit at the place `L1`", "8.5 inches away"),
        ("L1 = [100, 50, -90]", "L1 = [500, 50, 0]", 7, "outside the floor", "200"),
        ("L1 = [100, 50, -90]", "L1 = [100, 50]", 7, "must have 3 numbers", "[x, y, heading]"),
        ("L1 = [100, 50, -90]", "L1 = [100, 50, true]", 7, "must be a number, not true or false", "number"),
        ("places =", "regions = [{ name = 'anywhere', box = [0, 0, 9, 9] }]\nplaces =", 7, "there already", "once"),
        ("places =", "when = 2020-01-01\nplaces =", 7, "dates have no meaning", "quotes"),
        ("L1 = [100", "L1 = [1, 1, 1], L1 = [100", 7, "duplicate key", "toml.io"),
    ];
    for &(from, to, line, message, hint) in mistakes {
        let error = complaint(from, to);
        let text = error.to_string();
        println!("{text}\n");
        match error.place() {
            Place::Line { path, line: at, .. } => {
                assert_eq!((path, *at), (&PathBuf::from("worlds/w.toml"), line), "{to}\n{text}");
                assert!(text.contains(&format!("worlds/w.toml:{line}:")), "{text}");
            }
            Place::File(_) => assert_eq!(line, 0, "{to}\n{text}"),
            Place::Argument(_) => panic!("{text}"),
        }
        assert!(error.message().contains(message), "{to}\n{text}");
        assert!(error.hint().contains(hint), "{to}\n{text}");
    }
}

#[test]
fn worlds_beyond_the_limits_are_refused() {
    let rooms = |n: usize| {
        let all: Vec<String> =
            (0..n).map(|i| format!("{{ name = 'R{i}', box = [{}, 0, {}, 200] }}", i * 50, i * 50 + 40)).collect();
        format!("size = [1000, 200]\nrooms = [{}]\n", all.join(", "))
    };
    let parse = |text: &str| parse(text, Path::new("w.toml"));
    assert!(parse(&rooms(16)).is_ok());
    let error = parse(&rooms(17)).expect_err("17 rooms");
    assert!(error.message().contains("more than 16 rooms"), "{error}");

    let boxes: Vec<String> = (0..80).map(|i| format!("[{0}, 100, {1}, 102]", 2 + i * 4, 4 + i * 4)).collect();
    let text = format!("{}boxes = [{}]\n", rooms(2), boxes.join(", "));
    let error = parse(&text).expect_err("324 segments");
    assert!(error.message().contains("324 segments, more than 256"), "{error}");

    let error = parse("size = [100, 100]\n").expect_err("no rooms");
    assert!(error.message().contains("no rooms"), "{error}");
    let error = parse("size = [100, 100]\nrooms = [{ name = 'A', box = [0, 0, 13, 13] }]").expect_err("no space");
    assert!(error.message().contains("no free space"), "{error}");
    let error = load(Path::new("no/such/world.toml")).expect_err("no file");
    assert!(error.to_string().contains("no/such/world.toml"), "{error}");
    assert!(error.message().contains("no such file"), "{error}");
}
