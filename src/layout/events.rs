//! What one primitive step can bring about, and what rewards and goals are made of: a row each.

use super::world_parts::WorldPart;

/// Bit of a recorded step's choice at which its events begin.
pub const EVENTS_FROM: u32 = 24;
/// Bit of a recorded step's choice that says whether the choice was free: the events end below it.
pub const DECISION_BIT: u32 = 31;

macro_rules! named_bits {
    ($(#[doc = $about:literal])+ $type:ident, $count:ident, $bits:ident:
        $($(#[doc = $doc:literal])+ $name:ident = $bit:ident $number:literal, $text:literal;)*) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[repr(u32)]
        pub enum $type {
            $($(#[doc = $doc])+ $name = $number,)*
        }

        $(#[doc = concat!("Bit of [`", stringify!($type), "::", stringify!($name), "`].")]
        pub const $bit: u32 = 1 << $number;)*

        impl $type {
            /// All of them, by number.
            pub const ALL: [Self; $count] = [$(Self::$name),*];

            /// The name used in configs.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text),* }
            }

            /// When it happens, in words.
            pub const fn doc(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc),+)),* }
            }
        }

        /// How many there are.
        pub const $count: usize = [$($text),*].len();
        const $bits: [(&str, u32); $count] = [$((stringify!($bit), $bit)),*];
    };
}

macro_rules! events {
    ($($(#[doc = $doc:literal])+ $name:ident = $bit:ident $number:literal, $text:literal,
        mirror $mirror:ident, needs $needs:expr, told $told:ident;)*) => {
        named_bits! {
            /// Something that one primitive step can bring about; its number is its place in rewards.
            Event, EVENTS, BITS:
            $($(#[doc = $doc])+ $name = $bit $number, $text;)*
        }

        impl Event {
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

            /// After which actions the sensors tell whether it happened.
            const fn told(self) -> Told {
                match self { $(Self::$name => Told::$told),* }
            }
        }
    };
}

events! {
    /// The charger stopped a forward move with the contact point within the tolerance of the heading.
    Docked = DOCKED 0, "docked", mirror Docked, needs Some(WorldPart::Charger), told Never;
    /// A move was cut short by contact with anything, and did not dock.
    Collision = COLLISION 1, "collision", mirror Collision, needs None, told Never;
    /// The centre reached another room than the one before and is clear of the doorway.
    PassedDoor = PASSED_DOOR 2, "passed-door", mirror PassedDoor, needs Some(WorldPart::Doors), told Never;
    /// A forward move that was not blocked left the nearest sonar reading 30 to 150 degrees to the right between
    /// `robot.beside.near` and `robot.beside.far`.
    BesideRight = BESIDE_RIGHT 3, "beside-right", mirror BesideLeft, needs None, told Ahead;
    /// The same on the left.
    BesideLeft = BESIDE_LEFT 4, "beside-left", mirror BesideRight, needs None, told Ahead;
    /// After the action some bearing of the light sensor is lit.
    Lit = LIT 5, "lit", mirror Lit, needs Some(WorldPart::Light), told Always;
    /// An action was taken, whatever came of it: what it is paid is the cost of a step.
    Acted = ACTED 6, "step", mirror Acted, needs None, told Never;
}

/// After which actions the sensors tell whether something happened.
#[derive(Clone, Copy)]
enum Told {
    /// The motion alone tells.
    Never,
    /// After forward moves.
    Ahead,
    Always,
}

impl Event {
    /// Bits of the events that the sensors tell of after an action: after a forward move, or any other.
    pub const fn told_by_sensors(ahead: bool) -> u32 {
        let (mut bits, mut event) = (0, 0);
        while event < EVENTS {
            let told = matches!((Self::ALL[event].told(), ahead), (Told::Always, _) | (Told::Ahead, true));
            bits |= if told { Self::ALL[event].bit() } else { 0 };
            event += 1;
        }
        bits
    }
}

named_bits! {
    /// Something that one primitive step can bring about in one of the regions that a skill names. Its bit is that among
    /// the events of one region, and configs write the region in brackets behind its name.
    RegionEvent, REGION_EVENTS, REGION_BITS:
    /// The action ended with the robot's centre in the region.
    In = IN_REGION 0, "in";
    /// The action brought the robot's centre into the region.
    Entered = ENTERED_REGION 1, "entered";
    /// The action took the robot's centre out of the region.
    Left = LEFT_REGION 2, "left";
}

impl RegionEvent {
    /// Its place in rewards, and its bit in sets of events, for this one of a skill's regions.
    pub const fn number(self, region: usize) -> usize {
        EVENTS + region * REGION_EVENTS + self as usize
    }
}

/// Most regions whose events a skill's reward and goal name. Ours.
pub const MAX_REGIONS: usize = 4;
/// Events of a skill: those of every region stand behind those that need none.
pub const SKILL_EVENTS: usize = EVENTS + MAX_REGIONS * REGION_EVENTS;

/// Name in shaders and value of the numbers that have to do with events, without the events' own bits.
pub(super) const CODES: &[(&str, u32)] = &[
    ("EVENTS", EVENTS as u32),
    ("REGION_EVENTS", REGION_EVENTS as u32),
    ("MAX_REGIONS", MAX_REGIONS as u32),
    ("SKILL_EVENTS", SKILL_EVENTS as u32),
    ("EVENTS_FROM", EVENTS_FROM),
    ("RECORDED_EVENTS", RECORDED_EVENTS),
    ("DECISION_BIT", DECISION_BIT),
];
/// Name in shaders and value of every event's bit.
pub(super) const EVENT_BITS: [&[(&str, u32)]; 2] = [&BITS, &REGION_BITS];

const _: () = assert!(SKILL_EVENTS <= 32, "the events of a skill fit no word");
/// The events that have a bit in recorded choices: the first ones, as many as fit below the decision bit.
pub const RECORDED_EVENTS: u32 = (1 << (DECISION_BIT - EVENTS_FROM)) - 1;
