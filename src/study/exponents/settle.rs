//! Exponents of the motion that a scene settles on.

use std::sync::atomic::AtomicBool;

use super::average::average;
use super::orbit::of_orbit;
use super::result::{ExponentOptions, Exponents, NoExponents};
use super::tangent::Tangent;
use crate::dynamics::{Model, Outcome, Request};
use crate::study::settled::{PATIENCE, followed_until};

/// Forcing periods of a window in which a motion that repeats after up to 12 of them is recognised.
const WINDOW: f64 = 36.0;

/// The exponents of the settled motion of `model`.
///
/// Its run goes to the end of its settled window, and on, window after window, until it repeats or the time
/// of the options is over. If it repeats, the exponents are those of the periodic motion; else they are
/// averages over the periods that follow. Without a drive the mass is followed for 1000 periods of its
/// small oscillations.
pub fn exponents(
    model: &Model,
    options: &ExponentOptions,
    cancel: &AtomicBool,
) -> Result<Exponents, NoExponents> {
    let (run, until_settled) = match model.forcing_period().filter(|_| model.repeats()) {
        Some(period) => {
            let window = (model.duration() - model.settle()).max(WINDOW * period);
            let until = options.until_settled.unwrap_or(followed_until(model));
            (model.with_duration(model.settle() + window, model.settle()), Some(until))
        }
        None if model.excitation().is_constant() => {
            let end = model.duration() + f64::from(PATIENCE) * model.natural_time();
            (model.with_duration(end, end), None)
        }
        None => return Err(NoExponents::NoPeriod),
    };
    let summary = run.run(&Request { cancel: Some(cancel), until_settled, ..Request::default() }).summary;
    match summary.outcome {
        Outcome::Done => {}
        Outcome::Cancelled { .. } => return Err(NoExponents::Cancelled),
        other => return Err(NoExponents::EndedEarly(other)),
    }
    let state = (summary.final_x, summary.final_v);
    let phase = model.drive_phase(summary.window.1).unwrap_or(0.0);
    let tangent = Tangent::of(model, phase)?;
    // a motion that has not settled may pass near a periodic one that it does not go to
    let found = match model.repeats() && summary.settled != Some(true) {
        true => None,
        false => of_orbit(&tangent, state, summary.period.unwrap_or(1))?,
    };
    found.map_or_else(|| average(&tangent, state, options.periods, cancel), Ok)
}
