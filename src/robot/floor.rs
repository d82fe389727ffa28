//! The floor plan as the CPU's lanes want it: one array per coordinate.

use crate::learner::layout::{LANES, MAX_SEGMENTS, WorldPlan};

/// A [`WorldPlan`] with its segments also transposed. The GPU reads the plan itself.
#[derive(Debug, Clone)]
pub struct Floor {
    /// What the GPU's uniform buffer holds.
    pub plan: WorldPlan,
    /// Segments by blocks of 32.
    pub blocks: Vec<SegmentBlock>,
}

/// The coordinates of 32 segments; see [`crate::learner::layout::Segment`].
#[derive(Debug, Clone, Copy)]
pub struct SegmentBlock {
    /// Start.
    pub ax: [f32; LANES],
    /// Start.
    pub ay: [f32; LANES],
    /// End.
    pub bx: [f32; LANES],
    /// End.
    pub by: [f32; LANES],
    /// Unit vector along.
    pub tx: [f32; LANES],
    /// Unit vector along.
    pub ty: [f32; LANES],
    /// Length; negative in lanes without a segment.
    pub length: [f32; LANES],
    /// 1 for the charger's.
    pub charger: [u32; LANES],
}

impl Floor {
    /// Transposes a plan.
    pub fn new(plan: &WorldPlan) -> Self {
        let used = (plan.segments as usize).min(MAX_SEGMENTS);
        let blocks = plan.segment[..used]
            .chunks(LANES)
            .map(|chunk| {
                let mut block = SegmentBlock {
                    ax: [0.0; LANES],
                    ay: [0.0; LANES],
                    bx: [0.0; LANES],
                    by: [0.0; LANES],
                    tx: [0.0; LANES],
                    ty: [0.0; LANES],
                    length: [-1.0; LANES],
                    charger: [0; LANES],
                };
                for (lane, segment) in chunk.iter().enumerate() {
                    block.ax[lane] = segment.ax;
                    block.ay[lane] = segment.ay;
                    block.bx[lane] = segment.bx;
                    block.by[lane] = segment.by;
                    block.tx[lane] = segment.tx;
                    block.ty[lane] = segment.ty;
                    block.length[lane] = segment.length;
                    block.charger[lane] = segment.charger;
                }
                block
            })
            .collect();
        Self { plan: *plan, blocks }
    }
}
