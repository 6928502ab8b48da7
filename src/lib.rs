//! Simulation of bistable mechanisms with hard travel limits under base excitation.
//!
//! # The question
//!
//! A proof mass on a buckled flexure mechanism has two stable positions and a barrier between them. Under
//! weak excitation it stays in one well (*intrawell*), under strong excitation it crosses the barrier
//! (*interwell*). Rigid stops inside the stable positions hold the mass closer to the barrier, so that it
//! crosses at lower acceleration and travels less. Where should the stops be?
//!
//! # The equation of motion
//!
//! ```text
//! m x'' + c x' + F(x) = -m a_b(t)     between the stops
//! v+ = -e v-                          at an impact on a stop
//! x = +-D, v = 0                      while the net force presses on the stop
//! ```
//!
//! x is the displacement of the proof mass relative to its base, a_b the base's acceleration. F is the
//! derivative of a potential with two wells; the force of every mechanism is represented by one piecewise
//! polynomial ([`mechanics::ForceCurve`]).
//!
//! # From a scene to a result
//!
//! ```
//! use interwell::dynamics::{Regime, Request};
//! use interwell::{Progress, Simulation, Sweep};
//!
//! // A scene that has been checked, with its model; an error lists all faults with field, value and remedy.
//! let simulation = Simulation::from_text("example.ron", r#"(
//!     title: "Two wells at 7 mm, stops at 4 mm",
//!     mass_g: 15.2,
//!     mechanism: Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 816326.530612245),
//!     damping: Ratio(0.023),
//!     stops: Rigid(travel_limit_mm: 4.0, restitution: 0.36),
//!     excitation: Sine(frequency_hz: 3.0, amplitude_g: 1.5),
//!     run: (duration_s: 10.0, tolerance: 1e-9),
//! )"#)?;
//!
//! // One run: in every half period the mass leaves one stop, crosses, and comes to rest on the other stop.
//! let run = simulation.run(&Request { events: true, ledger: true, ..Request::default() });
//! assert_eq!(run.summary.regime, Regime::Interwell);
//! assert_eq!(run.summary.period, Some(1));
//! assert!((run.summary.rms_velocity.unwrap() - 0.114_697_633_346).abs() < 1e-9);
//!
//! // The energy balance: each term is integrated separately, and they must add up.
//! let ledger = run.summary.ledger.unwrap();
//! assert!(ledger.impact_j > 0.9 * ledger.work_j);
//! assert!(ledger.energy_residual < 1e-9);
//!
//! // A question about the scene: a struct with a method `run`, which answers with a table.
//! let sweep = Sweep::over("excitation.amplitude_g", 0.5..=1.5, 5);
//! let table = sweep.run(&simulation, &Progress::none())?;
//! assert_eq!(table.words("regime"), ["rest", "intrawell", "interwell", "interwell", "interwell"]);
//! # Ok::<(), interwell::Error>(())
//! ```
//!
//! # The questions
//!
//! The page of [`questions`] lists them all, with the options that they share and their errors. The page of
//! each has the columns of its table with their units, its method with the source, what its options trade,
//! and an example.
//!
//! # The layers
//!
//! Each layer may use the layers above it in this table, and none below:
//!
//! | layer | holds |
//! | --- | --- |
//! | [`system`] | threads, clocks and files of the machine |
//! | [`numeric`] | mathematics without mechanics |
//! | [`scene`] | scene files: fields, units, ranges, tables, presets |
//! | [`mechanics`] | the restoring force and its landscape of wells and barrier |
//! | [`dynamics`] | motion: Taylor steps, contacts, rest, release, statistics, ledger |
//! | [`questions`] | the studies as a program asks them |
//! | [`output`] | conversion of tables to files |
//!
//! The command line is a part of the binary, and the window is the feature `app`; neither computes anything.
//!
//! # Accuracy
//!
//! The tolerance of a scene is the only setting: the local error of a step, relative to the scene's scales of
//! length, speed and time ([`dynamics::Scales`]). Contacts are roots of the step's polynomial; none is
//! missed, and each is located to rounding. A run can be repeated with about 31 digits
//! ([`dynamics::Model::run_reference`]) to measure its error.

#[cfg(feature = "app")]
#[doc(hidden)]
pub mod app;

#[doc(inline)]
pub use interwell_kernel::{dynamics, mechanics, numeric, scene, system};
#[doc(inline)]
pub use interwell_studies::{output, questions};
#[doc(no_inline)]
pub use questions::{
    Basins, Best, Branch, Compare, Curve, Error, Escape, Exponents, Identify, Orbit, Progress, Section,
    Simulation, Spectrum, Sweep, Threshold,
};

/// Compiles the program in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
