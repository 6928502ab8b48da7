//! Motion: the equation of motion and its exact, event-driven integration.
//!
//! The parts, lowest first; each uses only those above it in this list, and no two files use each other:
//!
//! - `clock`: time as whole cycles and a phase.
//! - `result`: the request for a run and its results, in SI.
//! - `model`: a scene prepared for a run, in SI: its data, checks, scales and description.
//! - `equation`: the model in kernel units, cut into modes of one polynomial each, and the laws of the stops.
//! - `series`: Taylor series of displacement and force, and functions of their polynomials.
//! - `drive`: the excitation in kernel units, its series, and the search for release roots.
//! - `state`: all data that the next step depends on.
//! - `step`: the stepper, which makes a step from a state: its length, its first event, its evaluation.
//! - `record`: the recorder, which takes statistics, events and samples from steps, and the log of its calls.
//! - `motion`: state, stepper, recorder and log together.
//! - `contact`: events of a motion: impact, rest, release, compliant contact, breaks.
//! - `run`: the loop from event to event, the fast path of event-free steps, recurrence, and the verdict.
//! - `map`: the stroboscopic map with its derivatives, through every event.
//! - `lanes`: batches, which take event-free steps of several runs by the same instructions.
//! - `live`: a run without a fixed end, whose model may be changed while it runs.
//!
//! [`Model::run`] is defined in `run`, [`Model::run_all`] in `lanes`.

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
pub use model::Model;
pub use model::excitation::{ChirpPart, ExcitationParts, NoisePart, STANDARD_GRAVITY, TonePart};
pub use model::scales::Scales;
pub use model::stops::{StopAt, StopPair};
pub use model::transducer::Output;
pub use result::*;
