//! The files that shaders are made of.

/// One WGSL file.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// Path below `shaders/`; its twin has the same path below `src/`.
    pub path: &'static str,
    /// The file's text.
    pub text: &'static str,
}

/// The files at some paths below `shaders/`.
macro_rules! parts {
    ($($path:literal),* $(,)?) => {
        &[$($crate::layout::shader::Part {
            path: $path,
            text: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $path)),
        }),*]
    };
}
pub(crate) use parts;
