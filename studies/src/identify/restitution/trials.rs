//! The impacts of a record, fitted over windows of several lengths by polynomials of several degrees, and the
//! window and the degree from which an estimate is taken.

use std::collections::BTreeMap;
use std::f64::consts::SQRT_2;
use std::ops::RangeInclusive;

use super::contacts::{Contact, Impact};
use super::drift::{Stop, tolerance};
use super::meeting::{Common, Meeting, Sides, restitution};
use super::{Motion, NORMAL, median};
use crate::numeric::elementary;
use crate::numeric::orthogonal::MAX_TERMS;
use crate::numeric::regression::student;

/// Coefficients of the polynomials on either side.
const TERMS: RangeInclusive<usize> = 3..=MAX_TERMS;

/// Coefficients of the fits from which the instants are taken.
const FIRST_TERMS: usize = 4;

/// The narrowest window on one side in steps of the record.
const NARROWEST: f64 = 3.5;
/// Ratio of each further window to the one before.
const WIDER: f64 = SQRT_2;

/// Smallest speed of an impact that counts, in its standard errors; slower ones have no certain time.
const FAST: f64 = 12.0;

/// Smallest number of degrees of freedom of the residuals of a trial.
const LEAST_FREEDOM: usize = 3;

/// Residuals below this share of the range are rounding, which is not alike in all flights.
const ROUNDING: f64 = 1e-13;

/// Number of impacts that the errors told by the residuals count as, where the impacts scatter by more.
///
/// Errors that are not independent from sample to sample, such as those of an acceleration of the base that
/// was integrated twice, do not show in the residuals but in the scatter of the impacts, which a few impacts
/// do not tell well.
const TRUSTED: f64 = 6.0;

/// All impacts, fitted with one window and one degree.
pub struct Trial {
    setting: Setting,
    variance: f64,
    /// Factor on a standard error that gives half of an interval.
    student: f64,
    /// Numbers of the contacts with their impacts.
    impacts: Vec<(usize, Meeting)>,
}

pub struct Single {
    pub contact: usize,
    pub impact: Meeting,
    pub ratio: Choice,
    /// Half of the intervals of both speeds.
    pub halves: [f64; 2],
}

impl Trial {
    fn selected(&self, counts: &impl Fn(usize) -> bool) -> Vec<&Meeting> {
        self.impacts.iter().filter(|(contact, _)| counts(*contact)).map(|(_, impact)| impact).collect()
    }

    /// The restitution of impacts together, and half of its interval.
    pub fn ratio(&self, impacts: &[&Meeting]) -> Option<(f64, f64)> {
        let Common { value, variance, square, .. } = restitution(impacts)?;
        Some(self.scattered((value, variance, square), impacts.len()))
    }

    /// The place of a stop, and half of its interval.
    pub fn place(&self, impacts: &[&Meeting]) -> Option<(f64, f64)> {
        Some(self.scattered(super::meeting::place(impacts)?, impacts.len()))
    }

    /// A value of several impacts, and half of its interval: that of their errors, or wider if they scatter
    /// by more.
    fn scattered(&self, (value, variance, square): (f64, f64, f64), count: usize) -> (f64, f64) {
        let freedom = TRUSTED + count as f64 - 1.0;
        let scatter = (TRUSTED + square / self.variance) / freedom;
        let (value, half) = self.estimate((value, variance));
        match scatter > 1.0 {
            true => (value, half * scatter.sqrt() * (student(freedom as usize) / NORMAL).max(1.0)),
            false => (value, half),
        }
    }

    /// A value, and half of its interval from its variance for errors of variance 1 in the samples.
    fn estimate(&self, (value, variance): (f64, f64)) -> (f64, f64) {
        (value, self.student * (variance * self.variance).sqrt())
    }
}

/// Fits all impacts, which refines their times and places; a contact without a fit is not an impact.
pub fn locate(motion: &Motion, contacts: &mut [Contact]) {
    let mut best: Vec<Option<(f64, Impact)>> = vec![None; contacts.len()];
    for trial in all(motion, contacts, &[], FIRST_TERMS..=FIRST_TERMS) {
        let error = |of: f64| (of * trial.variance).sqrt();
        for (contact, Meeting { t, x, towards, away, of_t, of_x, of_towards, .. }) in trial.impacts {
            let best = &mut best[contact];
            if best.is_none_or(|(least, _)| error(of_towards) < least) {
                let (unsure, jump, speed) = (3.0 * error(of_t), towards + away, Some(towards));
                *best = Some((error(of_towards), Impact { t, x, error: error(of_x), unsure, jump, speed }));
            }
        }
    }
    for (contact, best) in contacts.iter_mut().zip(best) {
        contact.impact = best.map(|(_, impact)| impact);
    }
}

/// The impacts on these stops, fitted over all windows by all degrees.
pub fn trials(motion: &Motion, contacts: &[Contact], stops: &[Stop]) -> Vec<Trial> {
    all(motion, contacts, stops, TERMS)
}

/// Trials over windows up to the usual length of a flight.
fn all(motion: &Motion, contacts: &[Contact], stops: &[Stop], terms: RangeInclusive<usize>) -> Vec<Trial> {
    let longest = |contact: &Contact| {
        let (t, flights) = (contact.impact?.t, &contact.flights);
        let last = flights.end.checked_sub(1).filter(|last| *last >= flights.start)?;
        Some((t - motion.times[flights.start]).max(motion.times[last] - t))
    };
    let Some(widest) = median(contacts.iter().filter_map(longest).collect()) else { return Vec::new() };
    let mut trials = Vec::new();
    let mut width = NARROWEST * motion.timing.step;
    for window in 0.. {
        let sides =
            contacts.iter().enumerate().filter_map(|(k, contact)| Some((k, sides(motion, contact, width)?)));
        let sides: Vec<(usize, Sides)> = sides.collect();
        trials.extend(
            terms.clone().filter_map(|terms| trial(motion, contacts, stops, &sides, (window, terms))),
        );
        if !(width < widest) {
            break;
        }
        width *= WIDER;
    }
    trials
}

fn sides(motion: &Motion, contact: &Contact, width: f64) -> Option<Sides> {
    let Impact { t, unsure, .. } = contact.impact?;
    let from = |t: f64| motion.from(t).clamp(contact.flights.start, contact.flights.end);
    let (before, after) = (from(t - width)..from(t - unsure), from(t + unsure)..from(t + width));
    let enough = before.len().min(after.len()) >= *TERMS.start() && !motion.is_missing(t);
    enough.then(|| Sides { before: motion.fit(before), after: motion.fit(after) })
}

fn trial(
    motion: &Motion,
    contacts: &[Contact],
    stops: &[Stop],
    sides: &[(usize, Sides)],
    setting: Setting,
) -> Option<Trial> {
    let (_, terms) = setting;
    let fit = |(k, sides): &(usize, Sides)| {
        let meeting = sides.meet(motion, terms, contacts[*k].impact?.t, contacts[*k].right)?;
        Some((*k, meeting, sides.rest(terms)?))
    };
    let mut fits: Vec<(usize, Meeting, (f64, usize))> = sides.iter().filter_map(fit).collect();
    let rounding = (ROUNDING * motion.range()).powi(2);
    let (freedom, variance) = loop {
        let before = fits.len();
        let freedom: usize = fits.iter().map(|(_, _, (_, freedom))| freedom).sum();
        let variance = fits.iter().map(|(_, _, (square, _))| square).sum::<f64>() / freedom.max(1) as f64;
        // samples with residuals above four standard deviations belong to other flights
        fits.retain(|(_, _, (square, freedom))| {
            let usual = *freedom as f64 + 4.0 * (2.0 * *freedom as f64).sqrt() + 8.0;
            *square <= usual * variance.max(rounding)
        });
        if fits.len() == before {
            break (freedom, variance);
        }
    };
    let counts = |(k, found, _): &(usize, Meeting, (f64, usize))| {
        let impact = contacts[*k].impact?;
        let error = |of: f64| (of * variance).sqrt();
        let fast = impact.speed.unwrap_or(found.towards) > FAST * error(found.of_towards);
        let near = (found.t - impact.t).abs() < 2.0 * motion.timing.step + 6.0 * error(found.of_t);
        let back = found.towards > 0.0 && found.away > -3.0 * error(found.of_away);
        let on_stop = stops
            .get(contacts[*k].stop)
            .is_none_or(|stop| (found.x - stop.x).abs() < tolerance(motion, error(found.of_x)));
        (fast && near && back && on_stop).then_some((*k, *found))
    };
    let impacts: Vec<(usize, Meeting)> = fits.iter().filter_map(counts).collect();
    let enough = freedom >= LEAST_FREEDOM && !impacts.is_empty();
    enough.then(|| Trial { setting, variance, student: student(freedom), impacts })
}

/// The number that `of` computes from the contacts that count, and their impacts in the trial it is from.
pub fn together(
    trials: &[Trial],
    counts: impl Fn(usize) -> bool,
    of: impl Fn(&Trial, &[&Meeting]) -> Option<(f64, f64)>,
) -> Option<(Choice, Vec<&Meeting>)> {
    let estimate = |trial: &Trial| Some((trial.setting, of(trial, &trial.selected(&counts))?));
    let choice = narrowest(&trials.iter().filter_map(estimate).collect())?;
    let trial = trials.iter().find(|trial| trial.setting == choice.setting)?;
    Some((choice, trial.selected(&counts)))
}

pub fn each(trials: &[Trial], contacts: usize) -> Vec<Single> {
    let mut estimates = vec![Estimates::new(); contacts];
    for trial in trials {
        for (contact, impact) in &trial.impacts {
            estimates[*contact].insert(trial.setting, trial.estimate(impact.ratio()));
        }
    }
    let single = |(contact, estimates): (usize, &Estimates)| {
        let ratio = narrowest(estimates)?;
        let trial = trials.iter().find(|trial| trial.setting == ratio.setting)?;
        let place = trial.impacts.binary_search_by_key(&contact, |(contact, _)| *contact).ok()?;
        let impact = trial.impacts[place].1;
        // errors of the ratio other than noise are attributed to the speeds in the same proportion
        let (_, noise) = trial.estimate(impact.ratio());
        let more = (ratio.half.powi(2) - noise.powi(2)).max(0.0).sqrt() / ratio.value.abs();
        let half =
            |speed: f64, variance: f64| elementary::hypot(trial.estimate((0.0, variance)).1, more * speed);
        let halves = [half(impact.towards, impact.of_towards), half(impact.away, impact.of_away)];
        Some(Single { contact, impact, ratio, halves })
    };
    estimates.iter().enumerate().filter_map(single).collect()
}

/// A setting of the fit: the index of the window, which increases with its width, and the coefficients.
pub type Setting = (usize, usize);

/// Estimates of one number for each setting: the value, and half of the 95 % interval due to noise.
pub type Estimates = BTreeMap<Setting, (f64, f64)>;

/// An estimate and half of its 95 % interval.
#[derive(Debug, Clone, Copy)]
pub struct Choice {
    pub setting: Setting,
    pub value: f64,
    pub half: f64,
}

/// The estimate with the narrowest interval.
///
/// Polynomials with few terms over wide windows have little noise, but may not follow the motion. In that
/// case one more term, one less, or a narrower window gives a different value. The largest difference from
/// these four neighbours (two of them narrower windows) counts as a systematic error, whose square is added
/// to that of the noise. Without noise the interval is the systematic error alone. Differences due to noise
/// make an interval slightly too wide, and choosing the narrowest makes it slightly too narrow; on random
/// records the two effects cancel, which `tests/suite/measured/impacts.rs` checks.
///
/// A setting without a neighbour with fewer terms is not chosen, since nothing shows whether it has enough
/// terms.
pub fn narrowest(estimates: &Estimates) -> Option<Choice> {
    let choice = |(&setting, &(value, noise)): (&Setting, &(f64, f64))| {
        let (window, terms) = setting;
        let apart = |other: Setting| estimates.get(&other).map(|(other, _)| (value - other).abs());
        let fewer = apart((window, terms - 1))?;
        let narrower = |by: usize| (window.wrapping_sub(by), terms);
        let neighbours = [(window, terms + 1), narrower(1), narrower(2)];
        let difference = neighbours.into_iter().filter_map(apart).fold(fewer, f64::max);
        Some(Choice { setting, value, half: elementary::hypot(noise, difference) })
    };
    estimates.iter().filter_map(choice).min_by(|a, b| a.half.total_cmp(&b.half))
}
