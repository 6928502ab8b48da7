//! Construction of the model of a scene, and the reasons why it fails; stops that suit a scene without stops.

use std::sync::Arc;

use crate::app::words::fields::{in_words, name_and_unit};
use crate::app::words::numbers::rounded;
use crate::dynamics::Model;
use crate::mechanics::Mechanism;
use crate::questions::Error;
use crate::scene::{Document, Fault, Scene, SceneError, Stops};

/// Restitution of the stops if the scene gives no stops to switch on.
const RESTITUTION: f64 = 0.36;

pub(super) fn mechanism(document: &Document, tolerance: f64) -> Result<Arc<Mechanism>, Error> {
    let built = Mechanism::build_with(&document.scene.mechanism, &document.files, tolerance, None);
    built.map(Arc::new).map_err(|error| Error::unbuilt(document, error))
}

/// The model of a scene that has been checked, with its mechanism.
pub(super) fn model(document: &Document, mechanism: &Arc<Mechanism>) -> Result<Model, Error> {
    let model = Model::build(&document.scene, Arc::clone(mechanism));
    model.map_err(|faults| Error::faults_of(document, faults))
}

pub(super) fn solve(document: &Document, tolerance: f64) -> Result<(Arc<Mechanism>, Model), Error> {
    document.check()?;
    let mechanism = mechanism(document, tolerance)?;
    let model = model(document, &mechanism)?;
    Ok((mechanism, model))
}

/// The first fault, with the field names of the screen and without its position in the file.
pub(super) fn fault_message(error: &Error, scene: &Scene) -> String {
    if let Error::Scene(SceneError::Faults { faults, .. }) = error
        && let Some(placed) = faults.first()
    {
        let Fault { field, value, problem } = &placed.fault;
        let (name, unit) = name_and_unit(field);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        return in_words(&format!("{name} = {value}{unit}: {problem}"), scene);
    }
    error.problem()
}

/// Distance of the right-hand well from the middle in mm.
pub(super) fn well_distance_mm(model: &Model) -> Option<f64> {
    model.mechanism().landscape.right_stable().map(|well| well.x.abs() * 1e3)
}

/// The stops that the scene gets when they are first switched on.
pub(super) fn first_stops(scene: &Scene, model: &Model) -> Stops {
    let hinted = || scene.app.as_ref().and_then(|hints| hints.stops_when_on);
    let suiting = || {
        // the same share of the distance of the wells as in the prototype
        let well_mm = well_distance_mm(model).filter(|mm| *mm > 0.0 && mm.is_finite());
        let travel_limit_mm = well_mm.map_or(1.5, |mm| rounded(0.215 * mm, 2));
        Stops::Rigid { travel_limit_mm, restitution: RESTITUTION }
    };
    if scene.stops == Stops::None { hinted().unwrap_or_else(suiting) } else { scene.stops }
}
