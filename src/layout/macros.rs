//! Macros that declare constants and structs for Rust and, from the same lines, for WGSL.

/// A struct as Rust lays it out.
#[derive(Debug, Clone, Copy)]
pub struct Layout {
    /// Its name.
    pub name: &'static str,
    /// Its bytes.
    pub size: usize,
    /// Name, offset in bytes and WGSL type of each field.
    pub fields: &'static [(&'static str, usize, &'static str)],
}

macro_rules! constants {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: usize = $value;)*
        /// Name and value of every constant that the shaders share.
        pub(super) const CONSTANTS: &[(&str, usize)] = &[$((stringify!($name), $name)),*];
    };
}

macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: u32 = $value;)*
        /// Name and value of every code that the shaders share.
        pub(super) const CODES: &[(&str, u32)] = &[$((stringify!($name), $name)),*];
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
        /// WGSL text of these structs.
        pub(super) const STRUCTS: &[&str] = &[$(concat!(
            "struct ", stringify!($name), " {\n",
            $("    ", stringify!($field), ": ", shared!(@wgsl $kind), ",\n",)*
            "}\n"
        )),*];
        /// How Rust lays these structs out.
        pub(super) const LAYOUTS: &[$crate::layout::Layout] = &[$($crate::layout::Layout {
            name: stringify!($name),
            size: size_of::<$name>(),
            fields: &[$((stringify!($field), std::mem::offset_of!($name, $field), shared!(@wgsl $kind))),*],
        }),*];
    };
    (@rust u32) => { u32 };
    (@rust f32) => { f32 };
    (@rust $nested:ident) => { $nested };
    (@rust [$element:ident; $n:ident]) => { [$element; $n] };
    (@wgsl u32) => { "u32" };
    (@wgsl f32) => { "f32" };
    (@wgsl $nested:ident) => { stringify!($nested) };
    (@wgsl [$element:ident; $n:ident]) => { concat!("array<", stringify!($element), ", ", stringify!($n), ">") };
}
