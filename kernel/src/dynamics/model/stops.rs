//! Stops of a scene in SI.

use crate::scene::Stops;

/// The stops of a scene; a side without one is open.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StopPair {
    /// The one that limits the mass to the left.
    pub left: Option<StopAt>,
    /// The one that limits the mass to the right; it stands right of the left one.
    pub right: Option<StopAt>,
}

/// One stop. SI. A compliant stop dissipates by its contact law and has restitution 1 here.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StopAt {
    /// Position in m.
    pub x: f64,
    /// Speed after an impact over the speed before it.
    pub restitution: f64,
}

impl StopPair {
    /// The stops of a scene; `None` if it has none.
    pub(crate) fn of(stops: &Stops) -> Option<Self> {
        // the sum with 0 makes a 0 of -0
        let at =
            |mm: f64, sign: f64, restitution: f64| Some(StopAt { x: sign * (mm / 1e3) + 0.0, restitution });
        match *stops {
            Stops::None => None,
            Stops::Hertz { travel_limit_mm, .. } => {
                let [left, right] = [-1.0, 1.0].map(|sign| at(travel_limit_mm, sign, 1.0));
                Some(Self { left, right })
            }
            Stops::Rigid { travel_limit_mm, restitution } => {
                let [left, right] = [-1.0, 1.0].map(|sign| at(travel_limit_mm, sign, restitution));
                Some(Self { left, right })
            }
            Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right } => {
                let of = |given: Option<f64>, other: Option<f64>| given.or(other).unwrap_or(1.0);
                Some(Self {
                    left: left_mm.and_then(|mm| at(mm, -1.0, of(restitution_left, restitution_right))),
                    right: right_mm.and_then(|mm| at(mm, 1.0, of(restitution_right, restitution_left))),
                })
            }
        }
    }

    /// Whether a displacement in m lies between the stops and on neither.
    pub(crate) fn are_around(&self, x: f64) -> bool {
        self.left.is_none_or(|stop| stop.x < x) && self.right.is_none_or(|stop| x < stop.x)
    }
}
