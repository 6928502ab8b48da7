//! Table of the views: names, and what each shows.

use eframe::egui::{Ui, vec2};

use crate::scene::lesson::LessonView;

use super::context::{ViewContext, sized_ui};
use super::phase::states_ui;
use super::trace::{TraceQuantity, trace_ui};

/// The views in the order of the menu: variant, name, least width and height in points, the function that
/// draws it, and description of content and input.
macro_rules! views {
    ($(
        $(#[$attribute:meta])*
        $variant:ident $name:literal ($width:literal, $height:literal) $draw:expr, $about:literal;
    )*) => {
        /// A view of the window.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum View {
            $($(#[$attribute])* #[doc = $about] $variant,)*
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

            /// Draws it in all of `ui`.
            pub(super) fn ui(self, ui: &mut Ui, context: &mut ViewContext<'_>) {
                match self {
                    $(Self::$variant => sized_ui(ui, context, vec2($width, $height), $draw),)*
                }
            }
        }
    };
}

views! {
    Mechanism "Mechanism" (60.0, 60.0) super::mechanism::mechanism_ui,
        "The mass between its stops, seen from the base, with its flexures or a spring in their \
         place, and a spring, magnets or a transducer beside them. The arrow is the push that the mass \
         feels. Drag the mass or a stop.";
    Well "Well" (60.0, 60.0) super::well::well_ui,
        "The mass rides on the potential like a ball on a tray that the push tips. Drag the ball or a \
         stop.";
    Displacement "Displacement" (0.0, 0.0) |ui, context| trace_ui(ui, TraceQuantity::Displacement, context),
        "Where the mass is, seen from the base, over time. A click goes to a time. The wheel zooms in time; \
         with Shift, or over the numbers of the axis, in displacement. A double click resets both.";
    #[serde(alias = "BeforeNow", alias = "SideBySide", alias = "Distance")]
    Compare "Compare" (0.0, 0.0) super::compare::compare_ui,
        "The scene as it was opened, or pinned (K), and as it is now: what each settles to, and by how much \
         they differ. The former goes on, dashed, in step with the drive; a click takes its scene back.";
    Measured "Measured" (0.0, 0.0) super::measured::measured_ui,
        "Measured data over the computed motion or force: shift and stretch them in time, and read by how \
         much the two differ.";
    PhasePortrait "Phase portrait" (60.0, 80.0) |ui, context| states_ui(ui, context, false),
        "Velocity over displacement: a moving mass runs clockwise. An impact is a jump of the velocity. \
         The separatrix needs just the energy to stand on the barrier. Click to let the motion go on from \
         a state.";
    Section "Section" (0.0, 0.0) super::phase::section_ui,
        "The state once in every forcing period, always at the same phase of the shaking: motion that \
         repeats is a few points, chaos is a cloud with a shape. Click to let the motion go on from a state.";
    ForceCurve "Force curve" (60.0, 80.0) super::force::force_ui,
        "The force that would hold the mass at a place, positive to the right; the mechanism pulls as hard \
         in the opposite direction. Where the push is above the curve it drives the mass to the right, below \
         it to the left; a mass on a stop is freed when the push passes the mark there. Filled: stable. \
         Hollow: unstable. Diamond: a kink, where the stiffness jumps.";
    Energy "Energy" (192.0, 148.0) super::energy::energy_ui,
        "Where the energy came from, where it went, and how the present energy compares with the barrier.";
    Velocity "Velocity" (0.0, 0.0) |ui, context| trace_ui(ui, TraceQuantity::Velocity, context),
        "Velocity of the mass, seen from the base, over time. An impact reverses it and reduces \
         it. A click goes to a time; the wheel zooms in time, a double click resets that.";
    BaseAcceleration "Base acceleration" (0.0, 0.0)
        |ui, context| trace_ui(ui, TraceQuantity::BaseAcceleration, context),
        "Acceleration of the base over time. The mass feels the opposite of it, as one does in a bus that \
         brakes. A click goes to a time; the wheel zooms in time, a double click resets that.";
    Power "Power" (0.0, 0.0) super::power::power_ui,
        "The power into the load of a transducer over time. Without a transducer the work of the base on the \
         mass; below zero the mass gives energy back to the base. A click goes to a time; the wheel zooms \
         in time, a double click resets that.";
    Events "Events" (160.0, 90.0) super::events::events_ui,
        "What happened when: impacts, rests, releases and crossings, with phase of the shaking, velocity \
         before and after, and energy lost. Click a row to look at that instant.";
    Map "Map" (0.0, 0.0) super::map::map_ui,
        "The result of every combination of two settings, each from one run. Click to take the \
         scene there; a part that is zoomed in becomes a map of its own.";
    UpAndDown "Up and down" (200.0, 140.0) super::up_and_down::up_and_down_ui,
        "One setting, turned up and then down slowly: each run starts in the last state of the one before. \
         Where the two directions differ, the motion depends on its history: hysteresis. Click to take \
         the scene there, or drag the line at it.";
    Basins "Basins" (100.0, 100.0) super::basins::basins_ui,
        "The motion that every start leads to, by colour. Each start is a \
         displacement and a velocity at time 0 of the shaking. Click to begin there.";
    Spectrum "Spectrum" (200.0, 140.0) super::spectrum::spectrum_ui,
        "The oscillations that the settled motion is made of: their frequencies and amplitudes. A motion \
         that repeats has lines at multiples of its frequency and nothing between; chaos fills the gaps.";
    Accuracy "Accuracy" (180.0, 112.0) super::accuracy::accuracy_ui,
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
    /// The axes of what a digit costs.
    CostAcross,
    CostUp,
}

impl Axis {
    /// The units of its pictures in one of its own: mm in m.
    pub(super) fn per_own(self) -> f64 {
        if matches!(self, Self::Place | Self::Reach) { 1e3 } else { 1.0 }
    }
}

impl From<LessonView> for View {
    fn from(view: LessonView) -> Self {
        match view {
            LessonView::Mechanism => Self::Mechanism,
            LessonView::Well => Self::Well,
            LessonView::Displacement => Self::Displacement,
            LessonView::Compare => Self::Compare,
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

    /// The view that a word in lower case names; the barrier and the stops are shown in the well.
    pub fn named(word: &str) -> Option<Self> {
        match word {
            "barrier" | "stops" | "stop" => Some(Self::Well),
            _ => Self::ALL.into_iter().find(|view| view.name().to_lowercase() == word),
        }
    }

    /// Whether it shows results of other settings or starts than the present ones.
    pub fn is_survey(self) -> bool {
        matches!(self, Self::Map | Self::UpAndDown | Self::Basins)
    }

    /// Whether its horizontal axis is time, so that it shows the cursors.
    pub fn is_over_time(self) -> bool {
        matches!(self, Self::Displacement | Self::Velocity | Self::BaseAcceleration | Self::Power)
    }

    /// What a click on its plot does, if anything.
    pub(super) fn action(self) -> Option<&'static str> {
        match self {
            Self::UpAndDown | Self::Map => Some("Take the scene here"),
            Self::PhasePortrait | Self::Section | Self::Basins => Some("Start here"),
            _ => self.is_over_time().then_some("Go to this time"),
        }
    }

    /// Whether its horizontal axis is the displacement.
    pub fn is_along_x(self) -> bool {
        matches!(self, Self::Mechanism | Self::Well | Self::PhasePortrait | Self::Section | Self::ForceCurve)
    }

    /// Its horizontal and vertical axis. `None` if their ends cannot be chosen by hand.
    pub(super) fn axes(self) -> Option<[Axis; 2]> {
        let across = match self {
            Self::Displacement | Self::Velocity | Self::BaseAcceleration | Self::Power => Axis::Time,
            Self::Well | Self::ForceCurve => Axis::Place,
            Self::PhasePortrait | Self::Section | Self::Basins => Axis::Reach,
            Self::Map | Self::UpAndDown | Self::Spectrum | Self::Accuracy => Axis::Across(self),
            _ => return None,
        };
        Some([across, Axis::Up(self)])
    }
}
