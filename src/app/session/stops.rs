//! Stops that suit a scene without stops.

use crate::dynamics::Model;
use crate::scene::{Scene, Stops};

/// Restitution of the stops if the scene gives no stops to switch on.
const RESTITUTION: f64 = 0.36;

/// The stops that the scene gets when they are first switched on.
pub(super) fn first_stops(scene: &Scene, model: &Model) -> Stops {
    let hinted = || scene.app.as_ref().and_then(|hints| hints.stops_when_on);
    let suiting = || {
        let well = model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3);
        Stops::Rigid { travel_limit_mm: suiting_limit(well), restitution: RESTITUTION }
    };
    match scene.stops {
        Stops::None => hinted().unwrap_or_else(suiting),
        stops => stops,
    }
}

/// Travel limit in mm that suits a well at this distance: the same share of it as in the prototype.
pub fn suiting_limit(well_mm: Option<f64>) -> f64 {
    match well_mm.filter(|mm| *mm > 0.0 && mm.is_finite()) {
        Some(mm) => format!("{:.1e}", 0.215 * mm).parse().unwrap_or(mm),
        None => 1.5,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_suit_the_distance_of_the_wells() {
        assert_eq!(
            (suiting_limit(Some(6.9)), suiting_limit(Some(1000.0)), suiting_limit(None)),
            (1.5, 220.0, 1.5)
        );
    }
}
