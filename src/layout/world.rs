//! The floor plan, as kernels read it.

use super::sizes::{MAX_DOORS, MAX_ROOMS, MAX_SEGMENTS};
use bytemuck::{Pod, Zeroable};

shared! {
    /// One straight piece of anything solid.
    struct Segment {
        /// Start, inches.
        ax: f32,
        /// Start, inches.
        ay: f32,
        /// End, inches.
        bx: f32,
        /// End, inches.
        by: f32,
        /// Unit vector along the segment.
        tx: f32,
        /// Unit vector along the segment.
        ty: f32,
        /// Length, inches.
        length: f32,
        /// 1 where the segment is the charger's.
        charger: u32,
    }

    /// A rectangle, inches.
    struct Area {
        /// Left.
        x0: f32,
        /// Bottom.
        y0: f32,
        /// Right.
        x1: f32,
        /// Top.
        y1: f32,
    }

    /// The floor plan, in a uniform buffer: one load serves all lanes.
    struct WorldUniform {
        /// Segments in use.
        segments: u32,
        /// Rooms in use.
        rooms: u32,
        /// Doorways in use.
        doors: u32,
        /// 1 where there is a light.
        lit: u32,
        /// Light position, inches.
        light_x: f32,
        /// Light position, inches.
        light_y: f32,
        /// Square of the light's range, square inches.
        light_range2: f32,
        /// Cosine of the docking tolerance.
        dock_cosine: f32,
        /// Cells of the culled segment lists in a row.
        cell_columns: u32,
        /// Rows of cells.
        cell_rows: u32,
        /// Word of the tables at which the cells' list starts stand.
        cell_starts: u32,
        /// Word of the tables at which the starts of the cells' lists of what can hide the light stand.
        sight_starts: u32,
        /// The segments.
        segment: [Segment; MAX_SEGMENTS],
        /// The rooms.
        room: [Area; MAX_ROOMS],
        /// The boxes round the doorways, in which a robot has not yet passed them.
        doorway: [Area; MAX_DOORS],
    }
}
