//! Chaos, and one problem in several systems of units.

use crate::accuracy::Stopped;
use crate::accuracy::measure::{Bench, CHANGE, SMALL_CHANGE, Trial, Trials, impacts_above, off};
use crate::accuracy::setup::{Setup, rigid};
use crate::dynamics::{Run, Sample};
use crate::scene::{Excitation, Mechanism, Start};

pub(super) fn chaos(bench: &Bench) -> Trials {
    let preset = |changes: &[&str]| Setup::preset("duffing-chaos", changes);
    let mut trials = Vec::new();
    let period = 5.235987755982988;
    for (name, periods) in [("5 periods", 5.0), ("15 periods", 15.0), ("30 periods", 30.0)] {
        let duration = format!("run.duration_s={:?}", periods * period);
        let setup = preset(&[&duration, "run.settle_s=0"])?;
        let state = |run: &Run| vec![run.summary.final_x, run.summary.final_v];
        let reference = bench.reference(&setup, &[], SMALL_CHANGE, state)?;
        let mut trial = bench.run(name, &setup, &[])?;
        let scales = trial.model.scales();
        trial.beside("final state", &state(&trial.run), &reference, &[scales.length, scales.speed]);
        trials.push(trial);
    }
    let (mut trial, batches) = averages(bench, &preset(&[])?)?;
    let (_, other) = averages(bench, &preset(&["start.x_mm=900"])?)?;
    let (a, b) = (mean(&batches), mean(&other));
    let error = (spread(&batches).powi(2) + spread(&other).powi(2)).sqrt();
    trial.number("mean square velocity", off(a, b, a), 4.0 * error / a);
    trial.energy_balance();
    trials.push(trial);
    Ok(trials)
}

/// A run, and the mean square velocity over each of 30 batches of 30 periods, from 64 samples a period.
fn averages(bench: &Bench, setup: &Setup) -> Result<(Trial, Vec<f64>), Stopped> {
    const BATCHES: usize = 30;
    const PER_BATCH: usize = 30 * 64;
    let model = setup.model()?;
    let step = (model.duration() - model.settle()) / (BATCHES * PER_BATCH) as f64;
    let times: Vec<f64> =
        (0..BATCHES * PER_BATCH).map(|i| model.settle() + (i as f64 + 0.5) * step).collect();
    let trial = bench.run("averages", setup, &times)?;
    let square =
        |batch: &[Sample]| batch.iter().map(|sample| sample.v * sample.v).sum::<f64>() / batch.len() as f64;
    let batches = trial.run.samples.chunks(PER_BATCH).map(square).collect();
    Ok((trial, batches))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn spread(values: &[f64]) -> f64 {
    let (middle, n) = (mean(values), values.len() as f64);
    (values.iter().map(|value| (value - middle).powi(2)).sum::<f64>() / (n * (n - 1.0))).sqrt()
}

#[derive(Clone, Copy)]
struct Units {
    mass: f64,
    length: f64,
    time: f64,
}

impl Units {
    const SI: Self = Self { mass: 1.0, length: 1.0, time: 1.0 };

    fn setup(self) -> Setup {
        let Self { mass: m, length: l, time: t } = self;
        let cubic = Mechanism::Cubic {
            linear_n_per_m: -40.0 * m / (t * t),
            cubic_n_per_m3: 40.0 / 49e-6 * m / (t * t * l * l),
        };
        let drive =
            Excitation::Sine { frequency_hz: 3.0 / t, amplitude_g: 1.5 * l / (t * t), phase_deg: 0.0 };
        let mut setup =
            Setup::new(cubic, (0.0, 0.0), t).stops(rigid(4.0 * l, 0.36)).drive(drive).damping(0.05 * m / t);
        setup.scene.mass_g = 15.2 * m;
        setup.scene.start = Start::Rest;
        setup
    }

    /// Times in periods of the impacts that are faster than 1 cm/s in SI.
    fn hard_impacts(self, run: &Run) -> Vec<f64> {
        let times = impacts_above(1e-2 * self.length / self.time, run);
        times.into_iter().map(|t| 3.0 * t / self.time).collect()
    }
}

pub(super) fn units(bench: &Bench) -> Trials {
    let si = Units::SI;
    let mut reference = bench.reference(&si.setup(), &[], CHANGE, |run| si.hard_impacts(run))?;
    // a scaled datum is rounded once more
    reference.sensitivities.iter_mut().for_each(|sensitivity| *sensitivity *= 2.0);
    let systems = [
        ("SI", si),
        ("mass 1e-9", Units { mass: 1e-9, ..si }),
        ("mass 1e9", Units { mass: 1e9, ..si }),
        ("stiffness 1e-9", Units { time: 1e9_f64.sqrt(), ..si }),
        ("stiffness 1e9", Units { time: 1e-9_f64.sqrt(), ..si }),
        ("length 1e-9", Units { length: 1e-9, ..si }),
        ("length 1e9", Units { length: 1e9, ..si }),
        ("time 1e-9", Units { time: 1e-9, ..si }),
        ("time 1e9", Units { time: 1e9, ..si }),
        ("all", Units { mass: 1e9, length: 1e-9, time: 1e-5 }),
    ];
    let in_units = |(name, units): (&'static str, Units)| {
        let mut trial = bench.run(name, &units.setup(), &[])?;
        trial.impacts_beside(&reference, |run| units.hard_impacts(run));
        Ok(trial)
    };
    systems.into_iter().map(in_units).collect()
}
