//! What a unit of work costs: lane-operations and bytes, counted by hand in the twins.
//!
//! A lane-operation is one operation on one f32 or u32 of a lane: `+ - *`, comparison, selection, conversion, bit
//! operation, high word of a product. Counted is what the result needs, in all 32 lanes that the code is written for,
//! idle ones included; what is the same in all lanes is counted once or, where it is small, left out. So a share of a
//! limit is a little too low rather than too high. Negation and the compiler's own moves cost nothing here.
//!
//! Bytes are those of nets: what is read, and what is written, of the lanes' rows. Everything else fits registers or
//! the nearest cache.

use crate::learner::layout::{LANES, MAX_ROWS, MAX_SKILLS, SkillPlan, WorldPlan};
use crate::qnet::backward::{OPTIMISER_ADAM_ROWS, OPTIMISER_SGD};
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
    /// `noise`, the bell: four halves, three sums, a difference, a conversion, a product.
    pub(super) const NOISE: usize = 4 + 3 + 3;
    /// `reciprocal`: a difference of bits and three times two products and a difference.
    pub(super) const RECIPROCAL: usize = 1 + 3 * 3;
    /// `reciprocal_sqrt`: a product, a shift, a difference, three times three products and a difference.
    pub(super) const RECIPROCAL_SQRT: usize = 3 + 3 * 4;
    /// `square_root`: a bound, a root, a product, a selection.
    pub(super) const SQUARE_ROOT: usize = 2 + RECIPROCAL_SQRT + 1 + 1;
    /// `exponential`: bounds 4, rounding 9, remainder 4, square 1, polynomial 8, sum 3, power of two 2, product 1.
    pub(super) const EXPONENTIAL: usize = 4 + 9 + 4 + 1 + 8 + 3 + 2 + 1;
    /// `squash`: bounds 4, square 1, two polynomials of 8, two products, reciprocal, finiteness 3.
    pub(super) const SQUASH: usize = 4 + 1 + 2 * 8 + 2 + RECIPROCAL + 3;
    /// `flush`: absolute value, comparison, selection.
    pub(super) const FLUSH: usize = 3;
}
use operations::{DRAW, EXPONENTIAL, FLUSH, NOISE, RECIPROCAL, RECIPROCAL_SQRT, SQUARE_ROOT, SQUASH};

/// One lane and segment of `ranges`: the sides of two ends 8 and their comparison 1, the slope 3, signs and selections 4,
/// and the comparison with the nearest so far 7.
const CROSSING: usize = 8 + 1 + 3 + 4 + 7;
/// One lane of `contact`: the line 32 and a reciprocal, two end points of 13 and a root each, selections 12.
const CONTACT: usize = 32 + RECIPROCAL + 2 * (13 + SQUARE_ROOT) + 12;
/// One lane of `bumpers`.
const TOUCH: usize = 35;
/// One lane of `in_sight`.
const SIGHT: usize = 33;
/// Five rounds that bring 32 lanes together.
const REDUCE: usize = LANES - 1;

/// A step of a robot: all random numbers, contact, bumpers, 24 ranges, light and compass. `segments` is the mean
/// length of the lists of segments that robots meet, `moves` the share of actions that travel.
pub fn step(world: &WorldPlan, segments: f64, moves: f64) -> Cost {
    let lanes = LANES as f64;
    let blocks = f64::from(world.segments.div_ceil(LANES as u32));
    let dice = lanes * DRAW as f64;
    let sweep = blocks * lanes * (CONTACT + 9) as f64 + (4 * LANES + 2 * REDUCE) as f64;
    let bumpers = blocks * lanes * TOUCH as f64 + REDUCE as f64;
    let rays = lanes * 6.0;
    let ranges = lanes * (segments * CROSSING as f64 + (RECIPROCAL + 1) as f64);
    // Noise 2, the reading 6 and its place in a word 2.
    let readings = lanes * (NOISE + 2 + 6 + 2) as f64;
    // Direction 4, exponent 2, brightness 1, noise 3, bit 4.
    let light = lanes * (4 + 2 + EXPONENTIAL + 1 + NOISE + 3 + 4) as f64 + blocks * lanes * SIGHT as f64;
    let lit = if world.lit == 1 { light + (2 * REDUCE) as f64 } else { 0.0 };
    let lane_operations = dice + moves * sweep + bumpers + rays + ranges + readings + lit;
    Cost { lane_operations, bytes: 0.0 }
}

/// All nets of a skill forwards: weights read once.
pub fn forward(skill: &SkillPlan) -> Cost {
    let (nets, inputs, outputs) = (skill.nets as usize, skill.inputs as usize, skill.outputs as usize);
    let hidden = nets * LANES * (2 * inputs + SQUASH + outputs);
    let values = skill.children as usize * (REDUCE + 1 + SQUASH);
    Cost { lane_operations: (hidden + values) as f64, bytes: (nets * row_bytes(inputs + 1 + outputs)) as f64 }
}

/// One transition replayed: nets forwards, odds, and one net backwards by one of the optimisers of `qnet/backward`.
pub fn transition(skill: &SkillPlan, optimiser: u32) -> Cost {
    let rows = skill.rows as usize;
    let odds = skill.children as usize * (EXPONENTIAL + 4);
    let errors = LANES * 4;
    // A velocity, or a mean, with its decay; Adam's square and root.
    let (mean, square, root) = (3 + FLUSH, 4 + FLUSH, 1 + RECIPROCAL_SQRT + 1);
    let (weight, apart, slabs) = match optimiser {
        OPTIMISER_SGD => (1 + mean + 1, 0, 2),
        // Two means of squares, then square and root once for each row.
        OPTIMISER_ADAM_ROWS => (mean + 2, 2 * (LANES + REDUCE) + MAX_ROWS * (1 + square + root), 2),
        _ => (1 + mean + square + root + 2, 0, 3),
    };
    let forward = forward(skill);
    let squares = if optimiser == OPTIMISER_ADAM_ROWS { 2 * MAX_ROWS * size_of::<f32>() } else { 0 };
    Cost {
        lane_operations: forward.lane_operations + (odds + errors + LANES * rows * weight + apart) as f64,
        bytes: forward.bytes + (2 * slabs * row_bytes(rows) + squares) as f64,
    }
}

/// A step of a robot whose skill number `root` decides: a look, the nets of the root and of the skills whose values
/// somebody's applicability depends on. The nets of a skill that is chosen and that nobody watches are not counted,
/// nor is travel: both depend on what is chosen.
pub fn decision(world: &WorldPlan, segments: f64, skills: &[SkillPlan], root: usize) -> Cost {
    let watched = (0..root.min(MAX_SKILLS)).filter(|n| (skills[root].watched >> n) & 1 == 1);
    watched.chain([root]).map(|n| forward(&skills[n])).fold(step(world, segments, 0.0), |sum, own| Cost {
        lane_operations: sum.lane_operations + own.lane_operations,
        bytes: sum.bytes + own.bytes,
    })
}

fn row_bytes(rows: usize) -> usize {
    rows * LANES * size_of::<f32>()
}

/// Mean length of the lists of segments that robots at these places meet.
pub fn mean_list(world: &WorldPlan, atlas: &[u32], places: impl Iterator<Item = (f32, f32)>) -> f64 {
    let lengths = places.filter_map(|(x, y)| {
        let column = ((x / 12.0) as u32).min(world.cell_columns.saturating_sub(1));
        let row = ((y / 12.0) as u32).min(world.cell_rows.saturating_sub(1));
        let cell = (world.cell_starts + row * world.cell_columns + column) as usize;
        Some(f64::from(atlas.get(cell + 1)?.saturating_sub(*atlas.get(cell)?)))
    });
    let (sum, count) = lengths.fold((0.0, 0_u32), |(sum, count), length| (sum + length, count + 1));
    sum / f64::from(count.max(1))
}
