//! Ground floor: the words of every buffer that a kernel touches, written once.
//!
//! Each struct is declared for Rust and, from the same lines, for WGSL: [`prelude`] is the text that opens every
//! shader. All fields are 32 bits wide, so both languages give them the same offsets.

#[macro_use]
mod macros;

pub mod actions;
pub mod choices;
mod dispatch;
pub mod events;
pub mod params;
pub mod phase;
pub mod prelude;
pub mod purpose;
pub mod schema;
pub mod sensors;
mod shape;
mod sizes;
mod state;
mod world;
mod world_parts;

pub use actions::{ACTIONS, Action};
pub use dispatch::Dispatch;
pub use events::{EVENTS, Event};
pub use macros::Layout;
pub use params::{HyperParams, Noise};
pub use sensors::Input;
pub use shape::SkillShape;
pub use sizes::*;
pub use state::{Agent, Episode, LearnerState, Robot};
pub use world::{Area, Segment, WorldUniform};
pub use world_parts::WorldPart;

/// How Rust lays out every struct that the shaders share.
pub const LAYOUTS: [&[Layout]; 5] =
    [world::LAYOUTS, shape::LAYOUTS, params::LAYOUTS, state::LAYOUTS, dispatch::LAYOUTS];

/// WGSL text of every one of them.
const STRUCTS: [&[&str]; 5] = [world::STRUCTS, shape::STRUCTS, params::STRUCTS, state::STRUCTS, dispatch::STRUCTS];

/// How Rust lays out the struct of this name.
pub fn layout_of(name: &str) -> Option<&'static Layout> {
    LAYOUTS.into_iter().flatten().find(|layout| layout.name == name)
}
