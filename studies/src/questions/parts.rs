//! What the window of interwell asks while a scene is changed: answers that come in parts, and numbers of its
//! sentences. A program asks the questions beside it.

use std::sync::Arc;

use super::{Error, Progress, Simulation};
use crate::dynamics::Summary;
use crate::mechanics::Mechanism;
use crate::scene::{Document, Scene};
use crate::study::{self, Direction, Family, Thresholds, Visit, settled, up_and_down};

impl Simulation {
    /// What the motion settles to.
    #[doc(hidden)]
    pub fn settled(&self, progress: &Progress) -> Result<Summary, Error> {
        settled(self.model(), progress.stop()).ok_or(Error::Cancelled)
    }
}

/// The thresholds of the amplitude of a scene; `None` if it has none, or if cancelled.
pub fn thresholds(scene: &Scene, mechanism: &Arc<Mechanism>, progress: &Progress) -> Option<Thresholds> {
    study::thresholds(scene, mechanism, &progress.silent())
}

/// The largest travel limit in mm with which the mass of a scene is known to cross, if there is one, when all
/// stops have this `restitution`.
pub fn stops_that_cross(
    scene: &Scene,
    mechanism: &Arc<Mechanism>,
    restitution: f64,
    progress: &Progress,
) -> Result<Option<f64>, Error> {
    study::stops_that_cross(scene, mechanism, restitution, &progress.silent()).map_err(|_| Error::Cancelled)
}

/// Walks a field over ascending values in each of these directions, each run from the end of the one before,
/// and hands over each run as soon as it has ended. Values that make no scene are left out.
pub fn walks(
    document: &Document,
    mechanism: &Arc<Mechanism>,
    (field, values): (&str, &[f64]),
    directions: &[Direction],
    progress: &Progress,
    each: &(dyn Fn(Visit) + Sync),
) -> Result<(), Error> {
    let family = Family::new(&document.scene, &document.files, mechanism, field);
    let walk = |pool: &_| up_and_down(&family, values, directions, pool, &progress.silent(), each);
    if progress.pool(walk)? { Ok(()) } else { Err(Error::Cancelled) }
}
