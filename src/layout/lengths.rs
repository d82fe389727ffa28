//! Lengths that floor plans, the CPU's lists and the shaders share.

macro_rules! lengths {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: f32 = $value;)*
        /// Name and value of every one.
        pub(super) const LENGTHS: &[(&str, f32)] = &[$((stringify!($name), $name)),*];
    };
}

lengths! {
    /// Radius of the body, inches (paper, Figure 1).
    RADIUS = 12.0;
    /// 1 / [`RADIUS`].
    INVERSE_RADIUS = 1.0 / 12.0;
    /// The bumpers feel what is this close to the body, inches. Our choice.
    BUMPER_GAP = 0.4;
    /// Side of the cells that have their own list of segments, inches. Our choice.
    LIST_CELL = 12.0;
    /// 1 / [`LIST_CELL`].
    CELLS_PER_INCH = 1.0 / 12.0;
}
