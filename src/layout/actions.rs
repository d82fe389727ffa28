//! The primitive actions (paper, section III): a row each.

/// Code that stands for no action.
pub const NO_ACTION: u32 = 255;

macro_rules! actions {
    ($($(#[doc = $doc:literal])+ $name:ident = $code:ident $number:literal, $text:literal,
        turn $turn:literal, travel $travel:literal, mirror $mirror:ident;)*) => {
        /// A primitive action; its number is its code in every buffer.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
        #[repr(u32)]
        pub enum Action {
            $($(#[doc = $doc])+ $name = $number,)*
        }

        $(#[doc = concat!("Code of [`Action::", stringify!($name), "`].")] pub const $code: u32 = $number;)*

        impl Action {
            /// All of them, by code.
            pub const ALL: [Self; ACTIONS] = [$(Self::$name),*];

            /// The name used in configs, on the command line and in files.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text),* }
            }

            /// Turn of the heading in degrees, counter-clockwise.
            pub const fn turn(self) -> f32 {
                match self { $(Self::$name => $turn),* }
            }

            /// Travel along the heading in inches.
            pub const fn travel(self) -> f32 {
                match self { $(Self::$name => $travel),* }
            }

            /// What a mirror shows of it: a turn the other way.
            pub const fn mirrored(self) -> Self {
                match self { $(Self::$name => Self::$mirror),* }
            }

            /// What it does, in words.
            pub const fn doc(self) -> &'static str {
                match self { $(Self::$name => concat!($($doc),+)),* }
            }
        }

        /// Number of actions.
        pub const ACTIONS: usize = [$($text),*].len();
        /// Turn of each action, degrees counter-clockwise.
        pub const ACTION_TURN: [f32; ACTIONS] = [$($turn),*];
        /// Name in shaders and code of every action.
        pub(super) const CODES: &[(&str, u32)] = &[$((stringify!($code), $number)),*, ("NO_ACTION", NO_ACTION)];
    };
}

actions! {
    /// Turn 15 degrees counter-clockwise.
    TurnLeft15 = TURN_LEFT_15 0, "turn+15", turn 15.0, travel 0.0, mirror TurnRight15;
    /// Turn 15 degrees clockwise.
    TurnRight15 = TURN_RIGHT_15 1, "turn-15", turn -15.0, travel 0.0, mirror TurnLeft15;
    /// Turn 60 degrees counter-clockwise.
    TurnLeft60 = TURN_LEFT_60 2, "turn+60", turn 60.0, travel 0.0, mirror TurnRight60;
    /// Turn 60 degrees clockwise.
    TurnRight60 = TURN_RIGHT_60 3, "turn-60", turn -60.0, travel 0.0, mirror TurnLeft60;
    /// Move 12 inches along the heading.
    Forward = FORWARD 4, "move+12", turn 0.0, travel 12.0, mirror Forward;
    /// Move 12 inches against the heading.
    Backward = BACKWARD 5, "move-12", turn 0.0, travel -12.0, mirror Backward;
}

// Codes from SKILL_CODE on are skills.
const _: () = assert!(ACTIONS <= super::SKILL_CODE, "an action's code must stay below SKILL_CODE");
