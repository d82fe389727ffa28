//! Places between the poses of the planner's grid.

/// Headings of the grid.
pub(super) const HEADINGS: usize = 24;

/// Grid points that an outcome blends, their shares, and its reward.
#[derive(Debug, Clone, Copy)]
pub(super) struct Blend {
    pub(super) points: [u32; 4],
    pub(super) shares: [f32; 4],
    pub(super) reward: f32,
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
