//! Damping ratio, decay and frequency from a free decay, over the whole record and over its amplitude.

use std::f64::consts::PI;

use super::clipped::{Clipped, clipped};
use super::outliers::without_outliers;
use super::peaks::{Peak, peaks};
use super::{Identified, Identity, Unidentified, noise, reach, turns, with_interval};
use crate::numeric::regression::{least_squares, student};
use crate::numeric::{Envelope, MIN_TURNS, TurningPoint, elementary, short};
use crate::scene::Channel;
use crate::study::Table;

/// Pieces of the line that is drawn as an envelope.
const ENVELOPE: u32 = 400;

/// Turning points in a row of the table.
const GROUP: usize = 8;

/// Relative change of a number below which there is no remark.
const NEGLIGIBLE: f64 = 1e-3;

/// Smallest height of an oscillation that counts, in multiples of the range of the noise.
const CLEAR: f64 = 1.5;

/// Damping ratio, decay and frequency of a free decay, over the record and as they change with amplitude.
///
/// Each turning point is fitted separately (see `peaks`) and an exponential envelope through them by weighted
/// least squares (see [`Envelope`]), whose rate r is the decay rate of the amplitude. Over half a period of
/// T/2 the amplitude falls by d = r T/2, half the logarithmic decrement, and the damping ratio is
/// d/sqrt(pi^2 + d^2). For an oscillator with mass m and damping coefficient c and a linear force, or one
/// that is linear on each side of a kink at the bottom of the well, r is c/(2 m). The rest position need not
/// be known, and the two sides may have different amplitudes. The period is the slope of a weighted straight
/// line through the times of the turning points, with an offset between maxima and minima. Intervals are
/// 95 %, from the scatter of the turning points about envelope and line.
///
/// The fit begins after the last flat top of a clipped record, otherwise at the largest oscillation.
pub fn damping(times: &[f64], channel: &Channel) -> Result<Identified, Unidentified> {
    let flat = clipped(&channel.values);
    let begin = flat.map_or(0, |flat| flat.last + 1);
    let (times, values, off) = without_outliers(&times[begin..], &channel.values[begin..]);
    let (times, values) = (&times[..], &values[..]);
    let noise = noise(values);
    let back = reach(values, noise);
    let all = turns(values, back);
    let few = |found: usize| match flat {
        None => Unidentified::FewSwings { found, noise: short(noise) },
        Some(Clipped { tops, limit, .. }) => Unidentified::Clipped { tops, limit: short(limit), found },
    };
    let swing = |k: usize| (values[all[k + 1].at] - values[all[k].at]).abs();
    let swings = all.len().saturating_sub(1);
    let largest = (0..swings).rev().max_by(|a, b| swing(*a).total_cmp(&swing(*b))).unwrap_or(0);
    // a swing near the range of the noise may be missed, and its neighbours appear as a long one
    let clear = (largest..swings).take_while(|k| swing(*k) > CLEAR * back).count();
    let turns = &all[largest.min(all.len())..(largest + clear + 1).min(all.len())];
    if turns.len() < MIN_TURNS {
        return Err(few(turns.len()));
    }
    let (peaks, sparse) = peaks(times, values, turns, noise).map_err(|problem| match problem {
        Unidentified::FewSwings { found, .. } => few(found),
        other => other,
    })?;
    let whole = Decay::of(&peaks).filter(|decay| decay.rate.interval.1 > 0.0).ok_or(Unidentified::NoDecay)?;
    let groups = (peaks.len() / GROUP).max(1);
    let group = |i: usize| {
        let end = if i + 1 == groups { peaks.len() } else { (i + 1) * GROUP };
        Decay::of(&peaks[i * GROUP..end])
    };
    let rows: Vec<Decay> = (0..groups).filter_map(group).collect();
    Ok(Identified {
        tolerance: None,
        rows: table(&rows, &format!("amplitude{}", channel.quantity.ending())),
        fitted: whole.lines(),
        summary: vec![whole.ratio, whole.frequency, whole.natural, whole.rate],
        remarks: off.into_iter().chain(remarks(&rows, &whole, channel, times, flat, sparse)).collect(),
    })
}

/// Remarks on the result: where the record was cut, and which numbers change with the amplitude.
fn remarks(
    rows: &[Decay],
    whole: &Decay,
    channel: &Channel,
    times: &[f64],
    flat: Option<Clipped>,
    sparse: Option<f64>,
) -> Vec<String> {
    let (ending, quantity) = (channel.quantity.ending().replace("_per_", "/"), channel.quantity.name());
    let unit = ending.trim_start_matches('_');
    let mut remarks = Vec::new();
    if let Some(Clipped { tops, limit, .. }) = flat {
        let [limit, begin] = [limit, times[0]].map(short);
        remarks.push(format!(
            "clipped: {tops} swings have flat tops, at the limit of the sensor or its converter (the last at \
             {limit} {unit}); what was recorded before {begin} s is left out"
        ));
    }
    if let Some(at) = sparse {
        remarks.push(format!("from {} s on the swings have too few samples and are left out", short(at)));
    }
    if let Some((first, last)) = rows.first().zip(rows.last()) {
        let [from, to] = [first, last].map(|row| short(row.amplitude));
        remarks.push(format!("the rows go from an amplitude of {from} to one of {to} {unit} ({quantity})"));
    }
    let changes = |of: fn(&Decay) -> Identity| differ(rows.iter().map(of), of(whole).value);
    let changing: Vec<&str> = [
        ("the damping ratio", changes(|decay| decay.ratio)),
        ("the frequency", changes(|decay| decay.frequency)),
        ("the decay", changes(|decay| decay.rate)),
    ]
    .into_iter()
    .filter_map(|(name, changes)| changes.then_some(name))
    .collect();
    if let [others @ .., last] = &changing[..] {
        let (names, change, note) = match others {
            [] => ((*last).to_owned(), "changes", "the number for all is a mean over the amplitudes"),
            _ => (
                format!("{} and {last}", others.join(", ")),
                "change",
                "the numbers for all are means over the amplitudes",
            ),
        };
        remarks.push(format!("{names} {change} with the amplitude by more than the intervals: {note}"));
    }
    remarks
}

struct Decay {
    turns: usize,
    span: (f64, f64),
    /// Geometric mean of the amplitudes.
    amplitude: f64,
    ratio: Identity,
    frequency: Identity,
    natural: Identity,
    rate: Identity,
    envelope: Envelope,
}

impl Decay {
    fn of(peaks: &[Peak]) -> Option<Self> {
        let points: Vec<TurningPoint> = peaks.iter().map(|peak| peak.point).collect();
        let envelope = Envelope::fit(&points)?;
        let (slowest, fastest) = envelope.interval(&points);
        let first = &peaks[0];
        let row = |peak: &Peak| {
            let weight = peak.found.1.sqrt();
            let side = if peak.point.maximum { weight } else { -weight };
            ([weight, weight * (peak.number - first.number), side], weight * (peak.found.0 - first.point.t))
        };
        let line = least_squares(&peaks.iter().map(row).collect::<Vec<_>>())?;
        let step = line.coefficients[1];
        if !(step > 0.0) {
            return None;
        }
        let late = student(line.freedom) * line.covariance[(1, 1)].sqrt();
        let of_rate = |rate: f64| match rate * step {
            d if rate.is_finite() => d / elementary::hypot(PI, d),
            _ => rate.signum(),
        };
        let damping = Identity {
            name: "damping_ratio",
            value: of_rate(envelope.rate),
            interval: (of_rate(slowest), of_rate(fastest)),
        };
        // no upper end if the step may be 0
        let highest = if late < step { 0.5 / (step - late) } else { f64::INFINITY };
        let frequency =
            Identity { name: "frequency_hz", value: 0.5 / step, interval: (0.5 / (step + late), highest) };
        let last = points.len() - 1;
        let logarithms: f64 = points.iter().map(|point| elementary::ln(envelope.at(point.t).1)).sum();
        Some(Self {
            turns: points.len(),
            span: (points[0].t, points[last].t),
            amplitude: elementary::exp(logarithms / points.len() as f64),
            ratio: damping,
            natural: natural(frequency, damping),
            frequency,
            rate: Identity { name: "decay_per_s", value: envelope.rate, interval: (slowest, fastest) },
            envelope,
        })
    }

    /// The lines on which the maxima and the minima lie.
    fn lines(&self) -> Table {
        let (from, to) = self.span;
        let place = |i: u32| from + (to - from) * f64::from(i) / f64::from(ENVELOPE);
        let places: Vec<f64> = (0..=ENVELOPE).map(place).collect();
        let line = |side: f64| {
            move |t: &f64| {
                let (centre, swing) = self.envelope.at(*t);
                centre + side * swing
            }
        };
        let table = Table::new().each("t_s", &places, |t| *t);
        table.each("upper", &places, line(1.0)).each("lower", &places, line(-1.0))
    }
}

/// The frequency f without the damping of ratio z, f/sqrt(1 - z^2), with the interval of independent errors.
fn natural(frequency: Identity, damping: Identity) -> Identity {
    let slower = (1.0 - damping.value.powi(2)).sqrt();
    let value = frequency.value / slower;
    // of one end of both intervals
    let error = |f: f64, z: f64| {
        let of_ratio = damping.value / slower.powi(2) * (z - damping.value);
        value * elementary::hypot(f / frequency.value - 1.0, of_ratio)
    };
    let low = error(frequency.interval.0, damping.interval.0);
    let high = error(frequency.interval.1, damping.interval.1);
    Identity { name: "natural_frequency_hz", value, interval: (value - low, value + high) }
}

/// Whether rows differ from the whole record by more than their intervals and a negligible amount.
fn differ(rows: impl ExactSizeIterator<Item = Identity>, whole: f64) -> bool {
    let chance = 1 + rows.len() / 5;
    let apart = |row: &Identity| (row.value - whole).abs() > NEGLIGIBLE * whole.abs();
    // one in twenty rows lies outside by chance
    rows.filter(|row| !(row.interval.0..=row.interval.1).contains(&whole) && apart(row)).count() > chance
}

fn table(rows: &[Decay], amplitude: &str) -> Table {
    let table = Table::new()
        .each("turns", rows, |row| Some(row.turns as u64))
        .each("from_s", rows, |row| row.span.0)
        .each("to_s", rows, |row| row.span.1)
        .each(amplitude, rows, |row| row.amplitude);
    let table = with_interval(table, "damping_ratio", rows, |row| row.ratio);
    let table = with_interval(table, "frequency_hz", rows, |row| row.frequency);
    with_interval(table, "decay_per_s", rows, |row| row.rate)
}
