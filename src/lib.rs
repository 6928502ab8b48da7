//! Bistable mechanisms with hard travel limits: what they do when they are shaken.
//!
//! # The question
//!
//! A proof mass on a buckled flexure mechanism has two stable positions and a barrier between them. Shaken
//! gently it rattles in one well (*intrawell*), shaken hard it crosses (*interwell*). Rigid stops set inside
//! the stable positions press the mass up towards the barrier, so that it crosses at lower acceleration and
//! travels less. Where should the stops be?
//!
//! # The equation of motion
//!
//! ```text
//! m x'' + c x' + F(x) = -m a_b(t)     between the stops
//! v+ = -e v-                          at a stop, at once
//! x = +-D, v = 0                      while the net force presses on the stop
//! ```
//!
//! x is the displacement of the proof mass relative to its base, a_b the base's acceleration. F is the
//! derivative of a potential with two wells; every mechanism, however described, becomes one piecewise
//! polynomial ([`mechanics::ForceCurve`]).
//!
//! # From a scene to a result
//!
//! ```
//! use std::sync::Arc;
//! use interwell::dynamics::{Model, Regime, Request};
//! use interwell::mechanics::Mechanism;
//! use interwell::scene::{Document, Files};
//!
//! let text = r#"(
//!     title: "Two wells at 7 mm, stops at 4 mm",
//!     mass_g: 15.2,
//!     mechanism: Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 816326.530612245),
//!     damping: Ratio(0.023),
//!     stops: Rigid(travel_limit_mm: 4.0, restitution: 0.36),
//!     excitation: Sine(frequency_hz: 3.0, amplitude_g: 1.5),
//!     run: (duration_s: 10.0, tolerance: 1e-9),
//! )"#;
//!
//! // As written: parsed, then checked; all faults come at once, each with field, line, range and remedy.
//! let document = Document::from_text("example.ron", text, Files::default())?;
//! document.check()?;
//!
//! // As run: SI units, one force curve, nothing left to check.
//! let mechanism = Mechanism::build(&document.scene.mechanism, &document.files)?;
//! let model = Model::build(&document.scene, Arc::new(mechanism))
//!     .map_err(|faults| document.error_from(faults))?;
//!
//! // One run: pressed on the right-hand stop, released in every half period, across, and to rest again.
//! let run = model.run(&Request { events: true, ledger: true, ..Request::default() });
//! assert_eq!(run.summary.regime, Regime::Interwell);
//! assert_eq!(run.summary.period, Some(1));
//! assert!((run.summary.rms_velocity.unwrap() - 0.114_697_633_346).abs() < 1e-9);
//!
//! // Where the energy went: each term is integrated on its own, and they must add up.
//! let ledger = run.summary.ledger.unwrap();
//! assert!(ledger.impact_j > 0.9 * ledger.work_j);
//! assert!(ledger.energy_residual < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # The layers
//!
//! Each may use what stands above it, nothing below:
//!
//! | layer | holds |
//! | --- | --- |
//! | [`system`] | threads, clocks and files of the machine |
//! | [`numeric`] | mathematics that knows no mechanics |
//! | [`scene`] | what a person writes: fields, units, ranges, files, presets |
//! | [`mechanics`] | the restoring force and its landscape of wells and barrier |
//! | [`dynamics`] | motion: Taylor steps, contacts, rest, release, statistics, ledger |
//! | [`study`] | questions: one run, a sweep, thresholds, accuracy; a table comes out |
//! | [`output`] | a table in, bytes out |
//!
//! The command line is the binary's own, and the window is the feature `app`; neither computes anything.
//!
//! # Accuracy
//!
//! The tolerance of a scene is the one setting: the local error of a step, relative to the scene's own
//! length, speed and time ([`dynamics::Scales`]). Contacts are roots of the step's polynomial, found with
//! none missed and located to rounding. A run can be repeated in some 31 digits
//! ([`dynamics::Model::run_reference`]) to see what its error was.

#[cfg(feature = "app")]
#[doc(hidden)]
pub mod app;
pub mod dynamics;
pub mod mechanics;
pub mod numeric;
pub mod output;
pub mod scene;
pub mod study;
pub mod system;

/// The README's program compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
