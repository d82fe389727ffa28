//! What one primitive step can bring about, and what rewards and goals are made of: a row each.

use super::world_parts::WorldPart;

/// Bit of a recorded step's choice at which its events begin.
pub const EVENTS_FROM: u32 = 24;
/// Bit of a recorded step's choice that says whether the choice was free: the events end below it.
pub const DECISION_BIT: u32 = 31;

macro_rules! events {
    ($($(#[doc = $doc:literal])+ $name:ident = $bit:ident $number:literal, $text:literal,
        mirror $mirror:ident, needs $needs:expr;)*) => {
        /// Something that one primitive step can bring about; its number is its place in rewards.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(u32)]
        pub enum Event {
            $($(#[doc = $doc])+ $name = $number,)*
        }

        $(#[doc = concat!("Bit of [`Event::", stringify!($name), "`] in sets of events.")]
        pub const $bit: u32 = 1 << $number;)*

        impl Event {
            /// All of them, by number.
            pub const ALL: [Self; EVENTS] = [$(Self::$name),*];

            /// The name used in configs.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text),* }
            }

            /// Its bit in sets of events.
            pub const fn bit(self) -> u32 {
                match self { $(Self::$name => $bit),* }
            }

            /// What a mirror shows of it.
            pub const fn mirrored(self) -> Self {
                match self { $(Self::$name => Self::$mirror),* }
            }

            /// What a world must have for it to happen there.
            pub const fn needs(self) -> Option<WorldPart> {
                match self { $(Self::$name => $needs),* }
            }

            /// When it happens, in words.
            pub const fn doc(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc),+)),* }
            }
        }

        /// Number of events.
        pub const EVENTS: usize = [$($text),*].len();
        /// Name in shaders and value of every event's bit, of their number, and of where they stand.
        pub(super) const CODES: &[(&str, u32)] = &[
            $((stringify!($bit), $bit),)*
            ("EVENTS", EVENTS as u32), ("EVENTS_FROM", EVENTS_FROM), ("DECISION_BIT", DECISION_BIT),
        ];
    };
}

events! {
    /// The charger stopped a forward move with the contact point within the tolerance of the heading.
    Docked = DOCKED 0, "docked", mirror Docked, needs Some(WorldPart::Charger);
    /// A move was cut short by contact with anything, and did not dock.
    Collision = COLLISION 1, "collision", mirror Collision, needs None;
    /// The centre reached another room than the one before and is clear of the doorway.
    PassedDoor = PASSED_DOOR 2, "passed-door", mirror PassedDoor, needs Some(WorldPart::Doors);
    /// A forward move that was not blocked left the nearest sonar reading 30 to 150 degrees to the right between
    /// `robot.beside.near` and `robot.beside.far`.
    BesideRight = BESIDE_RIGHT 3, "beside-right", mirror BesideLeft, needs None;
    /// The same on the left.
    BesideLeft = BESIDE_LEFT 4, "beside-left", mirror BesideRight, needs None;
}

const _: () = assert!(EVENTS_FROM + EVENTS as u32 <= DECISION_BIT, "an event's bit would meet the decision bit");
