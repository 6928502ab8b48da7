//! Studies: computations about a scene whose results are tables.
//!
//! A study takes models and plain numbers, reports progress and can be cancelled through a [`Task`], and
//! returns a [`Table`]. It reads no arguments and writes no files, so that the window and the command line
//! call the same studies and show the same tables.

/// An enum whose variants each have a word for arguments and tables, or a clause for sentences.
macro_rules! words {
    ($(#[$about:meta])* $name:ident { $($(#[doc = $of:literal])* $variant:ident = $word:literal,)+ }) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $($(#[doc = $of])* #[serde(rename = $word)] $variant,)+
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

        impl clap::ValueEnum for $name {
            fn value_variants<'a>() -> &'a [Self] {
                &Self::ALL
            }

            fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
                let words = match self {
                    $(Self::$variant => concat!($($of),*),)+
                };
                Some(clap::builder::PossibleValue::new(self.name()).help(words.trim()))
            }
        }
    };
}

pub(crate) use words;

pub(crate) mod amplitudes;
pub(crate) mod bisection;
mod contact;
mod declared;
mod fields;
pub(crate) mod grid;
pub(crate) mod grid_study;
mod inspect;
mod measured;
mod models;
mod said;
pub(crate) mod settled;
mod slice;
mod table;
mod tally;
pub(crate) mod walk;
pub(crate) mod watch;

/// Accuracy of runs.
pub mod accuracy {
    pub use crate::accuracy::*;
}

use std::sync::atomic::{AtomicBool, Ordering};

use crate::dynamics::{Outcome, Run};

pub use crate::basins::{Answer, Attractor, BasinMap, EvenRange, NoBasins, Shares, Starts};
pub use crate::best::{
    BestDesign, BestQuestion, Constraint, DesignRange, DesignRun, Environment, Memory, NoBest, Optimum,
    Results, Seeds, Spread, Tolerance, Tried, best, names, place, quantity,
};
pub use crate::compare::{Alternative, Rated, alternatives};
pub(crate) use crate::curve::small_amplitude_frequency;
pub use crate::curve::{
    CURVE_PICTURE_POINTS, CURVE_POINTS, OutsideCurve, StatesError, curve, default_positions, even_positions,
    metres, states, stop_positions,
};
pub use crate::escape::{NoKramers, depopulation, kramers_rate};
pub use crate::exponents::{Estimate, ExponentOptions, Lyapunov, NoExponents, average_exponents, exponents};
pub use crate::identify::{
    FORCE_POINTS, Identified, Identity, Unidentified, damping, force, restitution, restitution_of_times,
};
pub use crate::lesson::{
    Lack, LessonFinding, LessonReport, Subject, Value, check_lesson, goal_lack, result_fields,
};
pub(crate) use crate::orbit;
pub use crate::orbit::{
    Begin, BranchAnswer, BranchEnd, BranchEvent, BranchOptions, FieldRange, LocusEnd, LocusEvent, NoOrbit,
    OneLocus, OrbitAnswer, begun, branch, branches_table, loci, loci_table, orbit, orbit_near, switched,
};
pub use crate::section::{IMPACTS, MAX_SECTION, SectionAt, SectionOptions, Sections, section};
pub use crate::simulate::{
    Keep, Recorded, Sampling, Trace, between, ended_remedy, events_table, sample_times, samples_table,
    simulate, simulate_with_trace,
};
pub use crate::spectrum::{Signal, SpectrumAnswer, SpectrumOptions, spectrum};
pub(crate) use crate::sweep::Draws;
pub use crate::sweep::cells::Sweep;
pub use crate::sweep::{Edges, MAX_DRAWS, STANDARD_COLUMNS, SweepOptions, first_crossing, release_line};
pub(crate) use crate::threshold::NoThresholds;
pub use crate::threshold::{Found, Onset, Scan, Verdict, melnikov_threshold, threshold};
pub(crate) use amplitudes::stops_that_cross;
pub use amplitudes::{Thresholds, can_cross, thresholds};
pub use contact::yield_warning;
pub(crate) use contact::{contact, yield_speed};
pub use declared::{
    Answered, Framing, Heading, Over, PICTURE, Remark, Rows, Scenes, Streamed, Study, answer, answer_in,
    counted, number, whole,
};
pub(crate) use declared::{ColumnOf, column, even, headings, over_fields, study_methods};
pub(crate) use fields::InJson;
pub use fields::{RMS_VELOCITY, Read, SUMMARY_FIELDS, SummaryField};
pub use grid::{Grid, GridError, Levels, MAX_CELLS, STRIDES};
pub(crate) use grid_study::{Built, Row};
pub use grid_study::{Cells, GridStudy, Question};
pub use inspect::inspect;
pub use measured::{Comparison, ForceComparison, MeasuredMotion, NoComparison, compare, compare_force};
pub(crate) use models::ModelUse;
pub(crate) use said::named;
pub use said::{Said, Spelling};
pub(crate) use settled::followed_until;
pub use settled::{Standing, lasts, settled, standing};
pub use slice::{Shard, Slice};
pub use table::{Column, Table, Values, label_and_unit, with_unit};
pub(crate) use tally::CellFaults;
pub use tally::{Cell, DIRECTION, SweepEnd, Tally};
pub use walk::{Carry, Direction, Family, Visit, up_and_down};
pub(crate) use walk::{NoModel, choice_fault, excitation_fault};
pub use watch::{Watch, continued_scene, watched_events};

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
    pub(crate) fn check_cancelled(&self) -> Result<()> {
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// The result of `work`, or an error if the study was cancelled meanwhile: a run that was cut short looks
    /// like one that ends early.
    pub(crate) fn unless_cancelled<T, E: From<Cancelled>>(
        &self,
        work: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let found = work();
        self.check_cancelled()?;
        found
    }
}

/// A run unless it was cancelled.
pub(crate) fn finished(run: Run) -> Option<Run> {
    (!matches!(run.summary.outcome, Outcome::Cancelled { .. })).then_some(run)
}

/// The result of a part of a study that can be cancelled.
pub(crate) type Result<T, E = Cancelled> = std::result::Result<T, E>;

/// Displacement in m and velocity in m/s.
pub(crate) type State = (f64, f64);

/// The error of a study that was cancelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cancelled;
