//! The studies as an API for programs.
//!
//! A [`Simulation`] is a checked scene with its model. Each question is a struct of options with a method
//! `run`, which takes a simulation and, unless it is short, a [`Progress`]. It returns tables in SI units, or
//! an [`Error`] that lists all faults.
//!
//! ```
//! # use interwell_studies as interwell;
//! use interwell::questions::{Onset, Progress, Simulation, Threshold};
//!
//! // From which amplitude on does the mass leave its stop, for three travel limits?
//! let simulation = Simulation::preset("nominal-cubic")?;
//! let question = Threshold { of: Onset::Release, ..Threshold::over("stops.travel_limit_mm", 2.0..=4.0, 3) };
//! let table = question.run(&simulation, &Progress::none())?;
//! let (limits_mm, release_g) = (table.numbers("travel_limit_mm"), table.numbers("value").unwrap());
//! assert_eq!(limits_mm, Some(&[2.0, 3.0, 4.0][..]));
//! assert!(release_g.windows(2).all(|pair| pair[0] < pair[1]));
//! # Ok::<(), interwell::questions::Error>(())
//! ```
//!
//! # The questions
//!
//! | question | what it answers | answer |
//! | --- | --- | --- |
//! | [`Simulation::run`] | how the mass moves from one start | `dynamics::Run` |
//! | [`Simulation::record`] | the same, with samples and events as tables | [`Recorded`] |
//! | [`Simulation::compared`] | how far a measured motion is from the run | [`Comparison`] |
//! | [`Curve`] | force, potential and stiffness over displacement | [`Table`] |
//! | [`Sweep`] | what the settled motion does in each cell of a grid; with `carry`, hysteresis | [`Table`] |
//! | [`Section`] | states once per period or at impacts; over a field a bifurcation diagram | [`Table`] |
//! | [`Simulation::thresholds`] | the amplitudes that release the mass and make it cross | [`Thresholds`] |
//! | [`Threshold`] | the smallest value of a field that releases the mass or makes it cross | [`Table`] |
//! | [`Escape`] | how often a motion under noise leaves its well, beside Kramers' rate | [`Table`] |
//! | [`Exponents`] | Lyapunov exponents: whether the motion is chaotic | [`Table`] |
//! | [`Orbit`] | the periodic orbit near the motion, with its multipliers | [`OrbitAnswer`] |
//! | [`Branch`] | how an orbit continues over a field, with folds, flips and grazings | [`BranchAnswer`] |
//! | [`Locus`] | the curve of a fold, flip or grazing over two fields | [`LocusAnswer`] |
//! | [`Spectrum`] | which frequencies the motion holds | [`SpectrumAnswer`] |
//! | [`Basins`] | which attractor each start goes to, and the share of each | [`BasinsAnswer`] |
//! | [`Accuracy`] | how far a run is off, and what its digits cost | [`AccuracyAnswer`] |
//! | [`Compare`] | how designs rate under one sine | [`CompareAnswer`] |
//! | [`Distance`] | how far the motions of other scenes are from this one, over time | [`DistanceAnswer`] |
//! | [`Best`] | which design is the best for an environment, and with which margins | [`BestAnswer`] |
//! | [`Identify`] | damping, restitution or force of a measured record | [`IdentifyAnswer`] |
//!
//! An answer of a type of its own has a method `table`, but for [`Recorded`], which has two tables, samples
//! and events. [`output`](crate::output) writes tables as files and pictures. `docs/output.md` of the
//! repository has the meaning of every column, `docs/studies.md` pictures and costs.
//!
//! # Units
//!
//! A column has its unit in its name: `x_m`, `v_m_per_s`, `release_g`; [`Column::unit`] gives it as text.
//! Columns are in SI units, except those of fields and starts, which have the unit of the scene file
//! (`travel_limit_mm`, `x_mm`), amplitudes in g, and phases in degrees. A missing number is NaN, a missing
//! count is `None`, a missing word is empty.
//!
//! # Options that questions share
//!
//! - `over`: fields by dotted path with their values, the slowest first. Fields of the mechanism may be among
//!   them; each different mechanism (up to 4096 of them) is then built once.
//! - `until_settled`: a run continues, window after window, until its motion repeats, at most up to this time
//!   in s. It costs most where a motion never repeats. It is at least the duration of the scene's run and at
//!   most 1e9 s, and needs a drive that repeats. Thresholds, exponents, comparisons and designs continue by
//!   default for at most 1000 periods of the drive, of a sum those of its fastest sine, beyond the run; the
//!   others do not.
//! - `carry`: the last field of a grid is walked, each run from the end of the one before. It needs a drive
//!   that repeats.
//! - [`Progress`]: reports, cancellation, threads. The answer has the same bits for any number of threads.
//!
//! # Errors
//!
//! | variant | when |
//! | --- | --- |
//! | [`Error::Scene`] | the scene, or a file that it names, is wrong, or does not suit the question |
//! | [`Error::Cells`] | the same for cells of a grid |
//! | [`Error::Argument`] | an option of the question is wrong; `name` says which |
//! | [`Error::Unfit`] | the scene is right, but the question does not apply to it |
//! | [`Error::Failed`] | scene and question are right, but the computation gave no answer |
//! | [`Error::Cancelled`] | the flag of [`Progress::stopped_by`] was set |
//!
//! A run of a grid that ends early is no error: the column `outcome` says why, and the others continue.

mod error;
mod grid;
mod parts;
mod progress;
mod simulation;

#[doc(hidden)]
pub use crate::accuracy::check_accuracy;
pub use crate::accuracy::{Accuracy, AccuracyAnswer};
pub use crate::basins::{Basins, BasinsAnswer};
pub use crate::best::{Best, BestAnswer};
pub use crate::compare::{Compare, CompareAnswer};
pub use crate::curve::{Curve, FlexuresAnswer};
pub use crate::distance::{Distance, DistanceAnswer};
pub use crate::escape::{Escape, Until};
pub use crate::exponents::{Exponents, Lyapunov};
#[doc(hidden)]
pub use crate::identify::columns_read;
pub use crate::identify::{Identify, IdentifyAnswer, WhatToIdentify};
#[doc(hidden)]
pub use crate::lesson::{JudgedStep, check_lessons};
pub use crate::orbit::Orbits;
pub(crate) use crate::orbit::phase;
pub use crate::orbit::{Branch, BranchesAnswer, Locus, LocusAnswer, Orbit};
pub use crate::section::{Section, SectionKind};
pub use crate::spectrum::{Signal, Spectrum, SpectrumAnswer};
pub use crate::sweep::Sweep;
#[doc(hidden)]
pub use crate::sweep::{SweepCells, assign as assign_uncertain};
pub use crate::threshold::{Found, Onset, Threshold};
#[doc(hidden)]
pub use error::longest_wait;
pub use error::{Error, FaultAt};
pub(crate) use grid::{all_rows, check_until, drive_alone, settles};
#[doc(hidden)]
pub use parts::{stops_that_cross, thresholds, walks};
pub use progress::Progress;
pub use simulation::Simulation;

pub use crate::mechanics::flexure::State as FlexureState;
pub use crate::scene::Uncertain;

pub use crate::accuracy::methods::{Scheme, Statistics};
pub use crate::accuracy::scene::{AtTolerance, Course, Lateness, StepSize, Tolerances, Trust};
pub use crate::study::{
    Answer, Attractor, Begin, BestDesign, BestQuestion, BranchAnswer, BranchEnd, BranchEvent, Carry, Column,
    Comparison, Estimate, EvenRange, ExponentOptions, FieldRange, ForceComparison, Grid, Identified,
    Identity, LocusEnd, LocusEvent, MeasuredMotion, OneLocus, Optimum, OrbitAnswer, Rated, Recorded, Said,
    Sampling, SectionAt, SectionOptions, Shares, Spread, Table, Thresholds, Tried, Values,
};
