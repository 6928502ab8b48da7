//! Studies: computations about a scene whose results are tables.
//!
//! A study takes models and plain numbers, reports progress and can be cancelled through a [`Task`], and
//! returns a [`Table`]. It reads no arguments and writes no files, so that the window and the command line
//! call the same studies and show the same tables.

/// An enum whose variants each have a word for arguments and tables, or a clause for sentences.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($(#[$of:meta])* $variant:ident = $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $($(#[$of])* $variant,)+
        }

        impl $name {
            /// All variants.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// The word of the variant.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }

            /// The variant with this word.
            pub fn named(word: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|one| one.name() == word)
            }
        }
    };
}

pub(crate) use words;

pub mod accuracy;
mod alternatives;
mod amplitudes;
mod basins;
mod best;
mod bisection;
mod contact;
mod curve;
mod escape;
mod exponents;
mod fields;
mod grid;
mod grid_study;
mod identify;
mod inspect;
mod lesson;
mod map;
mod measured;
mod melnikov;
mod models;
mod orbit;
mod section;
mod settled;
mod simulate;
mod slice;
mod spectrum;
mod sweep;
mod table;
mod thresholds;
mod trace;
mod uncertain;
mod walk;
mod watch;

use std::sync::atomic::{AtomicBool, Ordering};

pub use alternatives::{Alternative, Rated, SEARCHED_SPAN, alternatives, comparison_parts, comparison_table};
pub use amplitudes::{Thresholds, can_cross, stops_that_cross, thresholds};
pub use basins::{Answer, Attractor, Basins, EvenRange, MAX_STARTS, NoBasins, Shares, Starts, StartsError};
pub use best::{
    BestDesign, BestQuestion, Constraint, DesignRange, Environment, INTERVALS, MOST_FIELDS, NoBest, Optimum,
    SAMPLES, Spread, Tried, Variation, best, names, place, quantity, scan_places, scan_runs,
};
pub use contact::{Strikes, contact, strikes, yield_speed, yield_warning};
pub use curve::{
    CURVE_PICTURE_POINTS, CURVE_POINTS, OutsideCurve, StatesError, curve, default_positions, even_positions,
    full_curve, metres, shapes, small_amplitude_frequency, states, stop_positions, stress_warning,
};
pub use escape::{
    Chance, EscapeOptions, NoKramers, Until, depopulation, escape_table, kramers_rate,
    probable_threshold_table,
};
pub use exponents::{
    Estimate, ExponentCells, ExponentOptions, Exponents, NoExponents, average_exponents, drive_fault,
    exponents,
};
pub use fields::{InJson, RMS_VELOCITY, Read, SUMMARY_FIELDS, SummaryField};
pub use grid::{Grid, GridError, Levels, MAX_CELLS, STRIDES};
pub use grid_study::{GridStudy, Question, Row};
pub use identify::{
    FORCE_POINTS, Identified, Identity, Unidentified, damping, force, restitution, restitution_of_times,
};
pub use inspect::inspect;
pub use lesson::{
    Lack, LessonFinding, LessonReport, Subject, Unjudged, Value, check_lesson, goal_lack, options_that_hold,
    result_fields,
};
pub use map::{Edges, first_crossing, first_crossing_edge, line_meets, release_line};
pub use measured::{
    Comparison, ForceComparison, MeasuredMotion, NoComparison, OffTheCurve, compare, compare_force,
};
pub use melnikov::{melnikov_threshold, suits_melnikov, with_melnikov};
pub use models::Held;
pub use orbit::{
    Branch, BranchEnd, BranchEvent, BranchOptions, FieldRange, Locus, LocusEnd, LocusEvent, NoOrbit, Orbit,
    branch, branches_table, loci, loci_table, orbit, orbit_near, orbit_table, switched,
};
pub use section::{IMPACTS, MAX_SECTION, SectionAt, SectionOptions, Sections, section};
pub use settled::{Standing, followed_until, lasts, settled, standing};
pub use simulate::{
    Keep, Recorded, Sampling, TimesError, ended_remedy, events_table, sample_times, samples_table, simulate,
};
pub use slice::{Shard, Slice};
pub use spectrum::{NoSpectrum, Signal, Spectrum, SpectrumOptions, spectrum};
pub use sweep::{
    Cell, CellFaults, DIRECTION, STANDARD as STANDARD_COLUMNS, Sweep, SweepEnd, SweepOptions, Tally,
};
pub use table::{Column, Table, Values, label_and_unit, with_unit};
pub use thresholds::{Found, NoThresholds, Onset, Scan, Verdict, threshold, threshold_table};
pub use trace::{Trace, between, simulate_with_trace};
pub use uncertain::{Draws, MAX_DRAWS, share_in_range};
pub use walk::{Carry, Direction, Family, NoModel, Visit, up_and_down};
pub use watch::{Watch, continued_scene, distances, watched_events};

/// Progress and cancellation of a long study.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// Called after each finished part, from any thread.
    pub tick: &'a (dyn Fn() + Sync),
    /// Set by another thread to cancel the study.
    pub cancel: &'a AtomicBool,
}

impl Task<'_> {
    /// Whether the study was cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// An error if the study was cancelled.
    fn check_cancelled(&self) -> Result<()> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// The result of `work`, or an error if the study was cancelled meanwhile: what is cut short then takes a
    /// motion for one that ends early.
    fn unless_cancelled<T, E: From<Cancelled>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        let found = work();
        self.check_cancelled()?;
        found
    }
}

/// The result of a part of a study that can be cancelled.
type Result<T, E = Cancelled> = std::result::Result<T, E>;

/// Displacement in m and velocity in m/s.
type State = (f64, f64);

/// The error of a study that was cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cancelled;
