//! What a skill is: its children, its inputs, what pays, what ends it.

use super::Learning;

/// A skill as defined in TOML.
#[derive(Debug, Clone, PartialEq)]
pub struct Skill {
    /// Key of the skill in the config.
    pub name: String,
    /// The net's inputs, in order.
    pub inputs: Vec<Input>,
    /// What the skill chooses among: actions, or skills that stand before it.
    pub children: Vec<Child>,
    /// For each child, from what value on it is applicable; none for a child that always is.
    pub applicable: Vec<Option<Threshold>>,
    /// How a child is chosen.
    pub choice: Choice,
    /// Keeping to the chosen child.
    pub persistence: Persistence,
    /// Index of the skill whose nets this one uses as their mirror image; it has no trials of its own.
    pub mirror: Option<usize>,
    /// Whether the planner, which knows floor plan and pose, stands in for the nets. Privileged.
    pub planned: bool,
    /// Amount paid for each event, in the order of [`Event::ALL`].
    pub reward: [f32; Event::ALL.len()],
    /// Where training trials start: regions of the world and the share of trials that start there (shares sum to 1).
    pub starts: Vec<(String, f32)>,
    /// Region in which tests start.
    pub tests: String,
    /// Trials after which the skill is tested, ascending; it also is after its last one.
    pub tested_at: Vec<u32>,
    /// Bits of the events (see [`Event::bit`]) that end a trial as achieved.
    pub ends: u32,
    /// Primitive steps after which a trial is cut, 1 to 255.
    pub max_steps: u32,
    /// Taught lessons given before the first trial.
    pub lessons: u32,
    /// Training trials.
    pub trials: u32,
    /// How the skill is learned.
    pub learning: Learning,
}

impl Skill {
    /// Whether the children are skills.
    pub fn is_high(&self) -> bool {
        self.children.iter().any(|child| matches!(child, Child::Skill(_)))
    }

    /// Children that have an applicability threshold.
    pub fn thresholds(&self) -> u32 {
        self.applicable.iter().flatten().count() as u32
    }

    /// The actions below it: its own, or all for one that chooses among skills.
    pub fn actions(&self) -> Vec<Action> {
        let own = self.children.iter().filter_map(|child| match child {
            Child::Action(action) => Some(*action),
            Child::Skill(_) => None,
        });
        if self.is_high() { Action::ALL.to_vec() } else { own.collect() }
    }

    /// Inputs of each net in a world of so many rooms.
    pub fn width(&self, rooms: usize) -> u32 {
        self.inputs.iter().map(|input| input.width(self, rooms)).sum()
    }
}

/// What a skill can choose: nothing else tells elementary from high-level skills.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Child {
    /// A primitive action.
    Action(Action),
    /// The skill at this index of the arm's skills.
    Skill(usize),
}

impl Child {
    /// What a mirror shows of it: a turn the other way.
    pub fn mirrored(self) -> Self {
        match self {
            Self::Action(Action::TurnLeft15) => Self::Action(Action::TurnRight15),
            Self::Action(Action::TurnRight15) => Self::Action(Action::TurnLeft15),
            Self::Action(Action::TurnLeft60) => Self::Action(Action::TurnRight60),
            Self::Action(Action::TurnRight60) => Self::Action(Action::TurnLeft60),
            same => same,
        }
    }
}

/// From which value of its best child on a skill is applicable (paper, section VI.B).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Threshold {
    /// Set by hand, in units of Q (reward / `reward_scale`).
    Fixed(f32),
    /// Learned from the skill's own training trials: the value at which success has this probability.
    Learned(f32),
}

/// How a skill's child is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Choice {
    /// By the learned Q-values.
    Learned = 0,
    /// Uniformly at random among those allowed. A baseline.
    Random = 1,
    /// The first allowed one, in the order of `children`: fixed arbitration. A baseline.
    Ordered = 2,
}

/// The Persistence Rule (paper, section VI.B) and our additions to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Persistence {
    /// Whether it holds in training.
    pub training: bool,
    /// Whether it holds in tests too.
    pub tests: bool,
    /// Whether applicability limits the choice.
    pub applicability: bool,
    /// Whether a running child that stops being applicable may be left. Ours.
    pub interrupt: bool,
    /// Steps without any event after which the choice is open again, 0 for never. Ours.
    pub decision_steps: u32,
}

/// One group of a net's inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Input {
    /// 24 values `2 exp(-(d - 12) / scale) - 1` of the sonar reading `d`: fine near the body. Our choice.
    Sonar {
        /// Decay in inches.
        scale: f32,
    },
    /// 24 values `2 d / 127 - 1`. Our choice.
    SonarFar,
    /// 24 values 0 or 1.
    Light,
    /// Four values 0 or 1: front, left, back, right.
    Bumpers,
    /// Cosine and sine of the compass reading.
    Compass,
    /// Cosine and sine of twice the compass reading.
    Compass2,
    /// [`Input::Sonar`] turned by the compass, so that the first value looks east, the next 15 degrees
    /// counter-clockwise, interpolated between readings.
    SonarCompass {
        /// Decay in inches.
        scale: f32,
    },
    /// 1 where any bearing is lit.
    Lit,
    /// The best Q-value of each child that has a threshold.
    Values,
    /// 1 for each child that has a threshold and is applicable.
    Applicable,
    /// 1 for the child that has been running.
    Running,
    /// Trace of having seen the light in this trial.
    LightTrace,
    /// Trace of having passed a door in this trial, and its product with the cosine and sine of the compass then.
    DoorTrace,
    /// Running means of the ranges east and west together, and north and south together.
    RangeMeans,
    /// 1 for the room the robot is in. Privileged: no sensor tells.
    Room,
}

impl Input {
    /// Number of inputs that the group takes in a net of `skill`, in a world of so many rooms.
    pub fn width(self, skill: &Skill, rooms: usize) -> u32 {
        match self {
            Self::Sonar { .. } | Self::SonarFar | Self::SonarCompass { .. } | Self::Light => 24,
            Self::Bumpers => 4,
            Self::Compass | Self::Compass2 | Self::RangeMeans => 2,
            Self::Lit | Self::LightTrace => 1,
            Self::DoorTrace => 3,
            Self::Values | Self::Applicable => skill.thresholds(),
            Self::Running => skill.children.len() as u32,
            Self::Room => rooms as u32,
        }
    }
}

/// A primitive move (paper, section III).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Action {
    /// Turn 15 degrees counter-clockwise.
    TurnLeft15 = 0,
    /// Turn 15 degrees clockwise.
    TurnRight15 = 1,
    /// Turn 60 degrees counter-clockwise.
    TurnLeft60 = 2,
    /// Turn 60 degrees clockwise.
    TurnRight60 = 3,
    /// Move 12 inches along the heading.
    Forward = 4,
    /// Move 12 inches against the heading.
    Backward = 5,
}

impl Action {
    /// All six, by code.
    pub const ALL: [Self; 6] =
        [Self::TurnLeft15, Self::TurnRight15, Self::TurnLeft60, Self::TurnRight60, Self::Forward, Self::Backward];

    /// The name used in configs, on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::TurnLeft15 => "turn+15",
            Self::TurnRight15 => "turn-15",
            Self::TurnLeft60 => "turn+60",
            Self::TurnRight60 => "turn-60",
            Self::Forward => "move+12",
            Self::Backward => "move-12",
        }
    }

    /// Turn of the heading in degrees, counter-clockwise.
    pub fn turn(self) -> f32 {
        match self {
            Self::TurnLeft15 => 15.0,
            Self::TurnRight15 => -15.0,
            Self::TurnLeft60 => 60.0,
            Self::TurnRight60 => -60.0,
            Self::Forward | Self::Backward => 0.0,
        }
    }

    /// Travel along the heading in inches.
    pub fn travel(self) -> f32 {
        match self {
            Self::Forward => 12.0,
            Self::Backward => -12.0,
            _ => 0.0,
        }
    }
}

/// Something that one primitive step can bring about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Event {
    /// The charger stopped a forward move with the contact point within the tolerance of the heading.
    Docked = 0,
    /// A move was cut short by contact with anything.
    Collision = 1,
    /// The centre reached another room than the one before and is clear of the doorway.
    PassedDoor = 2,
    /// A forward move that was not blocked left the nearest sonar reading 30 to 150 degrees to the right between
    /// `robot.beside_near` and `robot.beside_far`.
    BesideRight = 3,
    /// The same on the left.
    BesideLeft = 4,
}

impl Event {
    /// All events, by code.
    pub const ALL: [Self; 5] = [Self::Docked, Self::Collision, Self::PassedDoor, Self::BesideRight, Self::BesideLeft];

    /// The name used in configs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Docked => "docked",
            Self::Collision => "collision",
            Self::PassedDoor => "passed-door",
            Self::BesideRight => "beside-right",
            Self::BesideLeft => "beside-left",
        }
    }

    /// The event's bit in event sets.
    pub fn bit(self) -> u32 {
        1 << self as u32
    }
}
