//! Periodogram: amplitude and power spectral density of evenly spaced values.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use super::elementary;
use super::sum::CompensatedSum;

/// How values are weighted before they are transformed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Taper {
    /// Equal weights. A component with a whole number of periods is one line; any other leaks into all lines.
    None,
    /// The von Hann window, sin^2(pi k/n). A component of any period is concentrated in four lines and leaks
    /// little into the others.
    Hann,
}

/// One-sided spectrum of n values one step apart, at the frequencies k/(n step) for k from 0 to n/2.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodogram {
    /// Amplitude of the sine at each frequency, in the unit of the values; at 0 the magnitude of the mean.
    pub amplitude: Vec<f64>,
    /// Power spectral density, in the square of the values' unit times the step's unit.
    pub density: Vec<f64>,
}

/// The periodogram of `values`, spaced by `step`.
///
/// The mean is subtracted before the values are weighted, so that it does not leak; it appears in line 0
/// only. With weights w the amplitude is 2 |X|/sum w (corrected for the coherent gain) and the density 2 step
/// |X|^2/sum w^2 (corrected for the noise bandwidth). Line n/2 has no mirror image and hence no factor 2;
/// line 0 is the mean and its density (G. Heinzel, A. Ruediger and R. Schilling 2002, "Spectrum and spectral
/// density estimation by the discrete Fourier transform"). Without a taper the density times 1/(n step),
/// summed over all lines, is the mean square of the values (Parseval). With a taper, summed over all lines
/// but line 0, it is the mean square of the weighted values less their contribution to line 0.
///
/// A sine of k whole periods is line k alone without a taper. With the von Hann window it has its amplitude
/// in line k, half of it in both neighbours (except line 0, which is the mean), and 0 elsewhere. The error is
/// a few units of rounding of the largest value. An empty `values` gives no lines.
pub fn periodogram(mut values: Vec<f64>, step: f64, taper: Taper) -> Periodogram {
    let n = values.len();
    if n == 0 {
        return Periodogram { amplitude: Vec::new(), density: Vec::new() };
    }
    let weight = |k: usize| match taper {
        // of one or two values the von Hann window would keep none or only one
        Taper::Hann if n > 2 => elementary::sin(PI * k as f64 / n as f64).powi(2),
        _ => 1.0,
    };
    let total = |term: &dyn Fn(usize) -> f64| {
        let mut sum = CompensatedSum::<f64>::new();
        (0..n).for_each(|k| sum.add(term(k)));
        sum.value()
    };
    let weights = total(&weight);
    let squared_weights = total(&|k| weight(k).powi(2));
    let mean = total(&|k| values[k]) / n as f64;
    values.iter_mut().enumerate().for_each(|(k, value)| *value = weight(k) * (*value - mean));

    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(n);
    let mut lines: Vec<Complex<f64>> = transform.make_output_vec();
    let done = transform.process(&mut values, &mut lines);
    debug_assert!(done.is_ok(), "both buffers were made for this length");
    let (mut amplitude, mut density) = (Vec::with_capacity(lines.len()), Vec::with_capacity(lines.len()));
    for (k, line) in lines.iter().enumerate() {
        let sides = if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
        amplitude.push(sides * elementary::hypot(line.re, line.im) / weights);
        density.push(sides * step * line.norm_sqr() / squared_weights);
    }
    amplitude[0] = mean.abs();
    density[0] = mean * mean * n as f64 * step;
    Periodogram { amplitude, density }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::numeric::random;

    fn noise(n: usize) -> Vec<f64> {
        let mut next = random();
        (0..n).map(|_| next() - 0.3).collect()
    }

    fn near(value: f64, exact: f64, bound: f64) {
        assert!((value - exact).abs() <= bound, "{value:?} is not {exact:?}");
    }

    #[test]
    fn the_density_sums_to_the_mean_square() {
        for n in [1, 2, 3, 4, 15, 360, 997, 1024] {
            let values = noise(n);
            let step = 0.01;
            let resolution = 1.0 / (n as f64 * step);
            let power = |taper| periodogram(values.clone(), step, taper).density.iter().sum::<f64>();
            let square = values.iter().map(|x| x * x).sum::<f64>() / n as f64;
            near(power(Taper::None) * resolution, square, 1e-14);
            if n > 2 {
                let weight = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos();
                let total: f64 = (0..n).map(weight).sum();
                near(total, 0.5 * n as f64, 1e-12 * n as f64);
                let mean = values.iter().sum::<f64>() / n as f64;
                let tapered = |k: usize| weight(k) * (values[k] - mean);
                let squares = (0..n).map(|k| tapered(k).powi(2)).sum::<f64>();
                let in_line_0 = (0..n).map(tapered).sum::<f64>().powi(2) / n as f64;
                let weights = (0..n).map(|k| weight(k).powi(2)).sum::<f64>();
                let exact = (squares - in_line_0) / weights + mean * mean;
                near(power(Taper::Hann) * resolution, exact, 1e-14);
            }
        }
    }

    #[test]
    fn line_0_is_the_mean_also_beside_the_first_line() {
        // with the von Hann window the weighted mean of a sine of one period is half its amplitude
        for (n, phase) in [(64, 0.0), (1000, 0.7), (1001, 2.0)] {
            let value = |k: usize| 0.5 + 3.0 * (TAU * k as f64 / n as f64 + phase).cos();
            for taper in [Taper::None, Taper::Hann] {
                let lines = periodogram((0..n).map(value).collect(), 0.1, taper);
                near(lines.amplitude[0], 0.5, 1e-13);
                near(lines.density[0] / (0.1 * n as f64), 0.25, 1e-13);
                near(lines.amplitude[1], 3.0, 1e-13);
            }
        }
    }

    #[test]
    fn whole_periods_are_lines() {
        let (n, step) = (240, 0.05);
        let value = |k: usize| {
            let turns = TAU * k as f64 / n as f64;
            7.0 + 2.0 * (3.0 * turns + 0.4).sin() + 1e-6 * (100.0 * turns).cos()
                - 0.25 * (120.0 * turns).cos()
        };
        let values: Vec<f64> = (0..n).map(value).collect();
        let lines = periodogram(values.clone(), step, Taper::None);
        assert_eq!((lines.amplitude.len(), lines.density.len()), (121, 121));
        for (k, amplitude) in lines.amplitude.iter().enumerate() {
            let exact = match k {
                0 => 7.0,
                3 => 2.0,
                100 => 1e-6,
                120 => 0.25,
                _ => 0.0,
            };
            near(*amplitude, exact, 1e-14);
        }
        near(lines.density[3] / (n as f64 * step), 2.0, 1e-13);
        let tapered = periodogram(values, step, Taper::Hann).amplitude;
        for (k, exact) in
            [(0, 7.0), (1, 0.0), (2, 1.0), (3, 2.0), (4, 1.0), (5, 0.0), (99, 5e-7), (100, 1e-6)]
        {
            near(tapered[k], exact, 1e-14);
        }
    }

    #[test]
    fn a_taper_confines_a_sine_between_two_lines() {
        // halfway between two lines: it leaks into all lines without a taper, into four with one
        let (n, at) = (1000, 100.5);
        let values: Vec<f64> = (0..n).map(|k| (TAU * at * k as f64 / n as f64).sin()).collect();
        let far = |taper| periodogram(values.clone(), 1.0, taper).amplitude[120];
        assert!(far(Taper::None) > 1e-2 && far(Taper::Hann) < 1e-4);
        // the density of white noise is the same with and without a taper
        let level = |taper| {
            let density = periodogram(noise(1 << 16), 0.5, taper).density;
            density[1..density.len() - 1].iter().sum::<f64>() / (density.len() - 2) as f64
        };
        let white = 2.0 * 0.5 / 12.0; // twice the step times the variance
        assert!((level(Taper::None) / white - 1.0).abs() < 0.02, "{}", level(Taper::None));
        assert!((level(Taper::Hann) / white - 1.0).abs() < 0.02, "{}", level(Taper::Hann));
    }
}
