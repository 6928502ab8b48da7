//! Motion: the equation of motion and its exact, event-driven integration.
//!
//! A [`Model`] is a scene that has been checked, in SI units. [`Model::run`] integrates it from its start to
//! its end and gives a [`Run`]: samples, [`Event`]s, and a [`Summary`] with [`Regime`] and energy [`Ledger`].
//! Displacement in m and velocity in m/s are relative to the base, times are in s. [`Model::build`] lists all
//! faults of a scene; a run never fails, its [`Outcome`] says how it ended. [`Model::run_together`] runs a
//! batch with the same bits, [`Model::run_reference`] computes with about 31 digits, [`StroboscopicMap`]
//! gives the state one forcing period later with its derivatives, and [`Live`] continues a motion without a
//! fixed end.
//!
//! # Method
//!
//! Between events a Taylor series of order 9 to 23, by tolerance (Moore 1966; Jorba and Zou 2005),
//! whose polynomial gives samples and contacts too. A contact is a root of that polynomial; none is missed.
//! The rest of a chatter is summed in closed form once it is short (Nordmark and Piiroinen 2009). Compliant
//! stops follow Hertz and Hunt and Crossley (1975). The tolerance of the scene bounds the local error of a
//! step relative to [`Scales`]; a smaller one costs higher orders more than shorter steps, so from 1e-3 to
//! 1e-12 a run without stops costs two to three times as much.
//!
//! # Example
//!
//! ```
//! # use interwell_kernel as interwell;
//! use std::sync::Arc;
//!
//! use interwell::dynamics::{Model, Outcome, Request};
//! use interwell::mechanics::Mechanism;
//! use interwell::scene::Document;
//!
//! // A ball dropped from 1 m lands after sqrt(2 h/g) and keeps 80 % of its speed.
//! let document = Document::preset("bouncing-ball")?;
//! let mechanism = Mechanism::build(&document.scene.mechanism, &document.files)?;
//! let model = Model::build(&document.scene, Arc::new(mechanism)).expect("a scene without faults");
//! let run = model.run(&Request { events: true, ..Request::default() });
//! assert_eq!(run.summary.outcome, Outcome::Done);
//! let landing = &run.events[0];
//! assert!((landing.t - (2.0 / 9.81_f64).sqrt()).abs() < 1e-9);
//! assert!((landing.v_out + 0.8 * landing.v_in).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod advance;
mod clock;
mod contact;
mod drive;
mod equation;
mod lanes;
mod live;
mod map;
mod model;
mod motion;
mod record;
mod result;
mod run;
mod series;
mod state;
mod step;

pub use live::{Live, LiveLedger, LiveOutput};
pub use map::{Jacobian, Miss, Multiplier, Passage, StroboscopicMap};
pub use model::excitation::{ChirpPart, ExcitationParts, NoisePart, STANDARD_GRAVITY, TonePart};
pub use model::scales::Scales;
pub use model::stops::{StopAt, StopPair};
pub use model::transducer::{CircuitState, Output};
pub use model::{Beginning, Model};
pub use result::*;
