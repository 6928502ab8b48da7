//! Properties of any scene, whatever it does.
//!
//! Scenes of every kind are drawn at random (`scenes`, `mechanisms`; at the far ends of what may be written,
//! `extremes`), and of each is asked:
//!
//! - it is never beyond a rigid stop, its events are ones that a mass can follow, what is counted is what is
//!   listed, and its ledger closes to the tolerance (`sound`, `runs`);
//! - its mirror image runs as its mirror image does, bit for bit (`mirror`, `runs`);
//! - all of this holds between stops at 0, on one side of it, and alone (`anywhere`);
//! - a stop that is never reached, samples, events, a ledger and threads change no bit (`runs`, `sweep`);
//! - the determinant of its stroboscopic map is that of damping and impacts (`determinant`);
//! - it has settled where its states come back or it rests, and stays where it has settled; impacts are
//!   counted alike by every command and at every tolerance (`settled`, `attracts`, `counts`);
//! - its error is at most a constant times its conditioning times its tolerance, plus rounding (`bound`);
//! - nothing panics or goes on without end, and no number is silently not finite (`extremes`);
//! - a margin of a best design is that of every place near it, and its interval under noise holds the best
//!   place of many seeds (`best`);
//! - a threshold is what closed forms say, and what it names is what runs of their own do (`thresholds`).
//!
//! The scenes are the same on every day, so that a test that was green does not turn red without a change.
//! `INTERWELL_PROPERTY_SEED=7` draws others, `INTERWELL_PROPERTY_SEED=new` new ones each time, and
//! `INTERWELL_PROPERTY_CASES=20` twenty times as many. One that fails is made as simple as it stays failing
//! and printed as a scene file, with the files that it names and with the seed.

mod anywhere;
mod attracts;
mod best;
mod bound;
mod counts;
mod determinant;
mod extremes;
pub mod harness;
pub mod mechanisms;
pub mod mirror;
mod runs;
pub mod scenes;
mod settled;
pub mod sound;
mod sweep;
mod thresholds;
mod units;
