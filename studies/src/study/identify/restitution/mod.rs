//! Coefficient of restitution from a record of displacement, or from the times of impacts.

mod contacts;
mod meeting;
mod motion;
mod trials;

use self::contacts::{Contact, contacts};
use self::meeting::{place, restitution as ratio};
use self::motion::Motion;
use self::trials::{Choice, Single, Trial, each, together, trials};
use super::{Identified, Identity, Unidentified, median, with_interval};
use crate::numeric::regression::{geometric, student};
use crate::numeric::{elementary, short};
use crate::study::Table;

const RESTITUTION: &str = "restitution";

/// Samples that a rebound should have.
pub(super) const ENOUGH: usize = 8;

/// Restitution of the impacts in a record of displacement `x` in m over `times` in s, for a mass that is
/// shaken between stops or bounces freely.
///
/// A turning point is an impact where the velocity jumps, and a stop is where the outermost impacts lie, or
/// those near a place `given` (left, right). On each side of an impact a polynomial is fitted to the flight;
/// the slopes at their intersection are the speeds before and after it. The displacement caused by the
/// `accelerations` of the base in m/s^2 alone is subtracted first.
///
/// Window and degree are those with the narrowest interval, which includes the differences from other windows
/// and degrees. Clipped samples are left out. If the stops differ by more than their intervals, the interval
/// of the common number contains both; if the impacts on a stop do, the interval is widened accordingly
/// (Birge 1932).
pub fn restitution(
    times: &[f64],
    x: &[f64],
    accelerations: Option<&[f64]>,
    given: [Option<f64>; 2],
) -> Result<Identified, Unidentified> {
    let motion = Motion::new(times, x, accelerations);
    let (mut contacts, stops) = contacts(&motion, given);
    if contacts.is_empty() {
        return Err(unresolved(&motion, 0));
    }
    let trials = trials(&motion, &mut contacts, &stops);
    let singles = each(&trials, contacts.len());
    let found = numbers(&contacts, &trials, &singles);
    let (mut summary, used, mut remarks) = found.ok_or_else(|| unresolved(&motion, contacts.len()))?;
    for (right, name) in [(false, "left_stop_m"), (true, "right_stop_m")] {
        if let Some((place, _)) = together(&trials, |k| contacts[k].right == right, place) {
            remarks.extend(given[usize::from(right)].and_then(|given| elsewhere(right, given, place)));
            summary.push(Identity::new(name, place.value, place.half));
        }
    }
    let counts = [
        ("impacts_found", contacts.len()),
        ("impacts_used", used),
        ("impacts_left_out", contacts.len() - used),
    ];
    let count = |(name, count)| Identity { name, value: count as f64, interval: (f64::NAN, f64::NAN) };
    summary.extend(counts.map(count));
    remarks.extend(left_out(&motion, &contacts, &singles, used));
    remarks.extend(cut_off(&motion).map(|(swings, limits)| {
        format!(
            "clipped: {swings} swings have flat tops at {limits} mm, at the limit of the sensor or its \
             converter; impacts that they hide are left out"
        )
    }));
    let (rows, fitted) = (rows(&contacts, &singles), fitted(&motion, &contacts, &singles));
    Ok(Identified { rows, fitted, summary, remarks, tolerance: None })
}

/// The restitutions, the number of impacts of the first one, and remarks.
fn numbers(
    contacts: &[Contact],
    trials: &[Trial],
    singles: &[Single],
) -> Option<(Vec<Identity>, usize, Vec<String>)> {
    let of = |name: &'static str, counts: fn(bool) -> bool| {
        let (choice, used) = together(trials, |k| counts(contacts[k].right), ratio)?;
        let singles: Vec<&Single> =
            singles.iter().filter(|single| counts(contacts[single.contact].right)).collect();
        let scatter = scatter(choice, &singles);
        let identity = Identity::new(name, choice.value, choice.half * scatter.unwrap_or(1.0));
        Some((identity, used, scatter.is_some()))
    };
    let sides = [of("restitution_left", |right| !right), of("restitution_right", |right| right)];
    let mut remarks = Vec::new();
    let mut summary = Vec::new();
    let mut used = 0;
    match sides {
        [Some((left, n, _)), Some((right, m, _))] if differ(left, right) => {
            let text =
                "the stops differ by more than their intervals; the interval of the one number holds both";
            remarks.push(text.to_owned());
            summary.push(spanning(left, right));
            used += n + m;
        }
        _ => {
            let (whole, count, _) = of(RESTITUTION, |_| true)?;
            summary.push(whole);
            used += count;
        }
    }
    if let [Some((left, ..)), Some((right, ..))] = sides {
        summary.extend([left, right]);
    }
    if sides.iter().flatten().any(|(_, _, scatter)| *scatter) {
        remarks.push(
            "the impacts of a stop differ by more than their intervals: the restitution depends on speed or \
             what else the rows show, and the one number is a mean"
                .to_owned(),
        );
    }
    remarks.extend(summary.iter().filter_map(above_one));
    Some((summary, used, remarks))
}

fn half(number: Identity) -> f64 {
    0.5 * (number.interval.1 - number.interval.0)
}

/// Whether two numbers differ by more than one and a half times the interval of their difference.
fn differ(one: Identity, other: Identity) -> bool {
    (one.value - other.value).abs() > 1.5 * elementary::hypot(half(one), half(other))
}

/// The weighted mean of two numbers, with an interval that contains both of theirs.
fn spanning(one: Identity, other: Identity) -> Identity {
    let [a, b] = [one, other].map(|number| half(number).powi(-2));
    let interval = (one.interval.0.min(other.interval.0), one.interval.1.max(other.interval.1));
    Identity { name: RESTITUTION, value: (a * one.value + b * other.value) / (a + b), interval }
}

/// Factor by which single impacts scatter beyond their intervals; `None` if they do not.
fn scatter(common: Choice, singles: &[&Single]) -> Option<f64> {
    let count = singles.len() as f64;
    let apart = |single: &&Single| {
        (single.ratio.value - common.value) / elementary::hypot(single.ratio.half, common.half)
    };
    // half of an interval is about two standard errors
    let square = 4.0 * singles.iter().map(|single| apart(single).powi(2)).sum::<f64>() / count;
    (square > 1.0 + 4.0 * (2.0 / count).sqrt()).then(|| square.sqrt())
}

fn above_one(number: &Identity) -> Option<String> {
    let which = match number.name {
        "restitution_left" => " of the left stop",
        "restitution_right" => " of the right stop",
        _ => "",
    };
    let text = if number.interval.0 > 1.0 {
        "is above 1, which a stop at rest cannot make: the stop moves, the acceleration jumps at the \
         impacts, or these are no impacts"
    } else if number.value > 1.0 {
        "is above 1 by less than its error"
    } else {
        return None;
    };
    Some(format!("the restitution{which} {text}"))
}

fn elsewhere(right: bool, given: f64, place: Choice) -> Option<String> {
    let side = if right { "right" } else { "left" };
    let [found, place_given] = [place.value, given].map(|x| short(1e3 * x));
    let apart = (place.value - given).abs() > place.half;
    apart.then(|| format!("the {side} stop lies at {found} mm, not at {place_given} mm"))
}

fn left_out(motion: &Motion, contacts: &[Contact], singles: &[Single], used: usize) -> Option<String> {
    let found = contacts.len();
    let fitted = |k: usize| singles.binary_search_by_key(&k, |single| single.contact).is_ok();
    let missing = |(k, contact): &(usize, &Contact)| !fitted(*k) && motion.is_missing(contact.time(motion));
    let missing = contacts.iter().enumerate().filter(missing).count().min(found - used);
    let short = found - used - missing;
    let part = |count: usize, why: &str| (count > 0).then(|| format!("{count} {why}"));
    let parts = [
        part(short, "with flights of too few samples for this rate or lost in noise"),
        part(missing, "where samples are missing"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    let text =
        || format!("of {found} contacts with the stops {used} are used; left out: {}", parts.join(", "));
    (!parts.is_empty()).then(text)
}

/// How many swings are cut off, and the limits in mm in words.
fn cut_off(motion: &Motion) -> Option<(usize, String)> {
    let cut = motion.cut.iter().flatten();
    let limits: Vec<String> = cut.clone().map(|cut| short(1e3 * cut.limit)).collect();
    (!limits.is_empty()).then(|| (cut.map(|cut| cut.swings).sum(), limits.join(" and ")))
}

/// The reason why `found` contacts give no restitution, and the sampling rate needed.
fn unresolved(motion: &Motion, found: usize) -> Unidentified {
    if found == 0
        && let Some((swings, limits)) = cut_off(motion)
    {
        return Unidentified::CutOff(swings, limits);
    }
    let (noise, rate) = (short(motion.noise), 1.0 / motion.timing.step);
    match contacts::longest_rebound(motion).or((found > 0).then_some(2)) {
        Some(longest) if longest < ENOUGH => {
            let [rate, needed] = [rate, rate * ENOUGH as f64 / longest as f64].map(short);
            Unidentified::Slow { longest, rate, needed }
        }
        _ if found > 0 => Unidentified::Noisy(found, noise),
        _ => Unidentified::NoImpact(noise),
    }
}

fn rows(contacts: &[Contact], singles: &[Single]) -> Table {
    let right = |single: &Single| contacts[single.contact].right;
    let outward = |single: &Single| if right(single) { 1.0 } else { -1.0 };
    let side = |single: &Single| if right(single) { "right" } else { "left" };
    let table = Table::new().each("t_s", singles, |single| single.impact.t).each("side", singles, side);
    let table = with_interval(table, "v_in_m_per_s", singles, |single| {
        Identity::new("v_in_m_per_s", outward(single) * single.impact.towards, single.halves[0])
    });
    let table = with_interval(table, "v_out_m_per_s", singles, |single| {
        Identity::new("v_out_m_per_s", -outward(single) * single.impact.away, single.halves[1])
    });
    with_interval(table, RESTITUTION, singles, |single| {
        Identity::new(RESTITUTION, single.ratio.value, single.ratio.half)
    })
}

/// The impacts, and how far each flight goes after it.
fn fitted(motion: &Motion, contacts: &[Contact], singles: &[Single]) -> Table {
    let farthest = |single: &Single| {
        let away = |i: &usize| (motion.x[*i] - single.impact.x).abs();
        let flight = motion.from(single.impact.t)..contacts[single.contact].flights.end;
        flight.max_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let ends: Vec<Option<usize>> = singles.iter().map(farthest).collect();
    let at = |values: &[f64], end: &Option<usize>| end.map(|i| values[i]);
    Table::new()
        .each("t_s", singles, |single| single.impact.t)
        .each("x_m", singles, |single| single.impact.x)
        .each("rebound_t_s", &ends, |end| at(&motion.times, end))
        .each("rebound_x_m", &ends, |end| at(&motion.x, end))
}

/// Restitution of the impacts at these `times` in s of a body that bounces on one stop under a constant
/// acceleration: then each flight is as much shorter than the one before, and the times follow c + a e^k,
/// which is fitted by least squares. One row for each impact between two flights.
pub fn restitution_of_times(times: &[f64]) -> Result<Identified, Unidentified> {
    let none = |why| Unidentified::NoBounces(times.len(), why);
    let law = geometric(times).ok_or_else(|| none("give more, or such as lie between bounces alone"))?;
    let e = law.coefficients[2];
    if !(e > 0.0 && law.coefficients[1] < 0.0) {
        return Err(none("the flights do not become shorter; give such as lie between bounces alone"));
    }
    let misfit = |(k, t): (usize, &f64)| {
        (t - law.coefficients[0] - law.coefficients[1] * elementary::powi(e, k as i32)).powi(2)
    };
    let noise = (times.iter().enumerate().map(misfit).sum::<f64>() / law.freedom as f64).sqrt();
    let row = |times: &[f64]| {
        let flight = times[1] - times[0];
        let ratio = (times[2] - times[1]) / flight;
        let error = noise / flight * (1.0 + ratio.powi(2) + (1.0 + ratio).powi(2)).sqrt();
        (times[1], Identity::new(RESTITUTION, ratio, student(law.freedom) * error))
    };
    let rows: Vec<(f64, Identity)> = times.windows(3).map(row).collect();
    let rows = with_interval(Table::new().each("t_s", &rows, |row| row.0), RESTITUTION, &rows, |row| row.1);
    let half = student(law.freedom) * law.covariance[(2, 2)].sqrt();
    let remarks = vec![
        "of impact times: the ratio of successive flights, which is the restitution where the acceleration \
         of the flights is constant"
            .to_owned(),
    ];
    let summary = vec![Identity::new(RESTITUTION, e, half)];
    Ok(Identified { rows, fitted: Table::new(), summary, remarks, tolerance: None })
}
