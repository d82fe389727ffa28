//! The planner's grid of poses: 5 in x 5 in x 15 degrees, between which values are interpolated.

use crate::world::{Pose, World};
use glam::Vec2;

/// Distance of grid points, inches. Ours; tests plan with others, at which moves end on grid points.
pub const PITCH: f32 = 5.0;
/// Headings of the grid.
pub(super) const HEADINGS: usize = 24;
/// Degrees between them.
pub(super) const HEADING_STEP: f32 = 15.0;

/// The points of a floor plan, row by row from the bottom; each has [`HEADINGS`] poses.
#[derive(Debug, Clone)]
pub(super) struct PoseGrid {
    pub(super) pitch: f32,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Whether a robot can stand on the point.
    pub(super) free: Vec<bool>,
}

impl PoseGrid {
    pub(super) fn new(world: &World, pitch: f32) -> Self {
        let columns = (world.size.x / pitch) as usize + 1;
        let rows = (world.size.y / pitch) as usize + 1;
        let free = (0..columns * rows)
            .map(|i| world.is_free(Vec2::new((i % columns) as f32 * pitch, (i / columns) as f32 * pitch)))
            .collect();
        Self { pitch, columns, rows, free }
    }

    pub(super) fn pose(&self, point: usize, heading: usize) -> Pose {
        let (x, y) = ((point % self.columns) as f32 * self.pitch, (point / self.columns) as f32 * self.pitch);
        Pose { x, y, heading: heading as f32 * HEADING_STEP }
    }

    /// The point itself, or the nearest one on which a robot can stand.
    pub(super) fn nearest_free(&self, point: usize) -> usize {
        let place = |point: usize| ((point % self.columns) as i64, (point / self.columns) as i64);
        let (x, y) = place(point);
        let distance = |other: &usize| {
            let (ox, oy) = place(*other);
            (ox - x) * (ox - x) + (oy - y) * (oy - y)
        };
        (0..self.free.len()).filter(|other| self.free[*other]).min_by_key(distance).unwrap_or(point)
    }

    /// The four grid points round a pose with their shares; points that no robot can take have none.
    pub(super) fn corners(&self, pose: Pose) -> [(usize, f32); 4] {
        let column = ((pose.x / self.pitch) as usize).min(self.columns - 2);
        let row = ((pose.y / self.pitch) as usize).min(self.rows - 2);
        let dx = pose.x / self.pitch - column as f32;
        let dy = pose.y / self.pitch - row as f32;
        let first = row * self.columns + column;
        let mut corners = [
            (first, (1.0 - dx) * (1.0 - dy)),
            (first + 1, dx * (1.0 - dy)),
            (first + self.columns, (1.0 - dx) * dy),
            (first + self.columns + 1, dx * dy),
        ];
        let mut total = 0.0;
        for (point, share) in &mut corners {
            // A robot that touches a wall stands between points of which some lie too close to it.
            *share = if self.free[*point] { share.max(1.0e-6) } else { 0.0 };
            total += *share;
        }
        if total > 0.0 {
            for (_, share) in &mut corners {
                *share /= total;
            }
        }
        corners
    }

    /// The value of a pose between those of the grid.
    pub(super) fn interpolate(&self, values: &[f32], pose: Pose) -> f32 {
        let between = Between::headings(pose.heading / HEADING_STEP);
        self.corners(pose)
            .into_iter()
            .filter(|(_, share)| *share > 0.0)
            .map(|(point, share)| share * between.of(&values[point * HEADINGS..][..HEADINGS]))
            .sum()
    }
}

/// A place between two of a grid point's headings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between {
    first: usize,
    second: usize,
    /// Share of the second.
    part: f32,
}

impl Between {
    /// `turn` counts headings and may lie beyond them.
    pub(super) fn headings(turn: f32) -> Self {
        let low = turn.floor();
        let first = (low as i32).rem_euclid(HEADINGS as i32) as usize;
        Self { first, second: (first + 1) % HEADINGS, part: turn - low }
    }

    /// The blend of the values of a point's headings.
    pub(super) fn of(self, values: &[f32]) -> f32 {
        values[self.first] * (1.0 - self.part) + values[self.second] * self.part
    }
}
