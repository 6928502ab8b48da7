//! Arrival of a pursued motion: its known attractors and regions, and what ended the pursuit.

use super::event::{MapState, Side};
use super::summary::Summary;

/// An ellipse, beside a circuit an ellipsoid, around a stroboscopic state of a known motion. Motions inside
/// it are known to go to that motion.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capture {
    /// The state of the known motion.
    pub state: MapState,
    /// The coefficients of the ellipse a x^2 + 2 b x v + c v^2 + 2 w (d x + e v) + f w^2 < 1, with
    /// displacement x, velocity v and state of the circuit w relative to the state, all in SI.
    pub form: [f64; 6],
    /// Largest difference from the state at which a motion has arrived. A motion inside the ellipse but
    /// further away is followed until it is this near.
    pub near: MapState,
}

impl Capture {
    /// Whether a state lies inside the ellipse.
    pub fn holds(&self, state: MapState) -> bool {
        let (x, v) = (state.x - self.state.x, state.v - self.state.v);
        let w = state.electrical - self.state.electrical;
        let [a, b, c, d, e, f] = self.form;
        a * x * x + 2.0 * b * x * v + c * v * v + (2.0 * (d * x + e * v) + f * w) * w < 1.0
    }

    /// Whether a motion in this state has arrived.
    pub fn is_reached(&self, state: MapState) -> bool {
        let near = |value: f64, other: f64, limit: f64| (value - other).abs() <= limit;
        near(state.x, self.state.x, self.near.x)
            && near(state.v, self.state.v, self.near.v)
            && near(state.electrical, self.state.electrical, self.near.electrical)
            && self.holds(state)
    }
}

/// A set of cells of the plane of stroboscopic states that motions are known not to leave.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Displacement in m and velocity in m/s at the lower left corner of the cell (0, 0).
    pub corner: (f64, f64),
    /// Width and height of a cell.
    pub size: (f64, f64),
    /// The cells, ascending: index along the displacement and index along the velocity.
    pub cells: Vec<(i32, i32)>,
}

impl Region {
    /// The cell in which a state lies.
    pub fn cell(&self, (x, v): (f64, f64)) -> (i32, i32) {
        let place = |value: f64, corner: f64, size: f64| ((value - corner) / size).floor() as i32;
        (place(x, self.corner.0, self.size.0), place(v, self.corner.1, self.size.1))
    }

    /// Whether a state lies in one of the cells.
    pub fn holds(&self, state: (f64, f64)) -> bool {
        self.cells.binary_search(&self.cell(state)).is_ok()
    }
}

/// Identity of a release from rest on a rigid stop, known from the drive alone. Motions of one scene that
/// were released with equal identities are equal from then on, to the last bit.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReleaseIdentity {
    /// The stop that the mass left.
    pub side: Side,
    /// Cycle of the drive's fastest tone within the common period.
    pub cycle: i64,
    /// Phase of the drive, in units of the integrator.
    pub phase: f64,
}

/// Displacement, velocity and state of a circuit once a forcing period, in SI, rounded to seven digits:
/// enough to tell whether another motion is near.
#[doc(hidden)]
pub type Trail = Vec<[f32; 3]>;

/// A motion beside which another one is followed until they part.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside<'a> {
    /// Its states from the start to its arrival.
    pub trail: &'a [[f32; 3]],
    /// Difference of two states of the same number from which on the motions have parted.
    pub within: MapState,
}

impl Beside<'_> {
    /// Whether a motion in the state `place` has parted from it.
    pub fn is_left(&self, place: usize, state: MapState) -> bool {
        let far = |value: f64, other: f32, limit: f64| !((value - f64::from(other)).abs() <= limit);
        self.trail.get(place).is_some_and(|[x, v, electrical]| {
            far(state.x, *x, self.within.x)
                || far(state.v, *v, self.within.v)
                || far(state.electrical, *electrical, self.within.electrical)
        })
    }
}

/// Start and termination criteria of a pursuit.
#[doc(hidden)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pursuit<'a> {
    /// The state at time 0.
    pub start: MapState,
    /// Known motions to which it may go.
    pub known: &'a [Capture],
    /// Known regions that it may enter.
    pub regions: &'a [Region],
    /// The number of the stroboscopic state from which a repetition ends it.
    pub repeats_from: u64,
    /// Forcing periods after which it is given up.
    pub max_periods: u64,
    /// Number of releases with an identity before the one that ends it.
    pub releases: u32,
    /// Work after which it is given up, in units of some ten nanoseconds; at most the work budget of a run.
    pub max_work: u64,
    /// The motion that it is to stay beside. It has then arrived as soon as it is inside an ellipse.
    pub beside: Option<Beside<'a>>,
}

impl Pursuit<'_> {
    /// Value of [`repeats_from`](Self::repeats_from) with which no repetition ends a pursuit.
    pub const NEVER: u64 = u64::MAX;
}

/// Result of a pursuit.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub struct Pursued {
    /// What ended it.
    pub arrival: Arrival,
    /// The number of the first stroboscopic state after the arrival, where the start has the number 0; `None`
    /// if the motion is unsettled.
    pub periods: Option<u64>,
    /// Its states, unless it was followed beside another motion.
    pub trail: Trail,
    /// Work done, in units of some ten nanoseconds.
    pub work: u64,
}

/// What ended a pursuit.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq)]
pub enum Arrival {
    /// A known motion, by its index among the known ones.
    Captured(usize),
    /// A known region, by its index among the known ones.
    Entered(usize),
    /// A release with this identity.
    Released(ReleaseIdentity),
    /// A rest that never ends, on this stop.
    Rests(Side),
    /// The stroboscopic states repeat, to a thousandth of the scales, for two periods of the motion and
    /// twelve more states.
    Repeats {
        /// Period of the motion in forcing periods, at most 12.
        period: u32,
        /// The last of the states.
        state: MapState,
    },
    /// The motion beside which it was followed is somewhere else.
    Parted,
    /// None of these. The settled window of the summary is the last hundred periods, or all if there
    /// were fewer.
    Unsettled(Box<Summary>),
}
