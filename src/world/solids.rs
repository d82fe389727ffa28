//! From walls and boxes to the segments that sensors and bodies meet.

use super::{Charger, Rect, WallSegment};
use glam::Vec2;

/// Everything solid, without the sides of boxes that nothing can touch or see.
pub(super) fn segments(
    floor: &Rect,
    walls: &[(Vec2, Vec2)],
    boxes: &[Rect],
    charger: Option<&Charger>,
) -> Vec<WallSegment> {
    let outer = sides(floor).map(|(a, b)| WallSegment { a, b, charger: false });
    let walls = walls.iter().map(|&(a, b)| WallSegment { a, b, charger: false });
    let boxed = boxes.iter().flat_map(sides).map(|(a, b)| WallSegment { a, b, charger: false });
    let charger = charger.iter().flat_map(|c| sides(&c.area)).map(|(a, b)| WallSegment { a, b, charger: true });
    let seen = |segment: &WallSegment| !hidden(segment, floor, boxes);
    outer.into_iter().chain(walls).chain(boxed.filter(seen)).chain(charger.filter(seen)).collect()
}

/// Whether the point is in the rectangle, its edges counted in.
pub(super) fn holds(rect: &Rect, point: Vec2) -> bool {
    point.cmpge(rect.min).all() && point.cmple(rect.max).all()
}

/// The sides of a rectangle, counter-clockwise: its inside is on their left.
pub(super) fn sides(rect: &Rect) -> [(Vec2, Vec2); 4] {
    let corner = [rect.min, Vec2::new(rect.max.x, rect.min.y), rect.max, Vec2::new(rect.min.x, rect.max.y)];
    [0, 1, 2, 3].map(|i| (corner[i], corner[(i + 1) % 4]))
}

/// Whether a side of a box has the outside of the floor, or the inside of a single other box, all along its outer face.
fn hidden(side: &WallSegment, floor: &Rect, boxes: &[Rect]) -> bool {
    // Outward of a counter-clockwise side, far less than any real distance between two edges.
    let outward = (side.b - side.a).perp().normalize() * -0.01;
    let (a, b) = (side.a + outward, side.b + outward);
    let covers = |rect: &Rect| {
        let inside = |p: Vec2| p.cmpge(rect.min - 0.005).all() && p.cmple(rect.max + 0.005).all();
        holds(rect, side.a) && holds(rect, side.b) && inside(a) && inside(b)
    };
    !(holds(floor, a) && holds(floor, b)) || boxes.iter().any(covers)
}
