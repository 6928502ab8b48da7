//! Kinds of motion, which have a colour, a shape and a name each.

use crate::dynamics::Regime;

/// What kind of motion a sentence is about: its colour and its shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// At rest, or pressed on a stop.
    Resting,
    /// Stays in a well.
    Intrawell,
    /// Crosses without rhythm.
    Irregular,
    /// Crosses and repeats.
    Interwell,
    /// Crosses under a drive that has no period.
    Crossing,
    /// Anything that has no such name.
    Other,
    /// The scene cannot be run, or the run has ended.
    Fault,
}

impl From<Regime> for Kind {
    fn from(regime: Regime) -> Self {
        match regime {
            Regime::Rest => Self::Resting,
            Regime::Intrawell => Self::Intrawell,
            Regime::Irregular => Self::Irregular,
            Regime::Interwell => Self::Interwell,
            Regime::Crossing => Self::Crossing,
            Regime::OneWell => Self::Other,
        }
    }
}

impl Kind {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Resting => "at rest",
            Self::Intrawell => "intrawell",
            Self::Irregular => "irregular",
            Self::Interwell => "interwell",
            Self::Crossing => "crossing",
            // no wells or one: there is nothing to cross
            Self::Other | Self::Fault => "no barrier",
        }
    }
}
