//! Stops that limit the travel.

use serde::{Deserialize, Serialize};

/// Travel limits.
///
/// At a rigid stop the velocity changes from v to -e v, with the restitution e; a mass that is pressed on it
/// rests until the net force changes sign. A compliant stop has a mode of motion of its own
/// ([`Hertz`](crate::mechanics::Hertz); Hunt and Crossley 1975).
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Stops {
    /// No stops.
    #[default]
    None,
    /// Equal rigid stops on both sides.
    Rigid {
        /// Distance of each stop from x = 0 in mm, 1e-15 to 1e15.
        travel_limit_mm: f64,
        /// Coefficient of restitution, 0 to 1.
        restitution: f64,
    },
    /// Rigid stops anywhere; a side left out is open. A distance of 0 is a stop at x = 0, and one below 0 is
    /// a stop beyond it: `left_mm: -1, right_mm: 3` are stops at 1 and at 3 mm.
    Uneven {
        /// Distance of the left stop from x = 0 to the left in mm, -1e15 to 1e15.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        left_mm: Option<f64>,
        /// Distance of the right stop from x = 0 to the right in mm, -1e15 to 1e15.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        right_mm: Option<f64>,
        /// Restitution of the left stop, 0 to 1; left out, that of the right stop.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        restitution_left: Option<f64>,
        /// Restitution of the right stop, 0 to 1; left out, that of the left stop.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        restitution_right: Option<f64>,
    },
    /// Equal compliant stops on both sides: Hertzian point contacts with the loss of Hunt and Crossley. At
    /// depth d a stop pushes back with k d^1.5 (1 + a d') and never pulls. k is given, or follows from the
    /// two equal cylinders of one material, crossed at a right angle, that form each contact.
    Hertz {
        /// Distance of each stop from x = 0 in mm, 1e-15 to 1e15.
        travel_limit_mm: f64,
        /// Stiffness k in N/m^1.5, 1e-60 to 1e60; left out if the cylinders are given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stiffness_n_per_m1_5: Option<f64>,
        /// Loss a in s/m, 0 to 1e30. The restitution depends on loss times impact speed alone: 2.427 gives
        /// 0.36.
        loss_s_per_m: f64,
        /// Radius of the cylinders in mm, 1e-15 to 1e15.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        radius_mm: Option<f64>,
        /// Young's modulus of the cylinders in GPa, 1e-60 to 1e60.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        young_gpa: Option<f64>,
        /// Poisson's ratio of the cylinders, 0 to 0.49; left out, 0.34.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        poisson: Option<f64>,
        /// Yield strength of the cylinders in GPa, 1e-60 to 1e60; left out, 0.276 (aluminium 6061-T6). It
        /// does not affect the motion; a run warns if the contact pressure exceeds 1.6 times this strength.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        yield_gpa: Option<f64>,
    },
}

impl Stops {
    /// Distances of the left and the right stop from x = 0 in mm, each towards its side; `None` for an open
    /// side.
    pub fn limits_mm(&self) -> [Option<f64>; 2] {
        match *self {
            Self::None => [None; 2],
            Self::Rigid { travel_limit_mm, .. } | Self::Hertz { travel_limit_mm, .. } => {
                [Some(travel_limit_mm); 2]
            }
            Self::Uneven { left_mm, right_mm, .. } => [left_mm, right_mm],
        }
    }

    /// Displacements of the left and the right stop in mm; `None` for an open side.
    pub fn positions_mm(&self) -> [Option<f64>; 2] {
        let [left, right] = self.limits_mm();
        // the sum with 0 makes a 0 of -0
        [left.map(|mm| 0.0 - mm), right.map(|mm| mm + 0.0)]
    }

    /// The distance in mm of both stops, if they have one common field.
    pub fn travel_limit_mm(&self) -> Option<f64> {
        if matches!(self, Self::Uneven { .. }) { None } else { self.limits_mm()[0] }
    }

    /// Coefficients of restitution on the left and on the right; one that is left out equals the other.
    /// `None` for compliant stops.
    pub fn restitutions(&self) -> [Option<f64>; 2] {
        match *self {
            Self::None | Self::Hertz { .. } => [None; 2],
            Self::Rigid { restitution, .. } => [Some(restitution); 2],
            Self::Uneven { restitution_left: left, restitution_right: right, .. } => {
                [left.or(right), right.or(left)]
            }
        }
    }

    /// Moves the stop of one side, or both stops if they share one distance. An open side stays open.
    pub fn set_limit(&mut self, right: bool, mm: f64) {
        match self {
            Self::None => {}
            Self::Rigid { travel_limit_mm, .. } | Self::Hertz { travel_limit_mm, .. } => {
                *travel_limit_mm = mm
            }
            Self::Uneven { left_mm, right_mm, .. } => {
                let limit = if right { right_mm } else { left_mm };
                *limit = limit.map(|_| mm);
            }
        }
    }
}
