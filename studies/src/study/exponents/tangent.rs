//! Map of a forcing period, with the growth of small changes of the motion.

use super::NoExponents;
use crate::dynamics::{Event, EventKind, Jacobian, Model, Outcome, Passage, Scales, Side, StroboscopicMap};
use crate::study::State;

/// Below this share of its two products a determinant has lost its digits: rounding is some 1e-15 of them.
/// (The error of the integration is a share of the areas themselves, of the size of the tolerance.)
const LOST: f64 = 1e-12;

/// Below this share the determinant of a period is the product of those of its parts. A mass that lingers
/// near the top of a barrier turns all changes into the one that grows there, up to 1e6-fold in a period.
const FEW_LEFT: f64 = 1e-4;
const PARTS: u32 = 8;

/// The stroboscopic map of a model, with changes of a state in units of its scales.
pub(super) struct Tangent {
    map: StroboscopicMap,
    scales: Scales,
    /// Logarithm of the share of an area that damping leaves in a period.
    damped: f64,
    /// The same of an impact on the left and the right stop; `None` if they are compliant.
    struck: Option<[f64; 2]>,
}

/// Result of one or more forcing periods.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passed {
    /// The state at their end, in m and m/s.
    pub state: State,
    /// Derivatives of it by that at the start, in units of the scales.
    pub jacobian: Jacobian,
    /// Logarithm of their determinant; NaN where its digits are lost.
    pub measured: f64,
    /// The same by damping and impacts; `None` with compliant stops.
    pub exact: Option<f64>,
}

impl Passed {
    /// Whether nothing is left of a change.
    pub fn rested(&self) -> bool {
        self.jacobian.rows == [[0.0; 2]; 2]
    }

    /// The exact logarithm if it is known, else the measured one.
    pub fn log_determinant(&self) -> f64 {
        self.exact.unwrap_or(self.measured)
    }
}

impl Tangent {
    /// The map from a phase of the drive on, in forcing periods; without a drive over the natural time.
    pub fn of(model: &Model, phase: f64) -> Result<Self, NoExponents> {
        if model.has_electrical_state() {
            return Err(NoExponents::ElectricalState);
        }
        let map = match model.stroboscopic_map(phase) {
            Some(map) => map,
            None if model.excitation().is_constant() => StroboscopicMap::over(model, model.natural_time()),
            None => return Err(NoExponents::NoPeriod),
        };
        let stops = model.stops();
        let kept = |side: Side| {
            let pair = stops.and_then(|pair| if side == Side::Left { pair.left } else { pair.right });
            2.0 * pair.map_or(1.0, |stop| stop.restitution).ln()
        };
        let struck = model.compliant().is_none().then(|| [Side::Left, Side::Right].map(kept));
        let damped = -model.total_damping() * map.period() / model.mass();
        Ok(Self { scales: model.scales(), map, damped, struck })
    }

    pub fn model(&self) -> &Model {
        self.map.model()
    }

    /// Time in s that a period takes.
    pub fn period(&self) -> f64 {
        self.map.period()
    }

    /// The next period of the motion from a state in m and m/s.
    pub fn pass(&self, state: State) -> Result<Passed, NoExponents> {
        let (passage, derivative) = self.map.pass_with_jacobian(state, 1);
        if passage.outcome != Outcome::Done {
            return Err(NoExponents::EndedEarly(passage.outcome));
        }
        let time = self.scales.length / self.scales.speed;
        let [[a, b], [c, d]] = derivative.rows;
        let jacobian = Jacobian { rows: [[a, b / time], [c * time, d]] };
        if !products(&derivative).is_finite() {
            return Err(NoExponents::Grazing);
        }
        let rested = derivative.rows == [[0.0; 2]; 2];
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
        Ok(Passed { state: passage.state, jacobian, measured, exact })
    }

    /// Logarithm of the determinant of a share of a period; `None` if less than `least` of its products.
    fn logarithm(&self, passage: &Passage, derivative: &Jacobian, share: f64, least: f64) -> Option<f64> {
        let determinant = derivative.determinant().abs();
        let exact = passage.determinant.unwrap_or_else(|| (self.damped * share).exp());
        (exact.min(determinant) > least * products(derivative)).then(|| determinant.ln())
    }

    /// The same of a period from its parts, NaN where one has lost its digits.
    fn by_parts(&self, mut state: State) -> f64 {
        let share = 1.0 / f64::from(PARTS);
        let parts = (0..PARTS).map(|part| {
            let span = (f64::from(part) * share, f64::from(part + 1) * share);
            let (passage, derivative) = self.map.pass_part_with_jacobian(state, span);
            state = passage.state;
            self.logarithm(&passage, &derivative, share, LOST).unwrap_or(f64::NAN)
        });
        parts.sum()
    }

    pub fn pass_many(&self, state: State, periods: u32) -> Result<Passed, NoExponents> {
        let mut all =
            Passed { state, jacobian: Jacobian::IDENTITY, measured: 0.0, exact: self.struck.map(|_| 0.0) };
        for _ in 0..periods {
            let next = self.pass(all.state)?;
            all = Passed {
                state: next.state,
                jacobian: next.jacobian.after(&all.jacobian),
                measured: all.measured + next.measured,
                exact: all.exact.zip(next.exact).map(|(before, more)| before + more),
            };
        }
        Ok(all)
    }

    /// A change of the state in units of the scales, from `from` to `to`.
    pub fn scaled(&self, from: State, to: State) -> [f64; 2] {
        [(to.0 - from.0) / self.scales.length, (to.1 - from.1) / self.scales.speed]
    }

    /// A state changed so much, in units of the scales.
    pub fn changed(&self, (x, v): State, by: [f64; 2]) -> State {
        (x + by[0] * self.scales.length, v + by[1] * self.scales.speed)
    }
}

/// The two products of which a determinant is the difference, without their signs.
fn products(derivative: &Jacobian) -> f64 {
    let [[a, b], [c, d]] = derivative.rows;
    (a * d).abs() + (b * c).abs()
}

/// A count times a logarithm, 0 where there is nothing to count however small the logarithm.
fn times(count: f64, logarithm: f64) -> f64 {
    if count == 0.0 { 0.0 } else { count * logarithm }
}
