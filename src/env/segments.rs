//! The floor plan as the CPU's lanes want it: segments transposed, and lists of those that matter in each cell.
//!
//! The GPU reads the plan and the tables. It takes all segments where the CPU takes a list of what can be touched or can
//! hide the light. That changes no bit: what a list leaves out is too far away or beside the way, and neither the least
//! of some numbers nor the bits set in any depends on the order. Tests compare each list with all segments.

use crate::layout::lengths::{BUMPER_GAP, CELLS_PER_INCH, LIST_CELL, RADIUS};
use crate::layout::{MAX_SEGMENTS, Segment, WorldUniform};
use std::collections::HashMap;

/// Segments of a block: a vector of most CPUs, and lists seldom have more.
pub const BLOCK: usize = 8;
/// The farthest that a robot may want to go for a cell's list to hold all that it could touch, inches.
pub const LISTED_TRAVEL: f32 = 16.0;
/// Much more than rounding can move anything by, inches.
const MARGIN: f32 = 0.1;

/// A [`WorldUniform`] with its segments also transposed.
#[derive(Debug, Clone)]
pub struct SegmentGrid {
    /// What the GPU's uniform buffer holds.
    pub plan: WorldUniform,
    /// All segments.
    pub all: Vec<SegmentBlock>,
    /// Lists of the cells, one after another.
    listed: Vec<SegmentBlock>,
    /// Row by row from the bottom.
    cells: Vec<Cell>,
}

/// The coordinates of up to 8 segments; see [`Segment`]. Aligned, for none of them to lie across two lines of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub struct SegmentBlock {
    /// Start.
    pub ax: [f32; BLOCK],
    /// Start.
    pub ay: [f32; BLOCK],
    /// End.
    pub bx: [f32; BLOCK],
    /// End.
    pub by: [f32; BLOCK],
    /// Length; negative in lanes without a segment.
    pub length: [f32; BLOCK],
    /// Unit vector along.
    pub tx: [f32; BLOCK],
    /// Unit vector along.
    pub ty: [f32; BLOCK],
    /// 1 for the charger's.
    pub charger: [u32; BLOCK],
}

/// A cell's lists.
#[derive(Debug, Clone, Copy)]
struct Cell {
    /// What a robot in the cell can hear.
    heard: List,
    /// What it can touch within [`LISTED_TRAVEL`].
    touched: List,
    /// What decides whether it sees the light.
    hiding: List,
}

/// Some of the listed blocks.
#[derive(Debug, Clone, Copy)]
struct List {
    first: u32,
    segments: u16,
    blocks: u16,
}

impl SegmentGrid {
    /// Transposes a plan; `tables` holds its lists.
    pub fn new(plan: &WorldUniform, tables: &[u32]) -> Self {
        let used = (plan.segments as usize).min(MAX_SEGMENTS);
        let mut floor = Self { plan: *plan, all: blocks(&plan.segment[..used]), listed: Vec::new(), cells: Vec::new() };
        let mut known = HashMap::new();
        for number in 0..plan.cell_columns * plan.cell_rows {
            let x = ((number % plan.cell_columns) as f32 + 0.5) * LIST_CELL;
            let y = ((number / plan.cell_columns) as f32 + 0.5) * LIST_CELL;
            let touched: Vec<u32> = (0..used as u32).filter(|i| can_touch(&plan.segment[*i as usize], x, y)).collect();
            let cell = Cell {
                heard: floor.place(&mut known, list(tables, plan.cell_starts + number)),
                touched: floor.place(&mut known, &touched),
                hiding: floor.place(&mut known, list(tables, plan.sight_starts + number)),
            };
            floor.cells.push(cell);
        }
        floor
    }

    /// Where a list stands. It is written where it is not `known`: many cells have the same.
    fn place(&mut self, known: &mut HashMap<Vec<u32>, List>, list: &[u32]) -> List {
        *known.entry(list.to_vec()).or_insert_with(|| {
            let first = self.listed.len() as u32;
            let segments: Vec<Segment> = list.iter().map(|i| self.plan.segment[*i as usize]).collect();
            self.listed.extend(blocks(&segments));
            List { first, segments: segments.len() as u16, blocks: segments.len().div_ceil(BLOCK) as u16 }
        })
    }

    #[inline(always)]
    fn cell(&self, x: f32, y: f32) -> Cell {
        let column = ((x * CELLS_PER_INCH) as u32).min(self.plan.cell_columns - 1);
        let row = ((y * CELLS_PER_INCH) as u32).min(self.plan.cell_rows - 1);
        self.cells[(row * self.plan.cell_columns + column) as usize]
    }

    #[inline(always)]
    fn listed(&self, list: List) -> &[SegmentBlock] {
        &self.listed[list.first as usize..][..usize::from(list.blocks)]
    }

    /// Blocks with all segments that a robot at (`x`, `y`) can touch while it goes up to `reach` inches.
    #[inline(always)]
    pub fn touchable(&self, x: f32, y: f32, reach: f32) -> &[SegmentBlock] {
        if reach > LISTED_TRAVEL { &self.all } else { self.listed(self.cell(x, y).touched) }
    }

    /// Blocks with all segments that a robot at (`x`, `y`) can hear, and their number.
    #[inline(always)]
    pub fn audible(&self, x: f32, y: f32) -> (&[SegmentBlock], usize) {
        let list = self.cell(x, y).heard;
        (self.listed(list), usize::from(list.segments))
    }

    /// Blocks with all segments that decide whether a robot at (`x`, `y`) sees the light.
    #[inline(always)]
    pub fn hiding(&self, x: f32, y: f32) -> &[SegmentBlock] {
        self.listed(self.cell(x, y).hiding)
    }
}

/// List number `place` of the tables.
fn list(tables: &[u32], place: u32) -> &[u32] {
    let place = place as usize;
    &tables[tables[place] as usize..tables[place + 1] as usize]
}

/// Whether a robot that starts in the cell with this centre can touch a segment within [`LISTED_TRAVEL`].
fn can_touch(segment: &Segment, x: f32, y: f32) -> bool {
    let (wx, wy) = (x - segment.ax, y - segment.ay);
    let along = (segment.tx * wx + segment.ty * wy).max(0.0).min(segment.length);
    let (px, py) = (segment.tx * along - wx, segment.ty * along - wy);
    let corner = LIST_CELL * std::f32::consts::FRAC_1_SQRT_2;
    px.hypot(py) <= corner + LISTED_TRAVEL + RADIUS + BUMPER_GAP + MARGIN
}

fn blocks(segments: &[Segment]) -> Vec<SegmentBlock> {
    segments
        .chunks(BLOCK)
        .map(|chunk| {
            let mut block = SegmentBlock {
                ax: [0.0; BLOCK],
                ay: [0.0; BLOCK],
                bx: [0.0; BLOCK],
                by: [0.0; BLOCK],
                length: [-1.0; BLOCK],
                tx: [0.0; BLOCK],
                ty: [0.0; BLOCK],
                charger: [0; BLOCK],
            };
            for (lane, segment) in chunk.iter().enumerate() {
                block.ax[lane] = segment.ax;
                block.ay[lane] = segment.ay;
                block.bx[lane] = segment.bx;
                block.by[lane] = segment.by;
                block.length[lane] = segment.length;
                block.tx[lane] = segment.tx;
                block.ty[lane] = segment.ty;
                block.charger[lane] = segment.charger;
            }
            block
        })
        .collect()
}
