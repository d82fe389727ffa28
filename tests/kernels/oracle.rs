//! Geometry for tests, in f64 and by other means than the product's: distance fields, walked along.
//!
//! A segment is a box of no thickness with its own axes; what a ray or a disc meets is found by stepping as far as
//! the distance field says is safe. No crossing test, no ratio and no chord of a circle is computed here.

use skilltree::world::{World, load, parse};
use std::fmt::Write;
use std::path::Path;

/// A point or a direction.
pub(crate) type P = [f64; 2];

/// A straight piece of anything solid, by its middle and axes.
#[derive(Debug, Clone, Copy)]
struct Piece {
    middle: P,
    along: P,
    half: f64,
    charger: bool,
}

impl Piece {
    fn new(a: P, b: P, charger: bool) -> Self {
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0];
        Self { middle, along: [dx / length, dy / length], half: length / 2.0, charger }
    }

    fn distance(&self, p: P) -> f64 {
        let (x, y) = (p[0] - self.middle[0], p[1] - self.middle[1]);
        let beyond = (x * self.along[0] + y * self.along[1]).abs() - self.half;
        let off = y * self.along[0] - x * self.along[1];
        if beyond > 0.0 { beyond.hypot(off) } else { off.abs() }
    }

    /// The nearest point of the piece, by ternary search along it.
    fn nearest(&self, p: P) -> P {
        let at = |t: f64| [self.middle[0] + self.along[0] * t, self.middle[1] + self.along[1] * t];
        let (mut low, mut high) = (-self.half, self.half);
        for _ in 0..120 {
            let (one, two) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if length(sub(at(one), p)) < length(sub(at(two), p)) {
                high = two;
            } else {
                low = one;
            }
        }
        at((low + high) / 2.0)
    }
}

pub(crate) fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

pub(crate) fn length(a: P) -> f64 {
    a[0].hypot(a[1])
}

/// The point `t` inches from `from` on a bearing in degrees.
pub(crate) fn ahead(from: P, degrees: f64, t: f64) -> P {
    let turned = degrees.to_radians();
    [from[0] + turned.cos() * t, from[1] + turned.sin() * t]
}

/// A floor plan as written, before the product makes anything of it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Written {
    pub(crate) size: P,
    pub(crate) walls: Vec<[f64; 4]>,
    pub(crate) boxes: Vec<[f64; 4]>,
    pub(crate) charger: Option<[f64; 4]>,
    pub(crate) light: Option<(P, f64)>,
}

impl Written {
    /// An empty room.
    pub(crate) fn room(width: f64, height: f64) -> Self {
        Self { size: [width, height], ..Self::default() }
    }

    /// The product's world: through the TOML reader.
    pub(crate) fn world(&self) -> World {
        let mut text = format!("size = {:?}\nwalls = {:?}\nboxes = {:?}\n", self.size, self.walls, self.boxes);
        let _ = writeln!(text, "[[rooms]]\nname = \"A\"\nbox = [0, 0, {:?}, {:?}]", self.size[0], self.size[1]);
        if let Some(charger) = self.charger {
            let _ = writeln!(text, "[charger]\nbox = {charger:?}\ntolerance = 30");
        }
        if let Some((at, range)) = self.light {
            let _ = writeln!(text, "[light]\nat = {at:?}\nrange = {range:?}");
        }
        parse(&text, Path::new("written.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    /// The same plan as pieces.
    pub(crate) fn field(&self) -> Field {
        let mut field = Field { pieces: Vec::new(), solids: Vec::new(), size: self.size };
        let sides = |b: [f64; 4]| {
            let c = [[b[0], b[1]], [b[2], b[1]], [b[2], b[3]], [b[0], b[3]]];
            [0, 1, 2, 3].map(|i| (c[i], c[(i + 1) % 4]))
        };
        let walls = self.walls.iter().map(|w| ([w[0], w[1]], [w[2], w[3]]));
        let outer = sides([0.0, 0.0, self.size[0], self.size[1]]);
        let boxes = self.boxes.iter().flat_map(|b| sides(*b));
        field.pieces.extend(walls.chain(outer).chain(boxes).map(|(a, b)| Piece::new(a, b, false)));
        field.pieces.extend(self.charger.iter().flat_map(|b| sides(*b)).map(|(a, b)| Piece::new(a, b, true)));
        field.solids.extend(self.boxes.iter().chain(&self.charger));
        field
    }
}

/// A shipped world, and its parts as its file lists them.
pub(crate) fn office(name: &str) -> (World, Written) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("configs/worlds/{name}.toml"));
    let (world, text) = load(&path).unwrap_or_else(|error| panic!("{error}"));
    let plain: toml::Table = text.parse().expect("the world is TOML");
    let number = |v: &toml::Value| v.as_float().or(v.as_integer().map(|i| i as f64)).expect("a number");
    let four = |v: &toml::Value| {
        let list = v.as_array().expect("a list");
        std::array::from_fn(|i| number(&list[i]))
    };
    let fours = |key: &str| {
        plain.get(key).and_then(toml::Value::as_array).map_or(Vec::new(), |list| list.iter().map(four).collect())
    };
    let pair = |v: &toml::Value| std::array::from_fn(|i| number(&v.as_array().expect("a list")[i]));
    let written = Written {
        size: pair(&plain["size"]),
        walls: fours("walls"),
        boxes: fours("boxes"),
        charger: plain.get("charger").map(|charger| four(&charger["box"])),
        light: Some((pair(&plain["light"]["at"]), number(&plain["light"]["range"]))),
    };
    (world, written)
}

/// The distance field of a floor plan.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    pieces: Vec<Piece>,
    solids: Vec<[f64; 4]>,
    size: P,
}

impl Field {
    /// Distance to the nearest piece.
    pub(crate) fn clearance(&self, p: P) -> f64 {
        self.pieces.iter().map(|piece| piece.distance(p)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the centre of a disc of this radius may be here.
    pub(crate) fn free(&self, p: P, radius: f64) -> bool {
        let inside = |b: &[f64; 4]| p[0] > b[0] && p[0] < b[2] && p[1] > b[1] && p[1] < b[3];
        let outer = [0.0, 0.0, self.size[0], self.size[1]];
        inside(&outer) && !self.solids.iter().any(inside) && self.clearance(p) >= radius
    }

    /// Distance at which a ray meets something, at most `limit`. Steps are as long as the field allows.
    pub(crate) fn ray(&self, from: P, degrees: f64, limit: f64) -> f64 {
        self.walk(from, degrees, limit, true)
    }

    /// Whether nothing but the charger lies between two points.
    pub(crate) fn sees(&self, from: P, to: P) -> bool {
        let way = sub(to, from);
        let far = length(way);
        self.walk(from, way[1].atan2(way[0]).to_degrees(), far, false) >= far
    }

    fn walk(&self, from: P, degrees: f64, limit: f64, charger: bool) -> f64 {
        let turned = degrees.to_radians();
        let (ux, uy) = (turned.cos(), turned.sin());
        let mut t = 0.0;
        while t < limit {
            let p = [from[0] + ux * t, from[1] + uy * t];
            let solid = self.pieces.iter().filter(|piece| charger || !piece.charger);
            let safe = solid.map(|piece| piece.distance(p)).fold(f64::INFINITY, f64::min);
            if safe < 1.0e-9 {
                return t;
            }
            t += safe;
        }
        limit
    }

    /// Distance that a disc of `radius` travels from `start` inches along the path until it touches, at most `limit`:
    /// walked in safe steps, but at least 0.01 in, then bisected. Misses no touch deeper than 2e-6 in.
    pub(crate) fn disc(&self, from: P, degrees: f64, radius: f64, start: f64, limit: f64) -> f64 {
        let turned = degrees.to_radians();
        let gap = |t: f64| self.clearance([from[0] + turned.cos() * t, from[1] + turned.sin() * t]) - radius;
        let (mut before, mut t) = (start, start);
        loop {
            let room = gap(t);
            if room < 0.0 {
                break;
            }
            if t >= limit {
                return limit;
            }
            before = t;
            t = (t + room.max(0.01)).min(limit);
        }
        let (mut low, mut high) = (before, t);
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if gap(middle) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }

    /// Distance and relative bearing in degrees of the nearest point of every piece within `reach`.
    pub(crate) fn touches(&self, from: P, heading: f64, reach: f64) -> Vec<(f64, f64)> {
        let near = self.pieces.iter().filter(|piece| piece.distance(from) < reach);
        near.map(|piece| {
            let way = sub(piece.nearest(from), from);
            let bearing = way[1].atan2(way[0]).to_degrees() - heading;
            (length(way), (bearing + 540.0).rem_euclid(360.0) - 180.0)
        })
        .collect()
    }
}
