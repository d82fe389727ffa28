//! Distances and lines of sight on the host. Kernels have their own; these place robots and check worlds.

use super::{ROBOT_RADIUS, Rect, WallSegment, World};
use glam::{DVec2, Vec2};

impl World {
    /// Distance in inches to the nearest solid; negative inside boxes, in the charger and outside the floor.
    pub fn clearance(&self, point: Vec2) -> f32 {
        let at = point.as_dvec2();
        let nearest = self.segments.iter().map(|segment| distance(at, segment)).fold(f64::INFINITY, f64::min);
        (if self.is_solid(point) { -nearest } else { nearest }) as f32
    }

    /// Whether a robot fits with its centre here.
    pub fn is_free(&self, point: Vec2) -> bool {
        self.clearance(point) >= ROBOT_RADIUS
    }

    /// Index of the room that holds the point. Doorways and boxes between rooms belong to none.
    pub fn room_of(&self, point: Vec2) -> Option<usize> {
        self.rooms.iter().position(|room| room.area.contains(point))
    }

    /// Whether nothing solid but the charger touches the straight line between two points.
    pub fn sees(&self, from: Vec2, to: Vec2) -> bool {
        let (from, to) = (from.as_dvec2(), to.as_dvec2());
        let walls = self.segments.iter().filter(|segment| !segment.charger);
        !walls.into_iter().any(|wall| touch(from, to, wall.a.as_dvec2(), wall.b.as_dvec2()))
    }

    fn is_solid(&self, point: Vec2) -> bool {
        let inside = |rect: &Rect| point.cmpgt(rect.min).all() && point.cmplt(rect.max).all();
        let outside = point.cmplt(Vec2::ZERO).any() || point.cmpgt(self.size).any();
        outside || self.boxes.iter().any(inside) || self.charger.is_some_and(|charger| inside(&charger.area))
    }
}

/// Distance from a point to a segment, inches.
pub(super) fn distance(point: DVec2, segment: &WallSegment) -> f64 {
    let (a, b) = (segment.a.as_dvec2(), segment.b.as_dvec2());
    let along = b - a;
    let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    point.distance(a + along * t)
}

/// Whether two closed segments have a point in common.
pub(super) fn touch(p: DVec2, q: DVec2, a: DVec2, b: DVec2) -> bool {
    let side = |from: DVec2, to: DVec2, at: DVec2| (to - from).perp_dot(at - from);
    let (a_side, b_side) = (side(p, q, a), side(p, q, b));
    let (p_side, q_side) = (side(a, b, p), side(a, b, q));
    // Parallel or collinear segments pass the side test even where they lie apart; their boxes do not overlap then.
    let boxes_meet = p.min(q).cmple(a.max(b)).all() && a.min(b).cmple(p.max(q)).all();
    boxes_meet && a_side * b_side <= 0.0 && p_side * q_side <= 0.0
}
