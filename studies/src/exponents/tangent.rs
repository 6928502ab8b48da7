//! Map over a forcing period with its derivatives.

use super::NoExponents;
use crate::dynamics::{Event, EventKind, Jacobian, MapState, Model, Outcome, Passage, Side, StroboscopicMap};
use crate::numeric::elementary;
use crate::study::orbit::Units;

/// Share of its products below which a determinant has lost digits in rounding, which is about 1e-15 of the
/// products: it is then computed as the product of those of shorter parts of the period. (The error of the
/// integration is relative to the determinant itself, about the tolerance.) Near the top of a barrier all
/// perturbations turn into the unstable direction and grow up to 1e6-fold in a period; strong damping and a
/// fast circuit contract many powers of ten.
const FEW_LEFT: f64 = 1e-4;

/// Number of parts of such a period.
const PARTS: u32 = 8;

/// How often a part is halved, to a 512th of a period. A step of the integration contracts volumes hardly
/// more than a part that is halved no further, so that the parts cost about as much as the steps do.
const HALVINGS: u32 = 6;

/// The share for the shortest parts, below which a determinant is lost: its logarithm has an error of 1e-6
/// there. With [`HALVINGS`], volumes may contract exp(10000)-fold in a period.
const LOST: f64 = 1e-9;

/// The stroboscopic map of a model, with perturbations in units of its scales.
pub(super) struct Tangent {
    pub map: StroboscopicMap<'static>,
    pub units: Units,
    /// Logarithm of the factor by which damping and a circuit contract volumes in a period.
    damped: f64,
    /// The same for an impact on the left and on the right stop; `None` if they are compliant.
    struck: Option<[f64; 2]>,
}

/// Result of one or more forcing periods.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passed {
    /// The state at their end.
    pub state: MapState,
    /// Its derivatives by the state at the start, in units of the scales.
    pub jacobian: Jacobian,
    /// Logarithm of their determinant; NaN if it is lost in rounding.
    pub measured: f64,
    /// The same from damping, circuit and impacts; `None` with compliant stops.
    pub exact: Option<f64>,
    /// Whether the mass has rested on a stop: perturbations have vanished except those of a circuit.
    pub rested: bool,
}

impl Passed {
    /// The exact logarithm of the determinant if it is known, otherwise the computed one.
    pub fn log_determinant(&self) -> f64 {
        self.exact.unwrap_or(self.measured)
    }
}

impl Tangent {
    /// The map over one period from a phase of the drive; without a drive, over the natural time.
    pub fn of(model: &Model, phase: f64) -> Result<Self, NoExponents> {
        let map = match model.stroboscopic_map(phase) {
            Some(map) => map,
            None if model.excitation().is_constant() => StroboscopicMap::over(model, model.natural_time()),
            None => return Err(NoExponents::NoPeriod),
        };
        let kept = |side: Side| 2.0 * elementary::ln(model.stop(side).map_or(1.0, |stop| stop.restitution));
        let struck = model.compliant().is_none().then(|| [Side::Left, Side::Right].map(kept));
        let damped = model.contraction(map.period());
        Ok(Self { units: Units::of(model, 1.0), map, damped, struck })
    }

    /// The next period of the motion from a state.
    pub fn pass(&self, state: MapState) -> Result<Passed, NoExponents> {
        let (passage, derivative) = self.map.pass_with_jacobian(state, 1);
        if passage.outcome != Outcome::Done {
            return Err(NoExponents::EndedEarly(passage.outcome));
        }
        let Units { length, speed, electrical, .. } = self.units;
        let jacobian = derivative.in_units([length / speed, 1.0, electrical / speed]);
        if !derivative.products().is_finite() {
            return Err(NoExponents::Grazing);
        }
        let rested = passage.rested;
        let impacts = |side: Side| {
            let hits = |event: &&Event| (event.kind, event.side) == (EventKind::Impact, side);
            passage.events.iter().filter(hits).count() as f64
        };
        let exact = self.struck.map(|[left, right]| match rested {
            true => f64::NEG_INFINITY,
            false => self.damped + times(impacts(Side::Left), left) + times(impacts(Side::Right), right),
        });
        let measured = match rested {
            true => f64::NEG_INFINITY,
            false => {
                self.logarithm(&passage, &derivative, 1.0, FEW_LEFT).unwrap_or_else(|| self.by_parts(state))
            }
        };
        Ok(Passed { state: (&passage).into(), jacobian, measured, exact, rested })
    }

    /// Logarithm of the determinant of a part of a period; `None` below the share `least` of its products.
    fn logarithm(&self, passage: &Passage, derivative: &Jacobian, share: f64, least: f64) -> Option<f64> {
        let determinant = derivative.determinant().abs();
        let exact = passage.determinant.unwrap_or_else(|| elementary::exp(self.damped * share));
        (exact.min(determinant) > least * derivative.products()).then(|| elementary::ln(determinant))
    }

    /// The same for a period, from its parts; NaN if one of them is lost in rounding.
    fn by_parts(&self, mut state: MapState) -> f64 {
        let end = |part: u32| f64::from(part) / f64::from(PARTS);
        let parts = (0..PARTS).map(|part| self.of_part(&mut state, (end(part), end(part + 1)), HALVINGS));
        parts.sum::<Option<f64>>().unwrap_or(f64::NAN)
    }

    /// The same for a part of a period, which is halved up to so many times; moves `state` to its end.
    fn of_part(&self, state: &mut MapState, (from, to): (f64, f64), halvings: u32) -> Option<f64> {
        let (passage, derivative) = self.map.pass_part_with_jacobian(*state, (from, to));
        let least = if halvings == 0 { LOST } else { FEW_LEFT };
        if let Some(logarithm) = self.logarithm(&passage, &derivative, to - from, least) {
            *state = (&passage).into();
            return Some(logarithm);
        }
        let (halvings, half) = (halvings.checked_sub(1)?, 0.5 * (from + to));
        let first = self.of_part(state, (from, half), halvings)?;
        Some(first + self.of_part(state, (half, to), halvings)?)
    }

    pub fn pass_many(&self, state: MapState, periods: u32) -> Result<Passed, NoExponents> {
        let jacobian = Jacobian::identity(self.map.model().has_electrical_state());
        let exact = self.struck.map(|_| 0.0);
        let mut all = Passed { state, jacobian, measured: 0.0, exact, rested: false };
        for _ in 0..periods {
            let next = self.pass(all.state)?;
            all = Passed {
                state: next.state,
                jacobian: next.jacobian.after(&all.jacobian),
                measured: all.measured + next.measured,
                exact: all.exact.zip(next.exact).map(|(before, more)| before + more),
                rested: all.rested || next.rested,
            };
        }
        Ok(all)
    }
}

/// A count times a logarithm; 0 for a count of 0 even if the logarithm is minus infinity.
fn times(count: f64, logarithm: f64) -> f64 {
    if count == 0.0 { 0.0 } else { count * logarithm }
}
