//! Spectra against closed forms, against the averages of the runs, and on the command line.

use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{Model, Request, STANDARD_GRAVITY};
use interwell::numeric::Taper;
use interwell_studies::study::*;

use super::cli::{column, headless, stdout};
use super::support::*;

const PLAIN: SpectrumOptions =
    SpectrumOptions { signal: Signal::Displacement, taper: None, rate_hz: None, until_settled: None };

fn of(model: &Model, options: SpectrumOptions) -> SpectrumAnswer {
    spectrum(model, &options, &Task { tick: &|| (), cancel: &AtomicBool::new(false) }).unwrap()
}

/// Frequencies, amplitudes and densities.
fn lines(spectrum: &SpectrumAnswer) -> [&[f64]; 3] {
    ["frequency_hz", "amplitude", "psd"].map(|name| spectrum.table().numbers(name).unwrap())
}

/// The density, integrated.
fn power(spectrum: &SpectrumAnswer) -> f64 {
    let [frequency, _, density] = lines(spectrum);
    density.iter().sum::<f64>() * frequency[1]
}

/// A mass of 2 kg on a spring of 50 N/m with damping: transients are gone at 60 s.
fn linear(excitation: &str) -> Model {
    model(&format!(
        "mass_g: 2000, mechanism: Polynomial(coefficients_si: [0, 50]), \
         damping: Coefficient(c_n_s_per_m: 3), excitation: {excitation}, \
         run: (duration_s: 80, settle_s: 60, tolerance: 1e-13)"
    ))
}

/// The amplitude of its displacement under a sine of the base.
fn response(frequency: f64, g: f64) -> f64 {
    let w = TAU * frequency;
    2.0 * g * STANDARD_GRAVITY / (50.0 - 2.0 * w * w).hypot(3.0 * w)
}

#[test]
fn a_linear_oscillator_has_one_line_of_the_known_height() {
    let model = linear("Sine(frequency_hz: 0.7, amplitude_g: 0.3, phase_deg: 50)");
    let exact = response(0.7, 0.3);
    for (signal, exact) in [
        (Signal::Displacement, exact),
        (Signal::Velocity, exact * TAU * 0.7),
        (Signal::BaseAcceleration, 0.3 * STANDARD_GRAVITY),
    ] {
        let spectrum = of(&model, SpectrumOptions { signal, ..PLAIN });
        assert_eq!((spectrum.taper, spectrum.periods, spectrum.period), (Taper::None, 14, Some(1)));
        let [frequency, amplitude, density] = lines(&spectrum);
        assert_eq!(frequency[14], 0.7);
        near_relative(amplitude[14], exact, 1e-11);
        near_relative(density[14] * frequency[1], 0.5 * exact * exact, 1e-11);
        let others = amplitude.iter().enumerate().filter(|(k, _)| *k != 14);
        let most = others.fold(0.0_f64, |most, line| most.max(*line.1));
        assert!(most < 1e-11 * exact, "{most:e} of {exact:e}");
        // with a taper the same height, and half of it beside
        let tapered = of(
            &linear("Sine(frequency_hz: 0.7, amplitude_g: 0.3, phase_deg: 50)"),
            SpectrumOptions { signal, taper: Some(Taper::Hann), ..PLAIN },
        );
        let tapered = lines(&tapered)[1];
        near_relative(tapered[14], exact, 1e-11);
        near_relative(tapered[13], 0.5 * exact, 1e-11);
        near(tapered[12], 0.0, 1e-11 * exact);
    }
}

#[test]
fn tones_with_a_common_period_have_a_line_each() {
    let model = linear(
        "Sum([Sine(frequency_hz: 0.7, amplitude_g: 0.3), Sine(frequency_hz: 1.1, amplitude_g: 0.02), \
         Constant(accel_g: 0.01)])",
    );
    let spectrum = of(&model, PLAIN);
    assert_eq!(
        (spectrum.taper, spectrum.periods, spectrum.forcing_hz.as_slice()),
        (Taper::None, 2, &[0.7, 1.1][..])
    );
    let [frequency, amplitude, _] = lines(&spectrum);
    let mean = 2.0 * 0.01 * STANDARD_GRAVITY / 50.0;
    let known = [(0.0, mean), (0.7, response(0.7, 0.3)), (1.1, response(1.1, 0.02))];
    for (hz, amplitude) in frequency.iter().zip(amplitude) {
        let exact = known.iter().find(|known| (known.0 - hz).abs() < 1e-12).map_or(0.0, |known| known.1);
        near(*amplitude, exact, 1e-11 * response(0.7, 0.3));
    }
    assert!(known.iter().all(|known| frequency.iter().any(|hz| (known.0 - hz).abs() < 1e-12)));
}

#[test]
fn a_motion_without_a_drive_is_told_through_the_taper() {
    let model = model(
        "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, 39.47841760435743]), \
         start: At(x_mm: 10, v_m_per_s: 0), run: (duration_s: 70.3, settle_s: 0, tolerance: 1e-13)",
    );
    let spectrum = of(&model, PLAIN);
    assert_eq!((spectrum.taper, spectrum.periods, spectrum.period), (Taper::Hann, 0, None));
    let [frequency, amplitude, density] = lines(&spectrum);
    let highest = (0..amplitude.len()).max_by(|a, b| amplitude[*a].total_cmp(&amplitude[*b])).unwrap();
    near(frequency[highest], 1.0, 0.5 / 70.3 + 1e-12);
    // of a sine r lines beside a line the taper leaves sinc(r)/(1 - r^2)
    let beside = 70.3 - 70.0;
    let kept = (PI * beside).sin() / (PI * beside) / (1.0 - beside * beside);
    near_relative(amplitude[highest], 0.01 * kept, 1e-3);
    let around: f64 = density[highest - 20..highest + 20].iter().sum::<f64>() / 70.3;
    near_relative(around, 0.5e-4, 1e-4);
}

#[test]
fn a_motion_that_repeats_after_several_periods_has_lines_of_its_own_period() {
    let model = preset("period-adding", &[]);
    let spectrum = of(&model, SpectrumOptions { signal: Signal::Velocity, ..PLAIN });
    assert_eq!((spectrum.taper, spectrum.periods, spectrum.period), (Taper::None, 100, Some(4)));
    let amplitude = lines(&spectrum)[1];
    let most = |of: &dyn Fn(usize) -> bool| {
        (0..amplitude.len()).filter(|k| of(*k)).map(|k| amplitude[k]).fold(0.0, f64::max)
    };
    // 100 periods are 25 of the motion: its lines are every 25th
    assert!(most(&|k| k % 25 == 0) > 0.1);
    assert!(most(&|k| k % 25 == 0 && k % 100 != 0) > 1e-2);
    assert!(most(&|k| k % 25 != 0) < 1e-6, "{:e}", most(&|k| k % 25 != 0));
    // the samples are whole periods of a motion whose window is not
    let odd = preset("period-adding", &["run.settle_s=1030"]);
    assert_eq!(odd.run(&Request::default()).summary.periods, 103);
    let (odd, whole) = (of(&odd, PLAIN), of(&preset("period-adding", &[]), PLAIN));
    assert_eq!(odd.periods, 100);
    for k in [25, 50, 75, 100] {
        near_relative(lines(&odd)[1][k], lines(&whole)[1][k], 1e-4);
    }
}

#[test]
fn the_density_integrates_to_the_mean_square() {
    // a smooth motion is sampled exactly
    let model = preset("duffing", &[]);
    let rms = model.run(&Request::default()).summary.rms_velocity.unwrap();
    let velocity = SpectrumOptions { signal: Signal::Velocity, ..PLAIN };
    near_relative(power(&of(&model, velocity)), rms * rms, 1e-12);
    // impacts are jumps: what is missed falls with the rate
    let model = preset("nominal-cubic", &[]);
    let rms = model.run(&Request::default()).summary.rms_velocity.unwrap();
    let missed = |rate_hz| {
        (power(&of(&model, SpectrumOptions { rate_hz: Some(rate_hz), ..velocity })) / (rms * rms) - 1.0).abs()
    };
    let (coarse, fine) = (missed(3.0 * 200.0), missed(3.0 * 20_000.0));
    assert!(fine < 1e-3 && fine < 0.1 * coarse, "{coarse:e} {fine:e}");
    // noise: lines sqrt(2/n) of its RMS high, all within its band
    let model = preset("random-shaking", &["excitation.rms_g=0.5"]);
    let band = &model.excitation().noises[0];
    let spectrum = of(&model, SpectrumOptions { signal: Signal::BaseAcceleration, ..PLAIN });
    assert_eq!((spectrum.taper, spectrum.forcing_hz.len()), (Taper::Hann, 0));
    near_relative(power(&spectrum).sqrt(), 0.5 * STANDARD_GRAVITY, 0.1);
    let [frequency, _, density] = lines(&spectrum);
    let beyond =
        frequency.iter().zip(density).filter(|line| *line.0 < band.low - 0.2 || *line.0 > band.high + 0.2);
    let beyond: f64 = beyond.map(|line| line.1 * frequency[1]).sum();
    assert!(beyond < 1e-6 * power(&spectrum), "{beyond:e}");
}

#[test]
fn a_rate_is_made_a_whole_number_a_period() {
    let model = preset("paper", &[]);
    let at = |rate_hz| of(&model, SpectrumOptions { rate_hz: Some(rate_hz), ..PLAIN });
    for (asked, samples) in [(300.0, 1500), (301.0, 1515), (0.9, 15)] {
        let spectrum = at(asked);
        assert_eq!(
            (spectrum.samples, spectrum.window, spectrum.table().rows()),
            (samples, (5.0, 10.0), samples / 2 + 1)
        );
        near_relative(spectrum.rate_hz, samples as f64 / 5.0, 1e-15);
    }
}

#[test]
fn the_command_writes_lines_and_says_what_is_wrong() {
    let line = "spectrum paper --of accel --rate-hz 30 --quiet";
    let csv = stdout(line);
    assert_eq!(csv.lines().next().unwrap(), "frequency_hz,amplitude,psd");
    let highest = csv.lines().find(|row| row.starts_with("3,")).unwrap();
    let amplitude: f64 = highest.split(',').nth(1).unwrap().parse().unwrap();
    near_relative(amplitude, STANDARD_GRAVITY, 1e-12);
    assert_eq!(column(&csv, "psd").len(), 76);
    assert_eq!(stdout(&format!("{line} --jobs 1")), stdout(&format!("{line} --jobs 3")));
    headless("spectrum paper --rate-hz 30 --out /dev/null").assert().success().stderr(
        "built-in paper: from 5 to 10 s, 15 forcing periods; repeats in each; no taper, sampled at 30 Hz\n",
    );
    let left = "spectrum duffing --set mechanism=Table(path:\"force_dl2.7.csv\") --set start=Rest --set \
                excitation.amplitude_g=30 --set mass_g=100 --set damping=None --set \
                excitation.frequency_hz=3";
    headless(left).assert().code(1).stderr(predicates::str::contains("ended early"));
}
