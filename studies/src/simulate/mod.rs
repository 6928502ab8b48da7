//! One run: its sample times, samples, events and summary, and remedies for a run that ended early.

mod chart;
mod picture;
mod trace;

use std::sync::atomic::AtomicBool;

use crate::dynamics::{Event, Model, Outcome, Output, Request, Sample, Summary};
use crate::numeric::{Decimal, greatest_common_divisor, short};
use crate::scene::{Excitation, Harmonic, Scene, TOLERANCES};
use crate::study::{Table, named};
pub use chart::{RunPanel, run_chart};
pub use picture::RunPicture;
pub use trace::{Trace, between, simulate_with_trace};

/// When to sample.
///
/// At most 1e7 samples fit. They are read off the integrator's polynomials and have no influence on its
/// steps, so that a coarse sampling is as accurate as a fine one. At the instant of an event the state is
/// that after it.
#[derive(Debug, Clone, PartialEq)]
pub enum Sampling {
    /// Steps of a 60th of the forcing period or, without one, of a thousandth of the duration.
    Default,
    /// Steps of this length in s.
    Every(f64),
    /// These times in s, in any order; the rows have the same order.
    At(Vec<f64>),
}

/// What to keep of a run besides its summary.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Keep {
    /// Sample times in s, in the order of the rows.
    pub times: Vec<f64>,
    /// Whether to keep the events.
    pub events: bool,
    /// The run continues until the motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
}

/// One run with its samples and events, in SI units.
///
/// The tables have one row per sample and per event; [`summary`](Self::summary) is that of the whole run,
/// whatever was sampled.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// `t_s,x_m,v_m_per_s,base_accel_m_per_s2,phase`, with a transducer also `voltage_v,current_a,power_w`.
    pub samples: Table,
    /// `t_s,kind,side,v_in_m_per_s,v_out_m_per_s` in order of time.
    pub events: Table,
    /// Statistics, outcome and energy ledger.
    pub summary: Summary,
}

/// The sample times in s of this run, up to the latest time at which it may end.
pub fn sample_times(
    scene: &Scene,
    model: &Model,
    sampling: &Sampling,
    until_settled: Option<f64>,
) -> Result<Vec<f64>, TimesError> {
    let duration = until_settled.unwrap_or(model.duration());
    let step = match sampling {
        Sampling::At(times) => return listed_times(times, duration),
        Sampling::Every(dt) => SamplingStep::part(*dt, 1),
        Sampling::Default => match (scene.harmonic(), &scene.excitation, model.forcing_period()) {
            (Some(Harmonic { frequency_hz, .. }), ..)
            | (_, &Excitation::AmplitudeRamp { frequency_hz, .. }, _) => {
                SamplingStep::period_of(frequency_hz)
            }
            (_, _, Some(period)) => SamplingStep::part(period, 60),
            _ => SamplingStep::part(duration, 1000),
        },
    };
    even_times(step, duration)
}

/// Runs `model` once. If another thread sets `cancel`, the run ends early with the outcome `Cancelled`.
pub fn simulate(model: &Model, keep: &Keep, cancel: Option<&AtomicBool>) -> Recorded {
    let ascending = keep.times.is_sorted();
    let mut sorted = Vec::new();
    if !ascending {
        sorted.clone_from(&keep.times);
        sorted.sort_by(f64::total_cmp);
    }
    let sample_times = if ascending { &keep.times } else { &sorted };
    let request = Request { sample_times, events: keep.events, cancel, ..Request::default() };
    let run = model.run(&Request { ledger: true, until_settled: keep.until_settled, ..request });
    let samples = if ascending { run.samples } else { in_order(&keep.times, &run.samples) };
    Recorded {
        samples: samples_table(&samples, |sample| model.output(sample)),
        events: events_table(&run.events),
        summary: run.summary,
    }
}

/// The samples in the order of `times`; times after an early end of the run are left out.
fn in_order(times: &[f64], samples: &[Sample]) -> Vec<Sample> {
    let find = |t: &f64| {
        let at = samples.partition_point(|sample| sample.t < *t);
        samples.get(at).filter(|sample| sample.t == *t).copied()
    };
    times.iter().filter_map(find).collect()
}

/// Samples as the table of [`Recorded::samples`]; an `output` of a transducer may be missing.
pub fn samples_table(samples: &[Sample], output: impl Fn(&Sample) -> Option<Output>) -> Table {
    let table = Table::new()
        .each("t_s", samples, |sample| sample.t)
        .each("x_m", samples, |sample| sample.x)
        .each("v_m_per_s", samples, |sample| sample.v)
        .each("base_accel_m_per_s2", samples, |sample| sample.base_accel)
        .each("phase", samples, |sample| sample.phase.name());
    if samples.iter().all(|sample| output(sample).is_none()) {
        return table;
    }
    let outputs: Vec<Option<Output>> = samples.iter().map(output).collect();
    let column = |of: fn(&Output) -> f64| move |output: &Option<Output>| output.as_ref().map(of);
    table
        .each("voltage_v", &outputs, column(|output| output.voltage))
        .each("current_a", &outputs, column(|output| output.current))
        .each("power_w", &outputs, column(|output| output.power))
}

/// Events as a table, one row per event: `t_s,kind,side,v_in_m_per_s,v_out_m_per_s`, SI.
pub fn events_table(events: &[Event]) -> Table {
    Table::new()
        .each("t_s", events, |event| event.t)
        .each("kind", events, |event| event.kind.name())
        .each("side", events, |event| event.side.name())
        .each("v_in_m_per_s", events, |event| event.v_in)
        .each("v_out_m_per_s", events, |event| event.v_out)
}

/// Ratio of the time scale of the motion to a contact with a compliant stop above which the contact is short.
const SHORT: f64 = 100.0;

/// A clause on how to make a run of `model` with this outcome last longer or be more accurate; `None` if the
/// run was completed or cancelled, or if the outcome itself names the remedy.
pub fn ended_remedy(model: &Model, outcome: Outcome) -> Option<String> {
    let tolerance = model.tolerance();
    let remedy = match outcome {
        Outcome::StepBudget { at, .. } => short_contact(model).unwrap_or_else(|| fewer_steps(model, at)),
        Outcome::Inaccurate { .. } if tolerance > TOLERANCES.0 => "use a smaller tolerance".to_owned(),
        Outcome::Inaccurate { .. } => {
            format!("{tolerance:e} is the smallest tolerance, so the cause lies elsewhere")
        }
        Outcome::NotFinite { .. } => match model.stops() {
            None => "stops, or a force that holds the mass, keep the motion within bounds".to_owned(),
            Some(_) => "smaller numbers in the scene (stiffness, amplitude, speed) keep it finite".to_owned(),
        },
        Outcome::Done
        | Outcome::LeftTable { .. }
        | Outcome::ImpactBudget { .. }
        | Outcome::Cancelled { .. } => return None,
    };
    Some(model.fast_circuit().unwrap_or(remedy))
}

/// A clause on how to keep a run within its step budget, which it used up at `at` in s: a shorter run, a
/// larger tolerance if that saves steps, or fewer noise lines if these cause most of the work.
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

/// A clause on short steps due to stops so stiff that a contact is much shorter than the motion.
fn short_contact(model: &Model) -> Option<String> {
    let (speed, time) = (model.scales().speed, model.scales().time);
    let contact = model.compliant()?.contact_time(model.mass(), speed);
    let [lasts, at, motion] = [contact, speed, time].map(short);
    (contact * SHORT < time).then(|| {
        format!(
            "a contact with a stop lasts {lasts} s at {at} m/s and takes steps of its own, where the motion \
             takes {motion} s; softer stops, rigid ones (`Rigid`) or a shorter run take fewer"
        )
    })
}

/// Largest number of samples of one run, which take 1 GB of memory.
pub(crate) const MAX_SAMPLES: u64 = 10_000_000;

/// Why a run cannot be sampled as requested.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TimesError {
    /// The step is not a number above 0.
    #[error("the sampling step is {0} s: it must be a finite number above 0")]
    SamplingStep(f64),
    /// A step in s over a duration in s makes too many samples, rounded where they are above 2^53.
    #[error(
        "a step of {0} s over {1} s makes {2} samples; at most {MAX_SAMPLES} fit: \
         take a longer step ({dt}) or name the times ({at})",
        dt = named!("dt"),
        at = named!("at")
    )]
    TooMany(f64, f64, String),
    /// A time in s beyond the duration of the run.
    #[error("{at} {0} is not within the run, which lasts from 0 to {1} s", at = named!("at"))]
    Outside(f64, f64),
}

impl TimesError {
    /// The argument that is wrong.
    pub fn argument(&self) -> &'static str {
        match self {
            Self::SamplingStep(_) | Self::TooMany(..) => "dt",
            Self::Outside(..) => "at",
        }
    }

    /// Its value.
    pub fn value(&self) -> f64 {
        match self {
            Self::SamplingStep(value) | Self::TooMany(value, ..) | Self::Outside(value, _) => *value,
        }
    }
}

/// A positive rational number: the exact value of a decimal, or a fraction of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fraction {
    numerator: u128,
    denominator: u128,
}

impl Fraction {
    /// Whole numbers below this are exact as doubles.
    const EXACT: u128 = 1 << 53;

    /// The shortest decimal that identifies `value`; `None` if it is not above 0 or has more than 38 digits.
    fn decimal(value: f64) -> Option<Self> {
        let Decimal { digits, exponent } = Decimal::shortest(value).filter(|decimal| decimal.digits > 0)?;
        let digits = digits.unsigned_abs();
        let power = 10_u128.checked_pow(exponent.unsigned_abs())?;
        Some(if exponent >= 0 {
            Self { numerator: digits.checked_mul(power)?, denominator: 1 }
        } else {
            Self { numerator: digits, denominator: power }
        })
    }

    fn over(self, n: u128) -> Option<Self> {
        Some(Self { numerator: self.numerator, denominator: self.denominator.checked_mul(n)? })
    }

    fn inverse(self) -> Self {
        Self { numerator: self.denominator, denominator: self.numerator }
    }

    /// Its numerator and denominator, if they and `most` times the numerator are exact as doubles.
    fn doubles(self, most: u64) -> Option<(f64, f64)> {
        let product = self.numerator.checked_mul(u128::from(most))?;
        let exact = [self.numerator, product, self.denominator].iter().all(|part| *part < Self::EXACT);
        exact.then_some((self.numerator as f64, self.denominator as f64))
    }

    /// The double nearest to `k` times this.
    fn times(self, k: u64) -> f64 {
        let Some(mut numerator) = self.numerator.checked_mul(u128::from(k)) else {
            return self.times(1) * k as f64;
        };
        let mut denominator = self.denominator;
        if numerator >= Self::EXACT || denominator >= Self::EXACT {
            let divisor = greatest_common_divisor(numerator, denominator);
            (numerator, denominator) = (numerator / divisor, denominator / divisor);
        }
        // if both are exact, a single division is correctly rounded; otherwise the parser rounds correctly if
        // the denominator is a power of ten, and else the error is at most two units in the last place
        if (numerator >= Self::EXACT || denominator >= Self::EXACT) && denominator.is_multiple_of(10) {
            let zeros = denominator.ilog10();
            if 10_u128.checked_pow(zeros) == Some(denominator) {
                return format!("{numerator}e-{zeros}").parse().unwrap_or(f64::NAN);
            }
        }
        numerator as f64 / denominator as f64
    }

    fn fits_into(self, whole: Self) -> Option<u64> {
        let above = whole.numerator.checked_mul(self.denominator)?;
        let below = whole.denominator.checked_mul(self.numerator)?;
        u64::try_from(above / below).ok()
    }
}

/// The step between even samples: in s, and its exact value where that is known.
#[derive(Clone, Copy)]
struct SamplingStep {
    seconds: f64,
    exact: Option<Fraction>,
}

impl SamplingStep {
    /// One of `parts` equal parts of a number of seconds.
    fn part(seconds: f64, parts: u32) -> Self {
        let exact = Fraction::decimal(seconds).and_then(|whole| whole.over(parts.into()));
        Self { seconds: seconds / f64::from(parts), exact }
    }

    /// A 60th of the period of a frequency in Hz.
    fn period_of(frequency: f64) -> Self {
        let exact = Fraction::decimal(frequency).and_then(|frequency| frequency.inverse().over(60));
        Self { seconds: 1.0 / (60.0 * frequency), exact }
    }
}

/// The times 0, dt, 2 dt, .. up to `duration` in s, including `duration` if it is a multiple of the step.
///
/// A step is taken as a decimal: 0.1 gives 0.1, 0.2, 0.3 and not 0.30000000000000004, and a 60th of a forcing
/// period of 1/3 s gives the doubles nearest to k/180. So the times ascend and none exceeds `duration`.
fn even_times(step: SamplingStep, duration: f64) -> Result<Vec<f64>, TimesError> {
    let SamplingStep { seconds: dt, exact } = step;
    if !(dt.is_finite() && dt > 0.0) {
        return Err(TimesError::SamplingStep(dt));
    }
    let count = exact
        .and_then(|ratio| ratio.fits_into(Fraction::decimal(duration)?))
        .map_or_else(|| (duration / dt * (1.0 + 4.0 * f64::EPSILON)).floor(), |fits| fits as f64)
        + 1.0;
    if count > MAX_SAMPLES as f64 {
        let count = if count < 9e15 { format!("{count}") } else { format!("{count:.3e}") };
        return Err(TimesError::TooMany(dt, duration, count));
    }
    if let Some((numerator, denominator)) = exact.and_then(|ratio| ratio.doubles(count as u64)) {
        // as `times` has it, without whole numbers of 128 bits
        let time = |k: u32| (f64::from(k) * numerator / denominator).min(duration);
        return Ok((0..count as u32).map(time).collect());
    }
    let time = |k: u64| exact.map_or(k as f64 * dt, |ratio| ratio.times(k)).min(duration);
    Ok((0..count as u64).map(time).collect())
}

/// The given times, checked to lie within 0..=`duration`; -0 becomes 0.
fn listed_times(times: &[f64], duration: f64) -> Result<Vec<f64>, TimesError> {
    match times.iter().find(|t| !(**t >= 0.0 && **t <= duration)) {
        Some(time) => Err(TimesError::Outside(*time, duration)),
        None => Ok(times.iter().map(|t| t + 0.0).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_exact_in_decimals() {
        let times = even_times(SamplingStep::part(0.1, 1), 1.0).unwrap();
        assert_eq!(times, [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        let times = even_times(SamplingStep::period_of(3.0), 10.0).unwrap();
        assert_eq!(times.len(), 1801);
        assert!(times.iter().enumerate().all(|(k, t)| *t == k as f64 / 180.0));
        assert_eq!(times[1800], 10.0);
        let times = even_times(SamplingStep::period_of(2.7), 10.0).unwrap();
        assert!(times.iter().enumerate().all(|(k, t)| *t == (k * 10) as f64 / 1620.0));
        assert_eq!(even_times(SamplingStep::part(0.3, 1000), 0.3).unwrap()[999], 0.2997);
        assert_eq!(even_times(SamplingStep::part(1e-9, 1), 1e-9).unwrap(), [0.0, 1e-9]);
        assert_eq!(even_times(SamplingStep::part(2.0, 1), 1.0).unwrap(), [0.0]);
        let times = even_times(SamplingStep::part(0.3, 1), 1.0).unwrap();
        assert_eq!(times, [0.0, 0.3, 0.6, 0.9]);
    }

    #[test]
    fn times_of_doubles_are_those_of_whole_numbers() {
        for step in
            [SamplingStep::period_of(3.0), SamplingStep::period_of(2.7), SamplingStep::part(0.3, 1000)]
        {
            let (ratio, times) = (step.exact.unwrap(), even_times(step, 10.0).unwrap());
            assert!(ratio.doubles(times.len() as u64).is_some());
            assert!((0..).zip(&times).all(|(k, time)| *time == ratio.times(k).min(10.0)));
        }
        let long = Fraction { numerator: 1 << 40, denominator: 3 };
        assert_eq!(long.doubles(1 << 12).map(|found| found.0), Some(1.099_511_627_776e12));
        assert_eq!(long.doubles(1 << 13), None);
    }

    #[test]
    fn times_ascend_and_stay_within_the_run() {
        for (dt, duration) in [(1.0 / 3.0, 1.0), (1e-300, 5e-299), (0.123456789012345, 1e3), (7e290, 1e300)] {
            let times = even_times(SamplingStep::part(dt, 1), duration);
            let Ok(times) = times else { continue };
            assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{dt} {duration}");
            assert!(times.last().is_some_and(|t| *t <= duration));
        }
    }

    #[test]
    fn too_many_samples_are_counted_not_made() {
        let error = even_times(SamplingStep::period_of(3.0), 1e9).unwrap_err();
        assert!(error.to_string().contains("180000000001"), "{error}");
        let error = even_times(SamplingStep::part(1e-300, 1), 1e9).unwrap_err();
        assert!(matches!(error, TimesError::TooMany { .. }), "{error}");
        for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(even_times(SamplingStep::part(dt, 1), 1.0), Err(TimesError::SamplingStep(_))));
        }
    }

    #[test]
    fn listed_times_lie_within_the_run() {
        assert_eq!(listed_times(&[1.0, 0.0, -0.0], 1.0).unwrap(), [1.0, 0.0, 0.0]);
        for time in [-1e-9, 1.000001, f64::NAN, f64::INFINITY] {
            assert!(listed_times(&[0.5, time], 1.0).is_err());
        }
    }
}
