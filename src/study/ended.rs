//! Remedies for runs that ended early or inaccurately.

use crate::dynamics::{Model, Outcome};
use crate::numeric::short;
use crate::scene::TOLERANCES;

/// From so many times on a contact with a compliant stop is called shorter than the motion.
const SHORT: f64 = 100.0;

/// What makes a run of `model` that ended so last longer or closer, a clause; none where it is done, was
/// cancelled, or the end says it.
pub fn ended_remedy(model: &Model, outcome: Outcome) -> Option<String> {
    let tolerance = model.tolerance();
    match outcome {
        Outcome::StepBudget { .. } => {
            Some(model.fast_circuit().or_else(|| short_contact(model)).unwrap_or_else(|| {
                match tolerance < TOLERANCES.1 {
                    true => "a larger tolerance or a shorter run takes fewer".to_owned(),
                    false => format!("a shorter run takes fewer; {tolerance} is the largest tolerance"),
                }
            }))
        }
        Outcome::Inaccurate { .. } => {
            Some(model.fast_circuit().unwrap_or_else(|| match tolerance > TOLERANCES.0 {
                true => "use a smaller tolerance".to_owned(),
                false => format!("{tolerance:e} is the smallest tolerance, so the cause lies elsewhere"),
            }))
        }
        Outcome::NotFinite { .. } => Some(match model.stops() {
            None => "stops, or a force that holds the mass, keep the motion within bounds".to_owned(),
            Some(_) => "smaller numbers in the scene (stiffness, amplitude, speed) keep it finite".to_owned(),
        }),
        Outcome::Done
        | Outcome::LeftTable { .. }
        | Outcome::ImpactBudget { .. }
        | Outcome::Cancelled { .. } => None,
    }
}

/// Why steps are short with stops so stiff that a contact is far shorter than the motion.
fn short_contact(model: &Model) -> Option<String> {
    let (speed, time) = (model.scales().speed, model.scales().time);
    let contact = model.compliant()?.contact_time(model.mass(), speed);
    (contact * SHORT < time).then(|| {
        format!(
            "a contact with a stop lasts {} s at {} m/s and takes steps of its own, where the motion takes \
             {} s; softer stops, rigid ones (`Rigid`) or a shorter run take fewer",
            short(contact),
            short(speed),
            short(time)
        )
    })
}
