//! Sentences about the best stops of a scene.

use super::{Guide, capital};
use crate::app::words::numbers::{power, three};
use crate::app::words::status::speed;
use crate::numeric::{decimals, short};
use crate::questions::{BestDesign, Optimum};
use interwell_studies::study::{BasinMap, Seeds, SummaryField};

/// A value of the maximised column, with its unit.
fn value_of(column: &str, value: f64) -> String {
    if column.ends_with("_w") { power(value) } else { format!("{} mm/s", speed(value)) }
}

/// The sentence while the search runs: the number of runs so far, and the best stops of its coarse scan.
pub fn looking(runs: u64, best: Option<&Optimum>, column: &str) -> String {
    let so_far = best.map_or_else(String::new, |best| {
        format!("; so far ±{} mm with {}", short(best.at[0]), value_of(column, best.value))
    });
    format!("Looking for the best stops: {runs} runs{so_far}.")
}

/// The answer of a search with runs from rest. Each run lasts `duration_s` seconds or, if that is `None`,
/// until its motion repeats.
pub fn answer_guide(
    answer: &Result<Box<BestDesign>, String>,
    column: &str,
    (low, high): (f64, f64),
    duration_s: Option<f64>,
) -> Guide {
    let name = SummaryField::find(column).map_or(column, |field| field.label);
    let mm = |value: f64| format!("{} mm", short(value));
    let between = format!("between ±{} and ±{}", short(low), mm(high));
    let runs = match duration_s {
        Some(duration) => format!("Searched {between}, from rest, in runs of {} s.", three(duration)),
        None => format!(
            "Searched {between}, from rest, each run followed until its motion repeats, for at most {} \
             forcing periods more.",
            BasinMap::PATIENCE
        ),
    };
    let guide = |heading: &str, text: String| Guide { more: runs, ..Guide::new(heading, text) };
    let Ok(design) = answer else {
        return guide("No best stops:", format!("with stops anywhere {between} no run has a {name}."));
    };
    let (at, value) = (design.optimum.at[0], value_of(column, design.optimum.value));
    if design.flat {
        return guide("No stops are best:", format!("the {name} is {value} wherever they stand {between}."));
    }
    let [inward, outward] = design.margins[0];
    // rounded towards the best, so that the sentence holds at both ends
    let rounded = |x: f64, round: fn(f64) -> f64| {
        let per_unit = 10.0_f64.powi(decimals(x, 3) as i32);
        round(x * per_unit) / per_unit
    };
    let from = inward.map_or(low, |margin| rounded(at - margin, f64::ceil));
    let to = outward.map_or(high, |margin| rounded(at + margin, f64::floor));
    let border = if design.at_border[0] { " It is an end of the range that was searched." } else { "" };
    let seed = if design.seeds == Seeds::Alone { " With another seed of the noise both differ." } else { "" };
    let text = match design.later {
        // its margins say nothing then
        Some(later) => {
            let later = if later.is_nan() { "none".to_owned() } else { value_of(column, later) };
            let open = "of a motion that has not repeated; followed for twice as long it has";
            format!("{name} {value}, {open} {later}.{border}{seed}")
        }
        None => format!(
            "{name} {value}; at least nine tenths of it from ±{} to ±{} mm.{border}{seed}",
            three(from),
            three(to)
        ),
    };
    guide(&format!("Best stops: ±{}.", mm(at)), capital(&text))
}
