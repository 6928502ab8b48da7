//! Spectrum of a settled motion: amplitude and power spectral density over frequency.
//!
//! A run is sampled evenly over its settled window. With a periodic drive the window has a whole number of
//! forcing periods and, if the motion repeats, of its periods; its spectrum then consists of exact lines and
//! needs no window function. All other motions are weighted by the window function of von Hann.

mod chart;

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::dynamics::{Model, Outcome, Request, Sample};
use crate::numeric::{Taper, number_text, periodogram, short};
use crate::output::{NoPicture, Ranges};
use crate::questions::{Error, Progress, Simulation, check_until};
use crate::scene::Document;
use crate::simulate::MAX_SAMPLES;
use crate::study::{Answered, Grid, Heading, PICTURE, Scenes, Study, Table, Task, Values, number};
pub use chart::{SpectrumQuantity, spectrum_chart};

/// Amplitude and power spectral density of the settled motion over frequency.
///
/// # Method
///
/// The settled window is sampled evenly, over whole periods where the drive repeats. Where the motion
/// repeats too, its lines are exact and no window function is needed; otherwise that of von Hann is taken,
/// and amplitude and density are scaled as in Heinzel et al. (2002). Components above half the rate fold
/// back: a higher `rate_hz` reduces this, which matters with impacts. Two runs are made, one for the verdict
/// and one for the samples.
///
/// # Errors
///
/// [`Error::Argument`] for `rate_hz` (at most 1e7 samples) or `until_settled`; [`Error::Unfit`] if
/// the settled window has no length; [`Error::Failed`] if the run ends early.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Progress, Signal, Simulation, Spectrum};
///
/// // The base moves with one sine of 1.5 g at 3 Hz.
/// let question = Spectrum { of: Signal::BaseAcceleration, ..Spectrum::default() };
/// let answer = question.run(&Simulation::preset("nominal-cubic")?, &Progress::none())?;
/// let table = answer.table();
/// let frequencies = table.numbers("frequency_hz").unwrap();
/// let line = frequencies.iter().position(|frequency| (frequency - 3.0).abs() < 1e-9).unwrap();
/// assert!((table.numbers("amplitude").unwrap()[line] - 1.5 * 9.806_65).abs() < 1e-9);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Spectrum {
    /// Signal
    #[arg(long, value_name = "SIGNAL", default_value = "x")]
    pub of: Signal,
    /// Weights of the samples
    #[arg(long, value_name = "TAPER", default_value = "auto")]
    pub taper: Weights,
    /// Samples a second, increased until a forcing period has a whole number of them [default: 128 or more
    /// in the shortest period of excitation and mechanism]
    #[arg(long, value_name = "HZ", allow_hyphen_values = true)]
    #[arg(value_parser = number(RATE))]
    pub rate_hz: Option<f64>,
    /// Follow the motion, window after window, until it repeats, or up to this time in s; the spectrum is of
    /// the last window. Needs a drive that repeats
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    #[arg(value_parser = number("not a time; give seconds, such as 300"))]
    pub until_settled: Option<f64>,
    /// With a picture: the column that is shown
    #[arg(long, value_name = "COLUMN", default_value = "amplitude")]
    #[arg(requires = "plot", help_heading = PICTURE)]
    #[serde(skip)]
    pub quantity: SpectrumQuantity,
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless spectrum paper --out lines.csv --plot lines.png
  interwell --headless spectrum duffing-chaos --of v --plot chaos.png --quantity psd --plot-x 0:1
  interwell --headless spectrum paper-unconstrained --set excitation.amplitude_g=1.2 --until-settled 300
  interwell --headless spectrum random-shaking --of accel --taper none --rate-hz 4096

Frequencies above half the rate are folded back below it; impacts excite all frequencies, so compare with a
higher --rate-hz.";

const RATE: &str = "give a number of samples a second above 0, such as 2048";

words! {
    /// Weights of the samples.
    Weights {
        /// None where the motion repeats, whose samples are whole periods of it so that its lines are exact,
        /// and those of von Hann elsewhere.
        Auto = "auto",
        /// Those of von Hann.
        Hann = "hann",
        /// None.
        None = "none",
    }
}

impl Default for Spectrum {
    fn default() -> Self {
        let (of, taper, quantity) = (Signal::Displacement, Weights::Auto, SpectrumQuantity::Amplitude);
        Self { of, taper, rate_hz: None, until_settled: None, quantity }
    }
}

impl Study for Spectrum {
    const NAME: &'static str = "spectrum";
    const PARTS: &'static str = "runs";
    const GRID: bool = false;
    const PYTHON: &'static str = "\
>>> table = scene.spectrum(\"accel\")
>>> table[\"amplitude\"][table[\"frequency_hz\"] == 3.0].round(6)
array([14.709975])";

    fn check(&self, _: &Scenes) -> Result<(), Error> {
        match self.rate_hz {
            Some(rate) if !(rate > 0.0) => Err(Error::number("rate_hz", rate, RATE)),
            _ => Ok(()),
        }
    }

    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let found = self.of_model(&scenes.model()?, scenes.document, progress)?;
        let answer = Answered::new(found.table().clone()).told([found.describe()]);
        let study = self.clone();
        Ok(answer.drawn(move |_, framing| {
            let quantity = match framing.quantity {
                None => study.quantity,
                Some(word) => SpectrumQuantity::named(word)
                    .ok_or_else(|| Error::argument("quantity", word, "give amplitude or psd"))?,
            };
            study.check_ranges(&framing.ranges)?;
            Ok(spectrum_chart(&found, quantity, framing.ranges))
        }))
    }

    fn can_draw(&self, _: &Grid) -> Result<(), NoPicture> {
        Ok(())
    }

    fn check_ranges(&self, ranges: &Ranges) -> Result<(), Error> {
        match ranges.y {
            Some((low, high)) if !(low > 0.0) => {
                let problem = "the axis is logarithmic; give two numbers above 0, such as 1e-9:1e-2";
                Err(Error::argument("plot_y", format!("{low}:{high}"), problem))
            }
            _ => Ok(()),
        }
    }

    fn columns() -> Vec<Vec<Heading>> {
        Vec::new()
    }
}

impl Spectrum {
    /// Runs the scene and transforms its settled window.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<SpectrumAnswer, Error> {
        self.of_model(simulation.model(), simulation.document(), progress)
    }

    fn of_model(
        &self,
        model: &Model,
        document: &Document,
        progress: &Progress,
    ) -> Result<SpectrumAnswer, Error> {
        check_until(self.until_settled, document, model)?;
        let (rate_hz, until_settled) = (self.rate_hz, self.until_settled);
        let taper = match self.taper {
            Weights::Auto => None,
            Weights::Hann => Some(Taper::Hann),
            Weights::None => Some(Taper::None),
        };
        let options = SpectrumOptions { signal: self.of, taper, rate_hz, until_settled };
        spectrum(model, &options, &progress.silent()).map_err(|problem| match problem {
            NoSpectrum::Cancelled => Error::Cancelled,
            NoSpectrum::EndedEarly { .. } => Error::failed(document, problem),
            NoSpectrum::NoWindow(..) => Error::unfit(document, problem),
            NoSpectrum::Rate(_) => {
                let given = rate_hz.map_or_else(|| "(default)".to_owned(), number_text);
                Error::argument("rate_hz", given, format!("{}: {problem}", document.name))
            }
        })
    }
}

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
/// It is the answer of [`Spectrum`]; [`table`](Self::table) has its
/// lines, [`describe`](Self::describe) what it was made from in one sentence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpectrumAnswer {
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

impl SpectrumAnswer {
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
pub fn spectrum(model: &Model, options: &SpectrumOptions, task: &Task) -> Result<SpectrumAnswer, NoSpectrum> {
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
    Ok(SpectrumAnswer {
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
