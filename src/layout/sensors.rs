//! What a skill's nets can be given: a row for each group of inputs.

use super::sizes::RAYS;
use super::world_parts::WorldPart;

/// Decay of the sonar's near coding where an input names none, inches. Ours.
pub const SONAR_SCALE: f32 = 60.0;

/// What is the same for all inputs of one kind.
#[derive(Debug, Clone, Copy)]
struct InputRow {
    /// The name used in configs.
    name: &'static str,
    /// Code by which kernels tell how to fill the group.
    group: u32,
    /// Number of inputs.
    width: Width,
    /// Whether a mirror shows it as another reading of the same kind.
    mirrored: bool,
    /// Whether its inputs are bits, which a net adds up without multiplying.
    bits: bool,
    /// Whether it stands in the part of a recorded step that only some skills need.
    recalled: bool,
    /// What a world must have for it to show anything.
    needs: Option<WorldPart>,
}

/// How many inputs a group has.
#[derive(Debug, Clone, Copy)]
enum Width {
    Fixed(u32),
    /// One per child that has a threshold.
    Thresholds,
    Children,
    Rooms,
}

/// What most inputs are.
const PLAIN: InputRow =
    InputRow { name: "", group: 0, width: Width::Fixed(1), mirrored: false, bits: false, recalled: false, needs: None };

macro_rules! inputs {
    ($($(#[doc = $doc:literal])+ $name:ident $({ $scale:ident })? = $text:literal, $group:ident $($code:literal)?,
        $($field:ident: $value:expr),*;)*) => {
        /// One group of a net's inputs.
        #[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
        pub enum Input {
            $($(#[doc = $doc])+ $name $({
                /// Decay in inches.
                $scale: f32,
            })?,)*
        }

        $($(
            #[doc = concat!("Code of the input group `", $text, "`.")]
            pub const $group: u32 = $code;
        )?)*

        impl Input {
            /// All of them, with default scales.
            pub const ALL: &[Self] = &[$(Self::$name $({ $scale: SONAR_SCALE })?),*];

            /// What it is, in words.
            pub const fn doc(self) -> &'static str {
                match self { $(Self::$name { .. } => concat!($($doc),+)),* }
            }

            const fn row(self) -> InputRow {
                match self {
                    $(Self::$name { .. } => InputRow { name: $text, group: $group, $($field: $value,)* ..PLAIN }),*
                }
            }

            /// Decay of its coding in inches, if it has one.
            pub const fn scale(self) -> Option<f32> {
                match self {
                    $($(Self::$name { $scale } => Some($scale),)?)*
                    _ => None,
                }
            }

            /// The same input with another decay; none if it has none.
            pub const fn with_scale(self, value: f32) -> Option<Self> {
                match self {
                    $($(Self::$name { $scale: _ } => Some(Self::$name { $scale: value }),)?)*
                    _ => None,
                }
            }
        }

        /// Name in shaders and code of every kind of group.
        pub(super) const CODES: &[(&str, u32)] = &[$($((stringify!($group), $code),)?)*];
    };
}

inputs! {
    /// 24 values `2 exp(-(d - 12) / scale) - 1` of the sonar reading `d`: fine near the body. Our choice.
    Sonar { scale } = "sonar", GROUP_SONAR 0, width: Width::Fixed(RAYS as u32), mirrored: true;
    /// 24 values `2 d / 127 - 1` of the sonar reading `d`. Our choice.
    SonarFar = "sonar-far", GROUP_SONAR, width: Width::Fixed(RAYS as u32), mirrored: true;
    /// As `sonar`, turned by the compass, so that the first value looks east, the next 15 degrees counter-clockwise,
    /// interpolated between readings.
    SonarCompass { scale } = "sonar-compass", GROUP_SONAR_COMPASS 5, width: Width::Fixed(RAYS as u32);
    /// 24 values 0 or 1.
    Light = "light", GROUP_LIGHT 1,
        width: Width::Fixed(RAYS as u32), mirrored: true, bits: true, needs: Some(WorldPart::Light);
    /// 1 where any bearing is lit.
    Lit = "lit", GROUP_LIT 6, needs: Some(WorldPart::Light);
    /// Four values 0 or 1: front, left, back, right.
    Bumpers = "bumpers", GROUP_BUMPERS 2, width: Width::Fixed(4), mirrored: true, bits: true;
    /// Cosine and sine of the compass reading.
    Compass = "compass", GROUP_COMPASS 3, width: Width::Fixed(2);
    /// Cosine and sine of twice the compass reading.
    Compass2 = "compass2", GROUP_COMPASS2 4, width: Width::Fixed(2);
    /// The best Q-value of each child that has a threshold.
    Values = "values", GROUP_VALUES 7, width: Width::Thresholds;
    /// 1 for each child that has a threshold and is applicable.
    Applicable = "applicable", GROUP_APPLICABLE 8, width: Width::Thresholds;
    /// 1 for the child that has been running.
    Running = "running", GROUP_RUNNING 9, width: Width::Children, recalled: true;
    /// Trace of having seen the light in this trial.
    LightTrace = "light-trace", GROUP_LIGHT_TRACE 10, recalled: true, needs: Some(WorldPart::Light);
    /// Trace of having passed a door in this trial, and its product with the cosine and sine of the compass then.
    DoorTrace = "door-trace", GROUP_DOOR_TRACE 11,
        width: Width::Fixed(3), recalled: true, needs: Some(WorldPart::Doors);
    /// Running means of the ranges east and west together, and north and south together.
    RangeMeans = "range-means", GROUP_RANGE_MEANS 12, width: Width::Fixed(2), recalled: true;
    /// 1 for the room the robot is in. Privileged: no sensor tells.
    Room = "room", GROUP_ROOM 13, width: Width::Rooms, recalled: true;
}

impl Input {
    /// The name used in configs, without a scale.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Code by which kernels tell how to fill the group.
    pub const fn group(self) -> u32 {
        self.row().group
    }

    /// Number of inputs that the group takes: `thresholds` children of the skill's `children` have a threshold, and
    /// the world has so many `rooms`.
    pub const fn width(self, thresholds: u32, children: u32, rooms: u32) -> u32 {
        match self.row().width {
            Width::Fixed(width) => width,
            Width::Thresholds => thresholds,
            Width::Children => children,
            Width::Rooms => rooms,
        }
    }

    /// The width in words.
    pub fn width_in_words(self) -> String {
        match self.row().width {
            Width::Fixed(width) => width.to_string(),
            Width::Thresholds => "1 per threshold".to_owned(),
            Width::Children => "1 per child".to_owned(),
            Width::Rooms => "1 per room".to_owned(),
        }
    }

    /// Whether a mirror shows it as another reading of the same kind.
    pub const fn is_mirrored(self) -> bool {
        self.row().mirrored
    }

    /// Whether its inputs are bits, which a net adds up without multiplying.
    pub const fn is_bits(self) -> bool {
        self.row().bits
    }

    /// Whether it stands in the part of a recorded step that only some skills need.
    pub const fn is_recalled(self) -> bool {
        self.row().recalled
    }

    /// What a world must have for it to show anything.
    pub const fn needs(self) -> Option<WorldPart> {
        self.row().needs
    }
}
