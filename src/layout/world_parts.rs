//! What a floor plan may have or lack.

/// A part of a floor plan that an event or a sensor needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorldPart {
    /// `[charger]`.
    Charger,
    /// `[[doors]]`.
    Doors,
    /// `[light]`.
    Light,
}

impl WorldPart {
    /// What messages call it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Charger => "charger",
            Self::Doors => "doors",
            Self::Light => "light",
        }
    }

    /// How a world file writes it.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Charger => "[charger]",
            Self::Doors => "[[doors]]",
            Self::Light => "[light]",
        }
    }
}
