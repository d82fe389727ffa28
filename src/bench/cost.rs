//! What a unit of work costs: lane-operations and bytes, counted by hand in the twins.
//!
//! A lane-operation is one operation on one f32 or u32 of a lane: `+ - *`, comparison, selection, conversion, bit
//! operation, high word of a product. Counted is what the result needs, in all lanes of the arrays that the twins are
//! written with, idle ones included; what is the same in all lanes is counted once or, where it is small, left out. So a share of a
//! limit is a little too low rather than too high. Negation and the compiler's own moves cost nothing here.
//!
//! Bytes are those of nets: what is read, and what is written, of the lanes' rows. Everything else fits registers or
//! the nearest cache.

use crate::env::light::{falloff, in_sight};
use crate::env::segments::{BLOCK, SegmentGrid};
use crate::env::sonar::LINE_LANES;
use crate::layout::{LANES, MAX_SKILLS, SkillShape};
use crate::math::rng::{BATCH, DRAWS};
use crate::qnet::backward::{OPTIMISER_ADAM_ROWS, OPTIMISER_SGD, ROW_BLOCK};
use crate::qnet::forward::bits_of;
use serde::{Deserialize, Serialize};

/// Cost of one unit of work.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Cost {
    /// Operations on single lanes.
    pub lane_operations: f64,
    /// Bytes of nets read and written.
    pub bytes: f64,
}

/// Operations of the functions of `math`, one lane.
mod operations {
    /// `philox` with its counter: ten rounds of two products, their high words and four exclusive ors.
    pub(super) const DRAW: usize = 10 * 8 + 1;
    /// `coarse_noise`, the bell: bytes and halves 5, sums 2, a difference, a conversion, a product.
    pub(super) const NOISE: usize = 5 + 2 + 3;
    /// `reciprocal`: a difference of bits and three times two products and a difference.
    pub(super) const RECIPROCAL: usize = 1 + 3 * 3;
    /// `reciprocal_sqrt`: a product, a shift, a difference, three times three products and a difference.
    pub(super) const RECIPROCAL_SQRT: usize = 3 + 3 * 4;
    /// `square_root`: a bound, a root, a product, a selection.
    pub(super) const SQUARE_ROOT: usize = 2 + RECIPROCAL_SQRT + 1 + 1;
    /// `exponential`: bounds 4, rounding 9, remainder 4, square 1, polynomial 8, sum 3, power of two 2, product 1.
    pub(super) const EXPONENTIAL: usize = 4 + 9 + 4 + 1 + 8 + 3 + 2 + 1;
    /// `tanh`: bounds 4, square 1, two polynomials of 8, two products, reciprocal, finiteness 3.
    pub(super) const SQUASH: usize = 4 + 1 + 2 * 8 + 2 + RECIPROCAL + 3;
    /// `flush`: absolute value, comparison, selection.
    pub(super) const FLUSH: usize = 3;
}
use operations::{DRAW, EXPONENTIAL, FLUSH, NOISE, RECIPROCAL, RECIPROCAL_SQRT, SQUARE_ROOT, SQUASH};

/// One lane of `ranges` that is a segment: ends 4, direction 2, distance 3, bound 4, reciprocal, sign 2, slopes 2.
const HEARD: usize = 4 + 2 + 3 + 4 + RECIPROCAL + 2 + 2;
/// One lane of `ranges` that is a line, at one segment: sides 6 and 1, closeness 3, selection 1, nearest both ways 4.
const CROSSING: usize = 6 + 1 + 3 + 1 + 4;
/// One lane of `contact`: the line 32 and a reciprocal, two end points of 13 and a root each, selections 12.
const CONTACT: usize = 32 + RECIPROCAL + 2 * (13 + SQUARE_ROOT) + 12;
/// One lane of `bumpers`.
const TOUCH: usize = 35;
/// One lane of `in_sight`.
const SIGHT: usize = 33;
/// Five rounds that bring 32 lanes together.
const REDUCE: usize = LANES - 1;

/// A step of a robot: all random numbers, contact, bumpers, 24 ranges, light and compass; mean over the places where
/// robots are. `light` is the noise of the light, `moves` the share of actions that travel, `random` the draws that are made
/// on every step.
pub fn step(
    floor: &SegmentGrid,
    light: f32,
    places: impl Iterator<Item = (f32, f32)>,
    moves: f64,
    random: usize,
) -> Cost {
    let (mut sum, mut count) = (0.0, 0_u32);
    for (x, y) in places {
        sum += step_at(floor, light, x, y, moves);
        count += 1;
    }
    Cost { lane_operations: (random * DRAW) as f64 + sum / f64::from(count.max(1)), bytes: 0.0 }
}

fn step_at(floor: &SegmentGrid, light: f32, x: f32, y: f32, moves: f64) -> f64 {
    let touched = floor.touchable(x, y, 0.0).len() * BLOCK;
    let sweep = touched * (CONTACT + 9) + 5 * BLOCK;
    let bumpers = touched * TOUCH + BLOCK;
    let rays = LINE_LANES * 6;
    let (heard, segments) = floor.audible(x, y);
    let ranges = heard.len() * BLOCK * HEARD + segments * LINE_LANES * CROSSING + LANES * RECIPROCAL;
    // Noise 2, the reading 7, its place in a word 1.
    let readings = LANES * (NOISE + 2 + 7 + 1);
    let mut lit = 0;
    if floor.plan.lit == 1 && falloff(floor, x, y) * (light * 3.5 + 1.0) > 1.0 {
        lit += floor.hiding(x, y).len() * BLOCK * SIGHT + BLOCK;
        if in_sight(floor, x, y) {
            // Direction 4; exponent 2, brightness 1, noise 3, bit 4.
            lit += LINE_LANES * 4 + LANES * (2 + EXPONENTIAL + 1 + NOISE + 3 + 4) + REDUCE + BATCH * DRAW;
        }
    }
    (bumpers + rays + ranges + readings + lit) as f64 + moves * sweep as f64
}

/// All nets of a skill forwards: weights read once. `lanes` of each row are in use, and on average `seen` of the inputs:
/// bits that are not set are passed over.
pub fn forward(skill: &SkillShape, lanes: usize, seen: f64) -> Cost {
    let (nets, outputs) = (f64::from(skill.nets), f64::from(skill.outputs));
    let hidden = nets * lanes as f64 * (2.0 * seen + SQUASH as f64 + outputs);
    let values = skill.children as usize * (lanes + SQUASH);
    Cost { lane_operations: hidden + values as f64, bytes: nets * (seen + 1.0 + outputs) * row_bytes(lanes) }
}

/// One transition replayed: nets forwards, as in [`forward`], odds, and one net backwards by one of the optimisers of
/// `qnet/backward`.
pub fn transition(skill: &SkillShape, lanes: usize, seen: f64, optimiser: u32) -> Cost {
    let rows = skill.rows as usize;
    let odds = skill.children as usize * (EXPONENTIAL + 4);
    let errors = lanes * 4;
    // A velocity, or a mean, with its decay; Adam's square and root.
    let (mean, square, root) = (3 + FLUSH, 4 + FLUSH, 1 + RECIPROCAL_SQRT + 1);
    let (weight, apart, slabs) = match optimiser {
        OPTIMISER_SGD => (1 + mean + 1, 0, 2),
        // Two means of squares, then square and root once for each row.
        OPTIMISER_ADAM_ROWS => {
            (mean + 2, 2 * (2 * lanes - 1) + rows.next_multiple_of(ROW_BLOCK) * (1 + square + root), 2)
        }
        _ => (1 + mean + square + root + 2, 0, 3),
    };
    let forward = forward(skill, lanes, seen);
    let squares =
        if optimiser == OPTIMISER_ADAM_ROWS { 2.0 * row_bytes(rows.next_multiple_of(ROW_BLOCK)) } else { 0.0 };
    Cost {
        lane_operations: forward.lane_operations + (odds + errors + lanes * rows * weight + apart) as f64,
        bytes: forward.bytes + (2 * slabs * rows) as f64 * row_bytes(lanes) + squares,
    }
}

/// A step of a robot whose skill number `root` decides: a look, the nets of the root and of the skills whose values
/// somebody's applicability depends on. The nets of a skill that is chosen and that nobody watches are not counted,
/// nor is travel: both depend on what is chosen.
pub fn decision(
    floor: &SegmentGrid,
    light: f32,
    places: impl Iterator<Item = (f32, f32)>,
    skills: &[SkillShape],
    root: usize,
) -> Cost {
    let watched = (0..root.min(MAX_SKILLS)).filter(|n| (skills[root].watched >> n) & 1 == 1);
    // Bits are left out.
    let seen = |skill: &SkillShape| skill.inputs - bits_of(skill).count_ones();
    let of = |n: usize| forward(&skills[n], LANES, f64::from(seen(&skills[n])));
    watched.chain([root]).map(of).fold(step(floor, light, places, 0.0, DRAWS), |sum, own| Cost {
        lane_operations: sum.lane_operations + own.lane_operations,
        bytes: sum.bytes + own.bytes,
    })
}

fn row_bytes(lanes: usize) -> f64 {
    (lanes * size_of::<f32>()) as f64
}
