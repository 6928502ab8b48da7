//! Melnikov's threshold: the least amplitude of a sine at which the stable and the unstable manifold of the
//! barrier meet, to first order in damping and drive.
//!
//! Along the homoclinic orbit x_0(t) of the undamped mass, with velocity v, the distance of the manifolds is
//! proportional to M(t_0) = integral of v (-c v - m a sin(w (t + t_0))) dt (Melnikov 1963; Guckenheimer and
//! Holmes 1983, section 4.5). It has zeros for some t_0 if the amplitude a of the base's acceleration is
//! above c integral of v^2 dt / (m |integral of v exp(i w t) dt|).

use super::chart::MELNIKOV;
use super::{NoThresholds, from_rest};
use crate::dynamics::Model;
use crate::mechanics::Homoclinic;
use crate::scene::Scene;
use crate::study::{Cells, Heading, Table, Task};
use crate::system::threads::Pool;

/// The columns and what they mean.
pub(super) fn headings() -> Vec<Heading> {
    let words = "Melnikov's threshold in the unit of the amplitude, of a `Sine`, a `Cosine` or a `Force`: \
                 the least amplitude at which the stable and the unstable manifold of the barrier meet, to \
                 first order in damping and drive (Guckenheimer and Holmes 1983, section 4.5), for the \
                 well in which the mass rests; empty where it does not apply, which a remark explains";
    let [g, m_per_s2, n] = MELNIKOV;
    [(g, ""), (m_per_s2, ""), (n, words)].map(|(name, words)| Heading { name, words }).into()
}

/// Melnikov's threshold in m/s^2 of the base's acceleration under a sine of this frequency in Hz, for the
/// well in which the model starts; `None` where it does not apply.
///
/// It is the first order in damping and drive: exact in the limit of both. Above it the border of the basin
/// of a well is no longer smooth and motions that cross in an irregular way exist, which a chaotic motion
/// needs (Moon and Holmes 1979) and which begins the erosion of the basin (Thompson 1989). It is no threshold
/// of a motion from rest, whose escape may come far above it.
///
/// It needs damping that is linear and above 0, a barrier without a kink, and a well whose homoclinic orbit
/// touches neither a stop nor the end of the curve; it is missing as well where the drive is so fast that
/// [`Homoclinic::transform`] is.
pub fn melnikov_threshold(model: &Model, frequency_hz: f64) -> Option<f64> {
    let (mass, damping, start) = (model.mass(), model.total_damping(), model.start().0);
    if !(damping > 0.0) || model.has_electrical_state() {
        return None;
    }
    let mechanism = model.mechanism();
    let barrier = model.crossing_level().filter(|_| mechanism.landscape.barrier.is_some())?;
    let wells = mechanism.landscape.wells();
    let well = match start < barrier {
        true => wells.iter().rfind(|well| well.x < barrier)?,
        false => wells.iter().find(|well| well.x > barrier)?,
    };
    let orbit = Homoclinic::new(&mechanism.curve, barrier, well)?;
    let (left, right) = model.stop_positions();
    let (low, high) = (barrier.min(orbit.turn()), barrier.max(orbit.turn()));
    if left.is_some_and(|stop| stop >= low) || right.is_some_and(|stop| stop <= high) {
        return None;
    }
    let transform = orbit.transform(mass, std::f64::consts::TAU * frequency_hz)?;
    let threshold = damping * orbit.squared_velocity(mass) / (mass * transform);
    threshold.is_finite().then_some(threshold)
}

/// A table of thresholds with one more column, `melnikov_g` for a sine, `melnikov_m_per_s2` or `melnikov_n`
/// for a harmonic drive in SI: Melnikov's threshold of the amplitude in its unit in each of the cells,
/// missing where it does not apply and where the drive is not harmonic. The runs begin at rest.
pub fn with_melnikov(table: Table, cells: &Cells, pool: &Pool, task: &Task) -> Result<Table, NoThresholds> {
    let found = cells.map(1, pool, task, |scene, built, _| {
        let Some(drive) = scene.harmonic() else { return Ok(None) };
        let model = built.ok().and_then(|mechanism| Model::build(&from_rest(scene), mechanism).ok());
        let threshold = model.and_then(|model| melnikov_threshold(&model, drive.frequency_hz));
        Ok(threshold.map(|acceleration| drive.amplitude_of(acceleration)))
    })?;
    let unit = cells
        .scene()
        .harmonic()
        .and_then(|drive| drive.amplitude_path().strip_prefix("excitation.amplitude"));
    Ok(table.each(&format!("melnikov{}", unit.unwrap_or("_g")), &found, |found| *found))
}

/// Whether Melnikov's threshold can stand beside a threshold of this field.
pub fn suits_melnikov(scene: &Scene, field: &str) -> bool {
    scene.harmonic().is_some_and(|drive| drive.amplitude_path() == field)
}
