//! What is counted of test trials, from the kernel's episodes to the report's page.

use bytemuck::{Pod, Zeroable};
use std::iter::Sum;
use std::ops::{Add, AddAssign};

/// Sums over test trials.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable)]
pub struct Sums {
    /// Test trials.
    pub episodes: u32,
    /// Test trials that ended as achieved.
    pub successes: u32,
    /// Primitive steps.
    pub steps: u32,
    /// Steps with contact.
    pub collisions: u32,
    /// Rewards, undiscounted, in the config's units.
    pub reward: f64,
    /// Rewards, each discounted from the start of its trial with the skill's own factor.
    pub returned: f64,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.episodes += other.episodes;
        self.successes += other.successes;
        self.steps += other.steps;
        self.collisions += other.collisions;
        self.reward += other.reward;
        self.returned += other.returned;
    }
}

impl Add for Sums {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sum for Sums {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), Self::add)
    }
}
