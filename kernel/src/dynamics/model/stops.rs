//! Stops of a scene in SI.

use crate::scene::Stops;

/// The stops of a scene; a side without one is open.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
        let (positions, restitutions) = (stops.positions_mm(), stops.restitutions());
        let [left, right] = [0, 1].map(|side| {
            let restitution = restitutions[side].unwrap_or(1.0);
            positions[side].map(|mm| StopAt { x: mm / 1e3, restitution })
        });
        (*stops != Stops::None).then_some(Self { left, right })
    }

    /// Whether a displacement in m lies between the stops and on neither.
    pub(crate) fn are_around(&self, x: f64) -> bool {
        self.left.is_none_or(|stop| stop.x < x) && self.right.is_none_or(|stop| x < stop.x)
    }
}
