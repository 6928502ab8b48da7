//! Periodic drives that a program gives, as a function or as samples: a sum of harmonics in a scene.

use std::f64::consts::TAU;

use super::data::Excitation;
use super::unit::STANDARD_GRAVITY;
use crate::numeric::{TrigonometricPolynomial, elementary, number_text};

/// Smallest and largest tolerance of [`Excitation::from_fn`].
const TOLERANCES: (f64, f64) = (1e-12, 0.1);

/// Smallest and largest frequency of the drive in Hz.
const FREQUENCIES: (f64, f64) = (1e-12, 1e12);

/// Decimal digits of the frequency. With more, its multiples as numbers of 64 bits would have no common
/// period.
const FREQUENCY_DIGITS: usize = 11;

/// Largest number of samples of a period; half as many harmonics come out.
const MAX_SAMPLES: usize = 4096;

/// Samples of a function at first.
const FIRST_SAMPLES: usize = 32;

/// Places at which the harmonics are compared with a function, in each interval between samples. They are not
/// evenly spaced: at even places a harmonic of a high multiple of the frequency looks like a constant.
const CHECKS: usize = 3;

/// Steps between those places, as shares of an interval without its whole part: the golden ratio.
const UNEVEN: f64 = 0.618_033_988_749_894_8;

/// Share of the tolerance up to which the smallest harmonics may be left out.
const LEFT_OUT: f64 = 0.25;

/// Share of the largest value below which a harmonic of samples is rounding.
const ROUNDING: f64 = 1e-15;

/// Why a function or samples give no drive; the error of [`Excitation::from_fn`] and
/// [`Excitation::from_samples`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DriveError {
    /// The frequency is out of its range.
    #[error(
        "the frequency is {0} Hz; give {low:e} to {high:e} Hz, one over the period",
        low = FREQUENCIES.0,
        high = FREQUENCIES.1
    )]
    Frequency(f64),
    /// The frequency has too many digits.
    #[error(
        "the frequency {0} Hz has more than {FREQUENCY_DIGITS} digits, so that its harmonics have no exact \
         common period; give {1} Hz"
    )]
    Digits(f64, String),
    /// The tolerance is out of its range.
    #[error(
        "the tolerance is {0}; give {low:e} to {high:e}, relative to the largest acceleration",
        low = TOLERANCES.0,
        high = TOLERANCES.1
    )]
    Tolerance(f64),
    /// An acceleration is not finite.
    #[error("the acceleration at t = {0} s is {1}; it must be finite over the whole period")]
    NotFinite(f64, f64),
    /// An acceleration is larger than a scene can have.
    #[error("the acceleration at t = {0} s is {1} m/s^2; give at most 1e30 m/s^2")]
    TooLarge(f64, f64),
    /// The number of samples is out of its range.
    #[error("there are {0} samples of the period; give 1 to {MAX_SAMPLES}, evenly spaced, without its end")]
    Samples(usize),
    /// The function has a jump or sharp corners.
    #[error(
        "{harmonics} harmonics differ from the acceleration by {1:.1e} of its largest value, at t = {0} s; \
         give a larger tolerance, or for a drive with jumps a record (Recorded)",
        harmonics = MAX_SAMPLES / 2
    )]
    Unresolved(f64, f64),
}

/// A periodic drive as a sum of harmonics; `questions::Simulation::with_drive` takes its
/// [`excitation`](Self::excitation).
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicDrive {
    /// The sum.
    pub excitation: Excitation,
    /// The largest difference from the function that was found, in m/s^2; 0 for samples, which it has to
    /// rounding.
    pub error: f64,
}

impl Excitation {
    /// A drive with the period 1/`frequency_hz` from a function: the acceleration in m/s^2 at a time in s, of
    /// which the period from 0 on is used.
    ///
    /// The drive is a sum of sines, the trigonometric interpolation of up to 4096 samples. At the samples and
    /// at three places between any two of them it differs from the function by at most `tolerance` (1e-12 to
    /// 0.1) times the largest acceleration. Each sine adds to the time of a run; a smooth drive needs few.
    /// The frequency has at most 11 digits.
    ///
    /// ```
    /// use interwell_kernel::scene::Excitation;
    ///
    /// let pulse = |t: f64| 20.0 * (8.0 * ((std::f64::consts::TAU * 3.0 * t).cos() - 1.0)).exp();
    /// let drive = Excitation::from_fn(pulse, 3.0, 1e-6)?;
    /// assert!(drive.error <= 20.0 * 1e-6);
    /// # Ok::<(), interwell_kernel::scene::DriveError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`DriveError::Frequency`], [`DriveError::Digits`] and [`DriveError::Tolerance`] for these numbers,
    /// [`DriveError::NotFinite`] and [`DriveError::TooLarge`] for a value of the function, and
    /// [`DriveError::Unresolved`] for a function with jumps or corners that 4096 samples do not resolve.
    pub fn from_fn(
        acceleration: impl Fn(f64) -> f64,
        frequency_hz: f64,
        tolerance: f64,
    ) -> Result<PeriodicDrive, DriveError> {
        check_frequency(frequency_hz)?;
        if !(TOLERANCES.0 <= tolerance && tolerance <= TOLERANCES.1) {
            return Err(DriveError::Tolerance(tolerance));
        }
        let at = |share: f64| finite(share / frequency_hz, acceleration(share / frequency_hz));
        let mut samples = FIRST_SAMPLES;
        loop {
            let share = |i: usize| i as f64 / samples as f64;
            let values = (0..samples).map(|i| at(share(i))).collect::<Result<Vec<f64>, _>>()?;
            let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
            let sum = Harmonics::of(&values, LEFT_OUT * tolerance * peak);
            let (mut worst, mut worst_at) = (0.0_f64, 0.0);
            for i in 0..samples * CHECKS {
                let place = ((i / CHECKS) as f64 + (i as f64 * UNEVEN).fract()) / samples as f64;
                let error = (sum.value(place) - at(place)?).abs();
                if error > worst {
                    (worst, worst_at) = (error, place / frequency_hz);
                }
                if worst > tolerance * peak && samples < MAX_SAMPLES {
                    break;
                }
            }
            if worst <= tolerance * peak {
                return Ok(PeriodicDrive { excitation: sum.excitation(frequency_hz), error: worst });
            }
            if samples == MAX_SAMPLES {
                return Err(DriveError::Unresolved(worst_at, worst / peak));
            }
            samples *= 2;
        }
    }

    /// A drive with the period 1/`frequency_hz` through samples of one period in m/s^2: n of them, 1 to 4096,
    /// at the times 0, 1/n, .., (n - 1)/n of the period. Between them it is the trigonometric polynomial of
    /// least degree, which overshoots where the samples jump.
    ///
    /// # Errors
    ///
    /// [`DriveError::Frequency`] and [`DriveError::Digits`] for the frequency, [`DriveError::Samples`] for
    /// none or too many samples, [`DriveError::NotFinite`] and [`DriveError::TooLarge`] for one of them.
    pub fn from_samples(values: &[f64], frequency_hz: f64) -> Result<PeriodicDrive, DriveError> {
        check_frequency(frequency_hz)?;
        if !(1..=MAX_SAMPLES).contains(&values.len()) {
            return Err(DriveError::Samples(values.len()));
        }
        let time = |i: usize| i as f64 / values.len() as f64 / frequency_hz;
        values.iter().enumerate().try_for_each(|(i, value)| finite(time(i), *value).map(|_| ()))?;
        let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
        let sum = Harmonics::of(values, ROUNDING * peak);
        Ok(PeriodicDrive { excitation: sum.excitation(frequency_hz), error: 0.0 })
    }
}

fn check_frequency(hz: f64) -> Result<(), DriveError> {
    if !(FREQUENCIES.0 <= hz && hz <= FREQUENCIES.1) {
        return Err(DriveError::Frequency(hz));
    }
    let rounded = to_digits(hz, FREQUENCY_DIGITS);
    if rounded == hz { Ok(()) } else { Err(DriveError::Digits(hz, number_text(rounded))) }
}

/// The number with this many decimal digits that is nearest to `value`.
fn to_digits(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.precision$e}", precision = digits - 1);
    text.parse().unwrap_or(value)
}

fn finite(t: f64, value: f64) -> Result<f64, DriveError> {
    match value.abs() {
        size if size <= 1e30 => Ok(value),
        size if size.is_finite() => Err(DriveError::TooLarge(t, value)),
        _ => Err(DriveError::NotFinite(t, value)),
    }
}

/// mean + sum over k of amplitude sin(2 pi k t + phase), t in periods.
struct Harmonics {
    mean: f64,
    /// k, amplitude in m/s^2 and phase in radians, in order of k.
    terms: Vec<(usize, f64, f64)>,
}

impl Harmonics {
    /// The mean and the harmonics through values of one period, without the smallest of them, whose
    /// amplitudes add up to at most `left_out`.
    fn of(values: &[f64], left_out: f64) -> Self {
        let polynomial = TrigonometricPolynomial::through(values);
        let term = |(k, (cosine, sine)): (usize, &(f64, f64))| {
            (k, elementary::hypot(*cosine, *sine), elementary::atan2(*cosine, *sine))
        };
        let mut terms: Vec<_> = (1..).zip(&polynomial.harmonics).map(term).collect();
        terms.sort_by(|a, b| a.1.total_cmp(&b.1));
        let is_left_out = polynomial.mean.abs() <= left_out;
        let (mean, mut sum) = if is_left_out { (0.0, polynomial.mean.abs()) } else { (polynomial.mean, 0.0) };
        terms.retain(|(_, amplitude, _)| {
            sum += amplitude;
            sum > left_out
        });
        terms.sort_by_key(|(k, ..)| *k);
        Self { mean, terms }
    }

    fn value(&self, t: f64) -> f64 {
        // whole turns are taken off before the sine
        let turns = |k: usize| (k as f64 * t).fract();
        let value =
            |(k, amplitude, phase): &(usize, f64, f64)| amplitude * elementary::sin(TAU * turns(*k) + phase);
        self.mean + self.terms.iter().map(value).sum::<f64>()
    }

    fn excitation(&self, frequency_hz: f64) -> Excitation {
        let sine = |(k, amplitude, phase): &(usize, f64, f64)| Excitation::Sine {
            frequency_hz: to_digits(*k as f64 * frequency_hz, FREQUENCY_DIGITS + 4),
            amplitude_g: amplitude / STANDARD_GRAVITY,
            phase_deg: phase.to_degrees(),
        };
        let constant = Excitation::Constant { accel_g: self.mean / STANDARD_GRAVITY };
        let mut terms: Vec<Excitation> = self.terms.iter().map(sine).collect();
        if self.mean != 0.0 {
            terms.insert(0, constant);
        }
        match terms.len() {
            0 => Excitation::None,
            1 => terms.remove(0),
            _ => Excitation::Sum(terms),
        }
    }
}
