//! Trigonometric polynomial through evenly spaced values of one period.

use realfft::RealFftPlanner;

/// A trigonometric polynomial: the mean and, for each harmonic k, cosine cos(2 pi k t) + sine sin(2 pi k t),
/// with the time t in periods.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TrigonometricPolynomial {
    /// The mean value.
    pub mean: f64,
    /// The coefficients of cosine and sine of each harmonic, from k = 1 on.
    pub harmonics: Vec<(f64, f64)>,
}

impl TrigonometricPolynomial {
    /// The polynomial of least degree through `values` at the times 0, 1/n, .., (n - 1)/n; for even n the
    /// harmonic n/2 is a cosine. It has the values to a few units of rounding of the largest one.
    pub fn through(values: &[f64]) -> Self {
        let n = values.len();
        if n == 0 {
            return Self::default();
        }
        let transform = RealFftPlanner::<f64>::new().plan_fft_forward(n);
        let (mut input, mut output) = (values.to_vec(), transform.make_output_vec());
        let done = transform.process(&mut input, &mut output);
        debug_assert!(done.is_ok(), "both buffers were made for this length");
        let harmonic = |k: usize| {
            let share = if 2 * k == n { 1.0 } else { 2.0 } / n as f64;
            (share * output[k].re, -share * output[k].im)
        };
        Self { mean: output[0].re / n as f64, harmonics: (1..output.len()).map(harmonic).collect() }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::numeric::random;

    #[test]
    fn it_has_the_values() {
        let mut next = random();
        for n in 1..70 {
            let values: Vec<f64> = (0..n).map(|_| next() - 0.3).collect();
            let polynomial = TrigonometricPolynomial::through(&values);
            assert_eq!(polynomial.harmonics.len(), n / 2);
            for (i, value) in values.iter().enumerate() {
                let terms = (1_usize..).zip(&polynomial.harmonics).map(|(k, (cosine, sine))| {
                    let (s, c) = (TAU * ((k * i) % n) as f64 / n as f64).sin_cos();
                    cosine * c + sine * s
                });
                let found = polynomial.mean + terms.sum::<f64>();
                assert!((found - value).abs() < 1e-14, "{n} values, number {i}: {found} is not {value}");
            }
        }
    }
}
