//! Ground floor: the words of every buffer that a kernel touches, written once.
//!
//! Each struct is declared for Rust and, from the same lines, for WGSL: [`prelude`] is the text that opens every
//! shader. All fields are 32 bits wide, so both languages give them the same offsets.

#[macro_use]
mod macros;

pub mod actions;
pub mod choices;
mod codes;
mod dispatch;
pub mod events;
pub mod lengths;
pub mod params;
pub mod prelude;
pub mod purpose;
mod records;
pub mod schema;
pub mod sensors;
pub mod shader;
mod shape;
mod sizes;
mod state;
mod world;
mod world_parts;

pub use actions::{ACTIONS, Action};
pub use codes::*;
pub use dispatch::Dispatch;
pub use events::{EVENTS, Event, MAX_REGIONS, REGION_EVENTS, RegionEvent, SKILL_EVENTS};
pub use macros::Layout;
pub use params::{HyperParams, Noise};
pub use prelude::{LAYOUTS, layout_of};
pub use records::{
    ELEMENTARY_STEP_WORDS, LESSON_HEADER_WORDS, LessonHeader, Observation, STEP_WORDS, Step, TRIAL_WORDS, TrialRecord,
};
pub use sensors::Input;
pub use shape::SkillShape;
pub use sizes::*;
pub use state::{Agent, Boltzmann, Episode, LearnerState, Moved, Robot};
pub use world::{Area, Segment, WorldUniform};
pub use world_parts::WorldPart;
