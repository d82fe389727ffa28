//! The words of every buffer that a kernel touches, written once.
//!
//! Each struct is declared here for Rust and, from the same lines, for WGSL: [`prelude`] is the text that
//! opens every shader. All fields are 32 bits wide, so both languages give them the same offsets.

use bytemuck::{Pod, Zeroable};

macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: usize = $value;)*
        /// Name and value of every constant that the shaders share.
        pub const CONSTANTS: &[(&str, usize)] = &[$((stringify!($name), $name)),*];
    };
}

macro_rules! shared {
    ($($(#[$doc:meta])* struct $name:ident { $($(#[$field_doc:meta])* $field:ident: $kind:tt,)* })*) => {
        $(
            $(#[$doc])*
            #[repr(C)]
            #[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
            pub struct $name { $($(#[$field_doc])* pub $field: shared!(@rust $kind),)* }
        )*
        /// WGSL text of every shared struct, in order of use.
        pub const STRUCTS: &[&str] = &[$(concat!(
            "struct ", stringify!($name), " {\n",
            $("    ", stringify!($field), ": ", shared!(@wgsl $kind), ",\n",)*
            "}\n"
        )),*];
    };
    (@rust u32) => { u32 };
    (@rust f32) => { f32 };
    (@rust [$element:ident; $n:ident]) => { [$element; $n] };
    (@wgsl u32) => { "u32" };
    (@wgsl f32) => { "f32" };
    (@wgsl [$element:ident; $n:ident]) => { concat!("array<", stringify!($element), ", ", stringify!($n), ">") };
}

constants! {
    /// Invocations of a workgroup; elements of every lane array.
    LANES = 32;
    /// Sonar and light bearings, 15 degrees apart.
    RAYS = 24;
    /// Most children of a skill.
    MAX_CHILDREN = 8;
    /// Most inputs of a net.
    MAX_INPUTS = 64;
    /// Most input groups of a skill.
    MAX_GROUPS = 8;
    /// Most segments of a world.
    MAX_SEGMENTS = 256;
    /// Most rooms of a world.
    MAX_ROOMS = 16;
    /// Most doors of a world.
    MAX_DOORS = 16;
    /// Most start regions of a skill.
    MAX_STARTS = 4;
    /// Most skills of a learner.
    MAX_SKILLS = 8;
    /// Words of one recorded step.
    RECORD_WORDS = 10;
    /// Words that open a lesson: its length in steps, its end, whether it was taught, unused.
    LESSON_HEADER = 4;
    /// Words of one row of the trial table.
    ROW_WORDS = 8;
    /// Entries of a sonar coding table.
    SONAR_CODES = 128;
}

shared! {
    /// One straight piece of anything solid.
    struct Segment {
        /// Start, inches.
        ax: f32,
        /// Start, inches.
        ay: f32,
        /// End minus start, inches.
        dx: f32,
        /// End minus start, inches.
        dy: f32,
        /// Unit vector along the segment.
        tx: f32,
        /// Unit vector along the segment.
        ty: f32,
        /// Length, inches.
        length: f32,
        /// 1 where the segment is the charger's.
        charger: u32,
    }

    /// A room's rectangle, inches.
    struct RoomArea {
        /// Left.
        x0: f32,
        /// Bottom.
        y0: f32,
        /// Right.
        x1: f32,
        /// Top.
        y1: f32,
    }

    /// The box round a doorway in which a robot has not yet passed it, inches.
    struct Doorway {
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
    struct WorldPlan {
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
        /// Word of the atlas at which the cells' list starts stand.
        cell_starts: u32,
        /// Keeps the arrays on 16 bytes.
        padding: u32,
        /// The segments.
        segment: [Segment; MAX_SEGMENTS],
        /// The rooms.
        room: [RoomArea; MAX_ROOMS],
        /// The doorways.
        doorway: [Doorway; MAX_DOORS],
    }
}
