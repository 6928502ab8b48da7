//! Kinds of motion, each with a colour, a shape and a name.

use crate::dynamics::Regime;

/// The kind of motion that a sentence is about; it sets colour and shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// At rest, or pressed on a stop.
    Resting,
    Intrawell,
    /// Crosses, and the crossings do not repeat.
    Irregular,
    /// Crosses, and the crossings repeat.
    Interwell,
    /// Crosses under a drive that has no period.
    Crossing,
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
    pub fn name(self) -> &'static str {
        match self {
            Self::Resting => "at rest",
            Self::Intrawell => "intrawell",
            Self::Irregular => "irregular",
            Self::Interwell => "interwell",
            Self::Crossing => "crossing",
            // with one well or none
            Self::Other | Self::Fault => "without a barrier",
        }
    }
}
