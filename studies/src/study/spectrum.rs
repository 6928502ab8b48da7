//! Spectrum of a settled motion: amplitude and power spectral density over frequency.
//!
//! A run is sampled evenly over its settled window. With a periodic drive the window has a whole number of
//! forcing periods and, if the motion repeats, of its periods; its spectrum then consists of exact lines and
//! needs no window function. All other motions are weighted by the window function of von Hann.

use serde::{Deserialize, Serialize};

use super::simulate::MAX_SAMPLES;
use super::{Table, Task, Values};
use crate::dynamics::{Model, Outcome, Request, Sample};
use crate::numeric::{Taper, periodogram, short};

words! {
    /// What the spectrum is of.
    Signal {
        /// Displacement relative to the base, m.
        Displacement = "x",
        /// Velocity relative to the base, m/s.
        Velocity = "v",
        /// Acceleration of the base, m/s^2.
        BaseAcceleration = "accel",
    }
}

impl Signal {
    fn of(self, sample: &Sample) -> f64 {
        match self {
            Self::Displacement => sample.x,
            Self::Velocity => sample.v,
            Self::BaseAcceleration => sample.base_accel,
        }
    }
}

/// Options of a spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectrumOptions {
    /// The signal.
    pub signal: Signal,
    /// Window function; by default none if the motion repeats, else that of von Hann.
    pub taper: Option<Taper>,
    /// Samples per second, raised until a forcing period has a whole number of them; by default at least 128
    /// per shortest period of excitation and mechanism, and at least 4096 in total.
    pub rate_hz: Option<f64>,
    /// The run continues until the motion repeats, at most up to this time in s; the last window counts.
    pub until_settled: Option<f64>,
}

/// A spectrum, and how it was computed. SI.
///
/// It is the answer of the question [`Spectrum`](crate::questions::Spectrum); [`table`](Self::table) has its
/// lines, [`describe`](Self::describe) what it was made from in one sentence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spectrum {
    /// `frequency_hz,amplitude,psd`, one-sided, from 0 to half the rate, with one row per line.
    pub(crate) table: Table,
    /// The signal.
    pub signal: Signal,
    /// How the samples were weighted.
    pub taper: Taper,
    /// Number of samples.
    pub samples: usize,
    /// Samples a second.
    pub rate_hz: f64,
    /// Begin and end in s of the part of the run that was sampled.
    pub window: (f64, f64),
    /// Forcing periods in it; 0 where the drive has none.
    pub periods: u64,
    /// Forcing periods after which the motion repeats, where it does.
    pub period: Option<u32>,
    /// Frequencies in Hz of the sines of the drive, those of noise left out.
    pub forcing_hz: Vec<f64>,
}

impl Spectrum {
    /// `frequency_hz,amplitude,psd`, one-sided, from 0 to half the rate, with one row per line.
    pub fn table(&self) -> &Table {
        &self.table
    }

    /// Its settings and samples, in one line.
    pub fn describe(&self) -> String {
        let periods = match self.periods {
            0 => String::new(),
            1 => ", 1 forcing period".to_owned(),
            n => format!(", {n} forcing periods"),
        };
        let repeats = match self.period {
            None => String::new(),
            Some(1) => "; repeats in each".to_owned(),
            Some(n) => format!("; repeats after {n}"),
        };
        let taper = if self.taper == Taper::Hann { "Hann taper" } else { "no taper" };
        let (from, to) = (short(self.window.0), short(self.window.1));
        format!("from {from} to {to} s{periods}{repeats}; {taper}, sampled at {} Hz", short(self.rate_hz))
    }
}

/// Why there is no spectrum.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoSpectrum {
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The run ended at this time in s, before the settled window did, with an outcome of this name.
    #[error("the run ended early at {0} s ({1}), so it has no settled window to take a spectrum of")]
    EndedEarly(f64, &'static str),
    /// The settled window has no length.
    #[error("the settled window from {0} to {1} s has no length: lower run.settle_s")]
    NoWindow(f64, f64),
    /// The rate is not a number above 0, or gives too few or too many samples.
    #[error("{0}")]
    Rate(String),
}

/// Samples in the shortest period of excitation and mechanism.
const PER_CYCLE: f64 = 128.0;

/// Smallest number of samples of a spectrum.
const MIN_SAMPLES: f64 = 4.0;
const DEFAULT_SAMPLES: f64 = 4096.0;

/// The spectrum of the settled motion of `model`, which is run twice: for its verdict and for its samples.
///
/// Frequencies above half the rate are folded back below it, which is negligible in a smooth motion. With
/// impacts the velocity jumps, and amplitudes fall only like 1/f, those of the displacement like 1/f^2.
pub fn spectrum(model: &Model, options: &SpectrumOptions, task: &Task) -> Result<Spectrum, NoSpectrum> {
    let request =
        Request { cancel: Some(task.cancel), until_settled: options.until_settled, ..Request::default() };
    let summary = model.run(&request).summary;
    ended(summary.outcome)?;
    (task.tick)();
    let period = summary.period;
    let taper = options.taper.unwrap_or(if period.is_some() { Taper::None } else { Taper::Hann });
    let plan = Plan::new(model, summary.window, summary.periods, period, options.rate_hz)?;
    let times: Vec<f64> = (0..plan.samples).map(|k| plan.time(k)).collect();
    let run = model.run(&Request { sample_times: &times, ..request });
    ended(run.summary.outcome)?;
    (task.tick)();
    let values: Vec<f64> = run.samples.iter().map(|sample| options.signal.of(sample)).collect();
    let lines = periodogram(values, 1.0 / plan.rate_hz(), taper);
    let frequencies = (0..lines.amplitude.len()).map(|k| plan.frequency(k)).collect();
    let table = Table::new()
        .with("frequency_hz", Values::Numbers(frequencies))
        .with("amplitude", Values::Numbers(lines.amplitude))
        .with("psd", Values::Numbers(lines.density));
    let tones = model.excitation().tones.iter().filter(|tone| !tone.noise);
    Ok(Spectrum {
        table,
        signal: options.signal,
        taper,
        samples: plan.samples,
        rate_hz: plan.rate_hz(),
        window: (plan.from, plan.to),
        periods: plan.periods,
        period,
        forcing_hz: tones.map(|tone| tone.frequency).collect(),
    })
}

fn ended(outcome: Outcome) -> Result<(), NoSpectrum> {
    match outcome.ended_at() {
        None => Ok(()),
        Some(_) if matches!(outcome, Outcome::Cancelled { .. }) => Err(NoSpectrum::Cancelled),
        Some(at) => Err(NoSpectrum::EndedEarly(at, outcome.name())),
    }
}

/// When to sample: evenly from `from` on, the last time a step before `to`. SI.
struct Plan {
    from: f64,
    to: f64,
    samples: usize,
    /// Forcing periods in it; 0 where there are none.
    periods: u64,
    /// A frequency in Hz and its number of cycles in the window, or 1 Hz and the length in s: the frequencies
    /// of the lines are multiples of their quotient, rounded once.
    cycles: (f64, f64),
}

impl Plan {
    /// The plan of a window of `periods` forcing periods; the motion repeats after `repeats` of them.
    fn new(
        model: &Model,
        (from, to): (f64, f64),
        periods: u64,
        repeats: Option<u32>,
        rate_hz: Option<f64>,
    ) -> Result<Self, NoSpectrum> {
        if !(to > from) {
            return Err(NoSpectrum::NoWindow(from, to));
        }
        let forcing = model.forcing_period().filter(|_| periods > 0);
        let lap = u64::from(repeats.unwrap_or(1));
        let whole = forcing.map(|period| (period, periods / lap * lap)).filter(|(_, count)| *count > 0);
        let (from, parts) = match whole {
            Some((period, count)) => (from + (periods - count) as f64 * period, count as f64),
            None => (from, 1.0),
        };
        let length = whole.map_or(to - from, |(period, count)| period * count as f64);
        let rate = rate_hz.unwrap_or_else(|| (PER_CYCLE / shortest(model)).max(DEFAULT_SAMPLES / length));
        // a decimal rate may miss a whole number only by its rounding
        let least = (length / parts * rate - 1e-9).ceil().max(1.0);
        // transforms of a power of two are fastest
        let each = match rate_hz.is_some() || least > MAX_SAMPLES as f64 {
            true => least,
            false => (least as u64).next_power_of_two() as f64,
        };
        let samples = each * parts;
        if !(rate > 0.0 && (MIN_SAMPLES..=MAX_SAMPLES as f64).contains(&samples)) {
            let remedy = if samples > MAX_SAMPLES as f64 {
                format!("at most {MAX_SAMPLES} fit; take a lower rate or a shorter window")
            } else {
                format!("take at least {}", short(MIN_SAMPLES / length))
            };
            return Err(NoSpectrum::Rate(format!(
                "{rate} samples a second make {} in the {length} s of the settled window: {remedy}",
                short(samples)
            )));
        }
        let cycles = match (whole, model.excitation().fastest()) {
            (Some((period, count)), Some(fastest)) => (fastest, (period * fastest).round() * count as f64),
            _ => (1.0, length),
        };
        let periods = whole.map_or(0, |(_, count)| count);
        Ok(Self { from, to, samples: samples as usize, periods, cycles })
    }

    fn rate_hz(&self) -> f64 {
        self.samples as f64 / (self.cycles.1 / self.cycles.0)
    }

    fn time(&self, k: usize) -> f64 {
        (self.from + k as f64 * self.cycles.1 / (self.cycles.0 * self.samples as f64)).min(self.to)
    }

    fn frequency(&self, k: usize) -> f64 {
        k as f64 * self.cycles.0 / self.cycles.1
    }
}

/// The shortest period in s of the excitation and of small oscillations in a well.
fn shortest(model: &Model) -> f64 {
    let drive = model.excitation();
    let tones = drive.tones.iter().map(|tone| tone.frequency);
    let chirps = drive.chirps.iter().map(|chirp| chirp.from.max(chirp.to));
    let fastest = tones.chain(chirps).map(|frequency| 1.0 / frequency);
    fastest.fold(model.characteristic_time().min(model.natural_time()), f64::min)
}
