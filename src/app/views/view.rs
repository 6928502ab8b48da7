//! Table of the views: names, and what each shows.

use crate::scene::lesson::LessonView;

/// The views in the order of the menu: variant, name, and description of content and input.
macro_rules! views {
    ($($(#[doc = $doc:literal])+ $variant:ident $name:literal $about:literal;)*) => {
        /// A view of the window.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum View {
            $($(#[doc = $doc])+ $variant,)*
        }

        impl View {
            /// All views, in the order of the menu.
            pub const ALL: [Self; [$(Self::$variant),*].len()] = [$(Self::$variant),*];

            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// What it shows, and which input it takes.
            pub fn about(self) -> &'static str {
                match self {
                    $(Self::$variant => $about,)*
                }
            }
        }
    };
}

views! {
    /// The mechanism as a drawing.
    Mechanism "Mechanism"
        "The mass between its stops, seen from the base that shakes, with its flexures or a spring in \
         their place, and a spring, magnets or a transducer beside them. The arrow is the push that the mass \
         feels. Drag the mass or a stop.";
    /// The potential with the mass on it.
    Well "Well"
        "The mass rides on the potential like a ball on a tray that the push tips. Drag the ball or a \
         stop.";
    /// Displacement over time.
    Displacement "Displacement"
        "Where the mass is, seen from the base, over time. The wheel zooms in time; with Shift, or over \
         the numbers of the axis, in displacement. A double click is back.";
    /// The state before the last gesture, compared with the present one.
    BeforeNow "Before / now"
        "What your last change did: the state before it, and the one after it.";
    /// The pinned motions, compared with the present one.
    Compare "Compare"
        "The present motion beside those that are pinned: what each settles to, and by how much it differs. \
         A pin goes on with the drive in step; take its scene back by a click.";
    /// The measured data compared with the computed.
    Measured "Measured"
        "Measured data that lie over the computed: shift and stretch them in time, and read by how much the \
         two differ.";
    /// The present motion and a pinned one, each with its mechanism and its well.
    SideBySide "Side by side"
        "The present motion beside a pinned one, each in its own drawing and on its own well, at the same \
         time of the same shaking. The pinned one is not moved by hand.";
    /// Distance of the pinned motions from the present one over time.
    Distance "Distance"
        "How far each pinned motion is from the present one, over time. A twin begins a micrometre beside \
         the mass: chaos drives the two apart exponentially, a motion that is stable brings them together.";
    /// Velocity over displacement.
    PhasePortrait "Phase portrait"
        "Velocity over displacement: a moving mass runs clockwise. An impact is a jump of the velocity. \
         The separatrix needs just the energy to stand on the barrier. Click to let the motion go on from \
         a state.";
    /// The stroboscopic states.
    Section "Section"
        "The state once in every forcing period, always at the same phase of the shaking: motion that \
         repeats is a few points, chaos is a cloud with a shape. Click to let the motion go on from a state.";
    /// The force that holds the mass against the mechanism, over displacement.
    ForceCurve "Force curve"
        "The force that would hold the mass at a place, positive to the right; the mechanism pulls with as \
         much the other way. Where the push is above the curve it drives the mass to the right, below it \
         to the left; a mass on a stop is freed when the push passes the mark there. Filled: stable. \
         Hollow: unstable. Diamond: a kink, where the stiffness jumps.";
    /// The energy supplied, taken and stored.
    Energy "Energy"
        "Where the energy came from, where it went, and what is there against the barrier.";
    /// Velocity over time.
    Velocity "Velocity"
        "Velocity of the mass, seen from the base, over time. An impact turns it round and leaves a part \
         of it. The wheel zooms in time, a double click is back.";
    /// Acceleration of the base over time.
    BaseAcceleration "Base acceleration"
        "Acceleration of the base over time. The mass feels the opposite of it, as one does in a bus that \
         brakes. The wheel zooms in time, a double click is back.";
    /// Power into a load, or of the base into the mass, over time.
    Power "Power"
        "What the load of a transducer takes in a second, over time. Without a transducer the work of the \
         base on the mass; below zero the mass gives energy back to the base. The wheel zooms in time, a \
         double click is back.";
    /// The events of the motion as a table.
    Events "Events"
        "What happened when: impacts, rests, releases and crossings, with phase of the shaking, velocity \
         before and after, and energy lost. Click a row to look at that instant.";
    /// The results of runs for every combination of two fields.
    Map "Map"
        "What every combination of two settings comes to, each in a run of its own. Click to take the \
         scene there.";
    /// The motion over a field that is walked up and down.
    UpAndDown "Up and down"
        "One setting, turned up and then down slowly: each run goes on from where the one before was. Where \
         the two ways differ the motion remembers how it came: hysteresis. Drag along it to take the scene \
         there.";
    /// The basins of attraction.
    Basins "Basins"
        "Where the motion goes from every start, by colour, and what it is there. Each start is a \
         displacement and a velocity at time 0 of the shaking. Click to begin there.";
    /// The spectrum of the settled motion.
    Spectrum "Spectrum"
        "The oscillations that the settled motion is made of: their frequencies and amplitudes. One that \
         repeats has lines at multiples of its own frequency and nothing between; chaos fills the gaps.";
    /// The cost of accuracy, and the scene computed in fixed steps.
    Accuracy "Accuracy"
        "How far the computed motion is from the true one: what each digit costs, and what becomes of the \
         scene in fixed steps, as a game or a small applet takes them. From the scene's start.";
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Axis {
    /// The time of the traces.
    Time,
    /// The displacement, in m.
    Place,
    /// The displacement within the stops, in m.
    Reach,
    /// The horizontal axis of one view.
    Across(View),
    /// The vertical axis of one view.
    Up(View),
}

impl From<LessonView> for View {
    fn from(view: LessonView) -> Self {
        match view {
            LessonView::Mechanism => Self::Mechanism,
            LessonView::Well => Self::Well,
            LessonView::Displacement => Self::Displacement,
            LessonView::BeforeNow => Self::BeforeNow,
            LessonView::PhasePortrait => Self::PhasePortrait,
            LessonView::ForceCurve => Self::ForceCurve,
            LessonView::Energy => Self::Energy,
            LessonView::Velocity => Self::Velocity,
            LessonView::BaseAcceleration => Self::BaseAcceleration,
            LessonView::Map => Self::Map,
            LessonView::UpAndDown => Self::UpAndDown,
            LessonView::Basins => Self::Basins,
            LessonView::Spectrum => Self::Spectrum,
        }
    }
}

impl View {
    /// Whether it shows only the scene while the motion stands at its start.
    pub fn is_static(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::ForceCurve)
    }

    /// Whether it shows results of other settings or starts than the present ones.
    pub fn is_survey(self) -> bool {
        matches!(self, Self::Map | Self::UpAndDown | Self::Basins)
    }

    /// Whether its upper row is a legend, for which the row of its card may have room.
    pub fn has_legend(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::ForceCurve | Self::PhasePortrait | Self::Section)
            || self.is_over_time() && self != Self::Power
    }

    /// Whether its horizontal axis is time, so that it shows the cursors.
    pub fn is_over_time(self) -> bool {
        use View::{BaseAcceleration, Displacement, Distance, Power, Velocity};
        matches!(self, Displacement | Velocity | BaseAcceleration | Power | Distance)
    }

    /// Whether its axes can be zoomed and held.
    pub fn has_axes(self) -> bool {
        self.axes().is_some()
    }

    /// Whether its horizontal axis is the displacement.
    pub fn is_along_x(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::PhasePortrait | Self::Section | Self::ForceCurve)
    }

    /// Its horizontal and vertical axis. `None` if their ends cannot be chosen by hand.
    pub(super) fn axes(self) -> Option<[Axis; 2]> {
        let across = match self {
            Self::Displacement | Self::Velocity | Self::BaseAcceleration | Self::Power => Axis::Time,
            Self::Well | Self::ForceCurve | Self::Basins => Axis::Place,
            Self::PhasePortrait | Self::Section => Axis::Reach,
            Self::Distance | Self::UpAndDown | Self::Spectrum | Self::Accuracy => Axis::Across(self),
            Self::SideBySide => return Self::Well.axes(),
            _ => return None,
        };
        Some([across, Axis::Up(self)])
    }
}
