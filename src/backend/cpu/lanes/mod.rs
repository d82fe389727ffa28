//! The hot functions in the CPU's way: several nets, lines or robots side by side, numbers by value so that the compiler
//! keeps them in vectors, lists of what matters where a workgroup looks at everything.
//!
//! They leave the bytes of the plain twins: no sum changes its order, and what a list leaves out changes no bit.

pub mod contact;
pub mod draws;
pub mod forward;
pub mod light;
pub mod observe;
pub mod optimiser;
pub mod sonar;
pub mod step;
