//! Ranges of the sliders, derived from the scales of the scene.

use crate::app::words::fields::Reach;
use crate::app::words::numbers::{below, decimal, round_up};
use crate::dynamics::STANDARD_GRAVITY;
use crate::numeric::elementary;
use crate::numeric::round::decade;
use crate::scene::{Control, FieldPath, Mechanism, Scale, Stops};

use super::Session;
use super::build::well_distance_mm;

/// The range of a control's slider: that for the prototype, or one derived from the scales of the scene.
pub fn reach(control: &Control, session: &Session) -> Reach {
    let (low, high, step) = control.slider;
    let (usual, saved_scene) = (Reach::even(low, high, step), session.editor.saved());
    let saved = FieldPath::new(control.path).get(saved_scene);
    let scales = session.opened.scales();
    // for the prototype these are 2 g and 20 Hz
    let scaled = match control.scale {
        Scale::Fixed => None,
        Scale::Value => saved.map(|value| 2.5 * value.abs()),
        Scale::Push => Some(0.15 * high * scales.length / scales.time.powi(2) / STANDARD_GRAVITY),
        // the force in the prototype is 1 N
        Scale::Force => Some(high * saved_scene.mass_g / 1e3 * scales.length / scales.time.powi(2)),
        Scale::Rate => Some(0.065 * high / (std::f64::consts::TAU * scales.time)),
        Scale::Travel => return travel(session),
        Scale::Preload => return preload(session).unwrap_or(usual),
        Scale::Ratio => return decades(saved).unwrap_or(Reach { ratios: true, ..usual }),
    };
    let fits = saved.is_none_or(|value| (low..=high).contains(&value))
        && match control.scale {
            Scale::Push | Scale::Force | Scale::Rate => {
                scaled.is_none_or(|end| (0.25..=4.0).contains(&(end / high)))
            }
            Scale::Value => saved.is_none_or(|value| value == 0.0 || value.abs() > high / 200.0),
            _ => true,
        };
    let scaled = scaled.filter(|scaled| !fits && *scaled > 0.0 && scaled.is_finite());
    let Some(scaled) = scaled else { return usual };
    let new_high = round_up(scaled.max(1.25 * saved.map_or(0.0, f64::abs)));
    let new_low = if low < 0.0 { -new_high } else { low / high * new_high };
    let step = below(new_high / 200.0);
    Reach::even((new_low / step).round() * step, new_high, step)
}

/// The range of the slider of a travel limit: from near the middle to beyond the well.
fn travel(session: &Session) -> Reach {
    let (saved, limits) = (session.editor.saved(), [session.remembered_stops, session.scene().stops]);
    let well = well_distance_mm(&session.opened);
    let furthest = |stops: &Stops| stops.limits_mm().into_iter().flatten().map(f64::abs).reduce(f64::max);
    let stops = || furthest(&saved.stops).or_else(|| limits.iter().find_map(furthest));
    let size = well.filter(|mm| *mm > 0.0).or_else(stops).filter(|mm| *mm > 0.0).unwrap_or(10.0);
    let step = below(size / 130.0);
    Reach::even(2.0 * step, (0.6 * size / step).round() * 2.0 * step, step)
}

/// Five powers of ten around a value; `None` around 0 and infinity.
fn decades(value: Option<f64>) -> Option<Reach> {
    let size = decade(value.filter(|value| *value > 0.0 && value.is_finite())?);
    let power = |exponent: i32| decimal(elementary::powi(10.0, exponent));
    (-100..100)
        .contains(&size)
        .then(|| Reach { ratios: true, ..Reach::even(power(size - 2), power(size + 3), power(size - 2)) })
}

/// Largest preload on the slider, as a share of the length of the shorter flexure.
const MAX_PRELOAD: f64 = 0.2;

fn preload(session: &Session) -> Option<Reach> {
    let Mechanism::Flexures { parallel, buckling, .. } = &session.editor.saved().mechanism else {
        return None;
    };
    let largest = MAX_PRELOAD * parallel.length_mm.min(buckling.length_mm);
    let step = below(largest / 80.0);
    Some(Reach::even(0.0, (largest / step).round() * step, step))
}
