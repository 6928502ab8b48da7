//! Remedies for runs that ended early or inaccurately.

use crate::dynamics::{Model, Outcome};
use crate::numeric::short;
use crate::scene::TOLERANCES;

/// A contact with a compliant stop is called short if the motion takes this many times as long.
const SHORT: f64 = 100.0;

/// A clause on how to make a run of `model` with this outcome last longer or be more accurate; `None` if it
/// is done, was cancelled, or the outcome says it.
pub fn ended_remedy(model: &Model, outcome: Outcome) -> Option<String> {
    let tolerance = model.tolerance();
    match outcome {
        Outcome::StepBudget { at, .. } => Some(
            model.fast_circuit().or_else(|| short_contact(model)).unwrap_or_else(|| fewer_steps(model, at)),
        ),
        Outcome::Inaccurate { .. } => {
            Some(model.fast_circuit().unwrap_or_else(|| match tolerance > TOLERANCES.0 {
                true => "use a smaller tolerance".to_owned(),
                false => format!("{tolerance:e} is the smallest tolerance, so the cause lies elsewhere"),
            }))
        }
        Outcome::NotFinite { .. } => Some(model.fast_circuit().unwrap_or_else(|| match model.stops() {
            None => "stops, or a force that holds the mass, keep the motion within bounds".to_owned(),
            Some(_) => "smaller numbers in the scene (stiffness, amplitude, speed) keep it finite".to_owned(),
        })),
        Outcome::Done
        | Outcome::LeftTable { .. }
        | Outcome::ImpactBudget { .. }
        | Outcome::Cancelled { .. } => None,
    }
}

/// A clause on how to keep a run within its steps, which it used up at `at` in s: a shorter run, a larger
/// tolerance if its cheaper steps suffice, fewer lines if most of the work is theirs.
fn fewer_steps(model: &Model, at: f64) -> String {
    let (step, of_drive) = model.cost_of_a_step(model.tolerance());
    let (coarse, _) = model.cost_of_a_step(TOLERANCES.1);
    let mut ways = vec![format!("a run of some {} s", short(at))];
    if at * step as f64 / coarse as f64 >= model.duration() {
        ways.push("a larger tolerance".to_owned());
    }
    if 2 * of_drive > step {
        ways.push("an excitation of fewer lines".to_owned());
    }
    let last = ways.pop().unwrap_or_default();
    let others = if ways.is_empty() { String::new() } else { format!("{} or ", ways.join(", ")) };
    format!("{others}{last} would do")
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
