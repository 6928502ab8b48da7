//! Coefficient of restitution from a record of displacement, or from the times of impacts.

mod base;
mod contacts;
mod drift;
mod meeting;
mod motion;
mod trials;

use self::contacts::{Contact, contacts, jumps, limit};
use self::drift::{Drift, stop_at, stops};
use self::meeting::restitution as ratio;
use self::motion::Motion;
use self::trials::{Choice, Single, Trial, each, locate, together, trials};
use super::{Identified, Identity, Unidentified, median, outliers, with_interval};
use crate::numeric::regression::{geometric, student};
use crate::numeric::{elementary, extent, short};
use crate::study::Table;

const RESTITUTION: &str = "restitution";

/// Standard errors of half an interval where the errors are known.
const NORMAL: f64 = 1.96;

/// Samples that a rebound should have.
pub(super) const ENOUGH: usize = 8;

/// Passes in which the drift of the record is found: before it is subtracted, some rebounds are no turning
/// points.
const PASSES: usize = 3;

/// Impacts on one stop differ in place by less than this share of the range while the drift is sought, since
/// it may not be uniform.
const LOOSE: f64 = 0.02;

/// Restitution of the impacts in a record of displacement `x` in m over `times` in s, for a mass that is
/// shaken between stops or bounces freely.
///
/// An impact is a turning point where the velocity jumps, and stops are where impacts lie, up to a slow drift
/// of all of them, to which the speeds are relative. On each side of an impact a polynomial is fitted to the
/// flight; the slopes at their intersection are the speeds before and after it. The displacement caused by
/// the `accelerations` of the base in m/s^2 alone is subtracted first.
///
/// Window and degree are those with the narrowest interval, which includes the differences from other windows
/// and degrees, the scatter of the impacts, and the error of the drift. Clipped samples and those that lie
/// off are left out. If the stops differ by more than their intervals, the interval of the common number
/// contains both.
pub fn restitution(
    times: &[f64],
    x: &[f64],
    accelerations: Option<&[f64]>,
) -> Result<Identified, Unidentified> {
    let mut motion = Motion::new(times, x, accelerations);
    let mut found = Vec::new();
    for _ in 0..PASSES {
        found = jumps(&mut motion, found);
        let (stops, members) = stops(&motion, &found, LOOSE);
        let drift = Drift::of(&motion, &found, stops.len(), &members);
        motion.subtract(&drift);
        found.iter_mut().for_each(|contact| contact.subtract(&motion, &drift));
    }
    found = jumps(&mut motion, found);
    let (mut contacts, lone) = contacts(&motion, found);
    if contacts.is_empty() {
        return Err(unresolved(&motion, &[]));
    }
    locate(&motion, &mut contacts);
    let (on, members) = stops(&motion, &contacts, 0.0);
    let drift = Drift::of(&motion, &contacts, on.len(), &members).or(lone);
    motion.subtract(&drift);
    contacts.iter_mut().for_each(|contact| contact.subtract(&motion, &drift));
    let (stops, members) = stops(&motion, &contacts, 0.0);
    for (contact, member) in contacts.iter_mut().zip(members) {
        match member.or_else(|| stop_at(&stops, contact.right, contact.time(&motion))) {
            Some(stop) if member.is_some() => contact.stop = stop,
            Some(stop) => (contact.stop, contact.impact) = (stop, None),
            None => contact.impact = None,
        }
    }
    limit(&motion, &mut contacts, &stops);
    let trials = trials(&motion, &contacts, &stops);
    let singles = each(&trials, contacts.len());
    let found = numbers(&motion, &contacts, &trials, &singles);
    let (mut summary, used, mut remarks) = found.ok_or_else(|| unresolved(&motion, &contacts))?;
    for (right, name) in [(false, "left_stop_m"), (true, "right_stop_m")] {
        let most = stops.iter().enumerate().filter(|(_, stop)| stop.right == right);
        let Some((main, _)) = most.max_by_key(|(_, stop)| stop.impacts) else { continue };
        if let Some((place, impacts)) = together(&trials, |k| contacts[k].stop == main, Trial::place) {
            let middle =
                impacts.iter().map(|impact| motion.part(impact.t)).sum::<f64>() / impacts.len() as f64;
            let moved = motion.drift.halves(middle).map_or(0.0, |(moved, _)| moved);
            let mut stop = Identity::new(name, place.value, elementary::hypot(place.half, moved));
            // no sample lies beyond a stop by more than noise
            let on_it = contacts.iter().filter(|contact| contact.stop == main && contact.impact.is_some());
            let times = on_it.map(|contact| contact.time(&motion));
            let (first, last) = extent(times);
            let samples = motion.x.get(motion.from(first)..motion.from(last));
            let (low, high) = extent(samples.unwrap_or_default().iter().copied());
            stop.interval = match right {
                true => (stop.interval.0, stop.interval.1.max(high + moved)),
                false => (stop.interval.0.min(low - moved), stop.interval.1),
            };
            summary.push(stop);
        }
    }
    let moves = singles.iter().map(|single| motion.drift.at(motion.part(single.impact.t)).1).sum::<f64>();
    let velocity = moves / singles.len() as f64 / motion.half();
    match drift_half(&motion, singles.iter().map(|single| single.impact.t)) {
        Some(half) => summary.push(Identity::new("stop_drift_m_per_s", velocity, half)),
        None => remarks.push(
            "each stop has a single impact, which tells no drift of the record: the stops are taken as at \
             rest"
                .to_owned(),
        ),
    }
    let counts = [
        ("impacts_found", contacts.len()),
        ("impacts_used", used),
        ("impacts_left_out", contacts.len() - used),
    ];
    let count = |(name, count)| Identity { name, value: count as f64, interval: (f64::NAN, f64::NAN) };
    summary.extend(counts.map(count));
    remarks.extend(outliers::remark(motion.outliers));
    remarks.extend(left_out(&motion, &contacts, &singles, used));
    remarks.extend(cut_off(&motion).map(|(swings, limits)| {
        format!(
            "clipped: {swings} swings have flat tops at {limits} mm, at the limit of the sensor or its \
             converter; impacts that they hide are left out"
        )
    }));
    let (rows, fitted) = (rows(&motion, &contacts, &singles), fitted(&motion, &contacts, &singles));
    Ok(Identified { rows, fitted, summary, remarks, tolerance: None })
}

/// Half of the interval of the velocity of the stops in m/s at these times in s, on average.
fn drift_half(motion: &Motion, times: impl Iterator<Item = f64>) -> Option<f64> {
    let halves: Option<Vec<f64>> = times.map(|t| Some(motion.drift.halves(motion.part(t))?.1)).collect();
    let halves = halves?;
    let square = halves.iter().map(|half| half * half).sum::<f64>() / halves.len() as f64;
    Some(square.sqrt() / motion.half())
}

/// The restitutions, the number of impacts of the first one, and remarks.
fn numbers(
    motion: &Motion,
    contacts: &[Contact],
    trials: &[Trial],
    singles: &[Single],
) -> Option<(Vec<Identity>, usize, Vec<String>)> {
    let of = |name: &'static str, counts: fn(bool) -> bool| {
        let (choice, impacts) = together(trials, |k| counts(contacts[k].right), Trial::ratio)?;
        let singles: Vec<&Single> =
            singles.iter().filter(|single| counts(contacts[single.contact].right)).collect();
        let drift = drift_half(motion, impacts.iter().map(|impact| impact.t)).unwrap_or(0.0);
        let of_drift = ratio(&impacts).map_or(0.0, |common| common.of_drift);
        let identity = Identity::new(name, choice.value, elementary::hypot(choice.half, drift * of_drift));
        Some((identity, impacts.len(), scatter(choice, &singles)))
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

/// Whether single impacts scatter beyond their intervals.
fn scatter(common: Choice, singles: &[&Single]) -> bool {
    let count = singles.len() as f64;
    let apart = |single: &&Single| {
        (single.ratio.value - common.value) / elementary::hypot(single.ratio.half, common.half)
    };
    // half of an interval is about two standard errors
    let square = 4.0 * singles.iter().map(|single| apart(single).powi(2)).sum::<f64>() / count;
    square > 1.0 + 4.0 * (2.0 / count).sqrt()
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

/// The reason why these contacts give no restitution, and the sampling rate needed.
fn unresolved(motion: &Motion, contacts: &[Contact]) -> Unidentified {
    let found = contacts.len();
    if found == 0
        && let Some((swings, limits)) = cut_off(motion)
    {
        return Unidentified::CutOff(swings, limits);
    }
    let missing = contacts.iter().filter(|contact| motion.is_missing(contact.time(motion))).count();
    if 2 * missing > found {
        return Unidentified::Missing(found, missing);
    }
    let (noise, rate) = (short(motion.noise), 1.0 / motion.timing.step);
    let flights = contacts.iter().map(|contact| contact.flights.end.saturating_sub(contact.at)).max();
    match contacts::longest_rebound(motion).or(flights) {
        Some(longest) if longest < ENOUGH => {
            let [rate, needed] = [rate, rate * ENOUGH as f64 / longest.max(1) as f64].map(short);
            Unidentified::Slow { longest, rate, needed }
        }
        _ if found > 0 => Unidentified::Noisy(found, noise),
        _ => Unidentified::NoImpact(noise),
    }
}

fn rows(motion: &Motion, contacts: &[Contact], singles: &[Single]) -> Table {
    let right = |single: &Single| contacts[single.contact].right;
    let outward = |single: &Single| if right(single) { 1.0 } else { -1.0 };
    let side = |single: &Single| if right(single) { "right" } else { "left" };
    let moved = |single: &Single| drift_half(motion, std::iter::once(single.impact.t)).unwrap_or(0.0);
    let half = |single: &Single, half: f64, of_drift: f64| elementary::hypot(half, moved(single) * of_drift);
    let table = Table::new().each("t_s", singles, |single| single.impact.t).each("side", singles, side);
    let table = with_interval(table, "v_in_m_per_s", singles, |single| {
        let speed = outward(single) * single.impact.towards;
        Identity::new("v_in_m_per_s", speed, half(single, single.halves[0], 1.0))
    });
    let table = with_interval(table, "v_out_m_per_s", singles, |single| {
        let speed = -outward(single) * single.impact.away;
        Identity::new("v_out_m_per_s", speed, half(single, single.halves[1], 1.0))
    });
    with_interval(table, RESTITUTION, singles, |single| {
        let of_drift = (1.0 + single.ratio.value) / single.impact.towards;
        Identity::new(RESTITUTION, single.ratio.value, half(single, single.ratio.half, of_drift))
    })
}

/// The impacts in the record, and how far each flight goes after it.
fn fitted(motion: &Motion, contacts: &[Contact], singles: &[Single]) -> Table {
    let farthest = |single: &Single| {
        let away = |i: &usize| (motion.x[*i] - single.impact.x).abs();
        let flight = motion.from(single.impact.t)..contacts[single.contact].flights.end;
        flight.max_by(|a, b| away(a).total_cmp(&away(b)))
    };
    let ends: Vec<Option<usize>> = singles.iter().map(farthest).collect();
    let recorded = |t: f64, x: f64| x + motion.drift.at(motion.part(t)).0;
    Table::new()
        .each("t_s", singles, |single| single.impact.t)
        .each("x_m", singles, |single| recorded(single.impact.t, single.impact.x))
        .each("rebound_t_s", &ends, |end| end.map(|i| motion.times[i]))
        .each("rebound_x_m", &ends, |end| end.map(|i| recorded(motion.times[i], motion.x[i])))
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
