//! An electrical state beside the motion: steady states by complex impedances, limits, energy.

use std::f64::consts::TAU;
use std::ops::{Add, Div, Mul};

use interwell::dynamics::{Model, Outcome, Request, Run};

use crate::support::*;

#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    fn squared(self) -> f64 {
        self.0 * self.0 + self.1 * self.1
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let Self(re, im) = self * Self(other.0, -other.1);
        Self(re / other.squared(), im / other.squared())
    }
}

/// A transducer: its text, coupling, and what coupling times velocity is divided by to give its state.
struct Known {
    text: String,
    coupling: f64,
    impedance: Box<dyn Fn(f64) -> Complex>,
    /// Power into the load and the coil per squared state, and the voltage per state.
    load: f64,
    coil: f64,
    voltage: f64,
}

fn coil(coupling: f64, coil: f64, load: f64, inductance: f64) -> Known {
    let text = format!(
        "Electromagnetic(coupling_v_s_per_m: {coupling}, coil_ohm: {coil}, load_ohm: {load}, \
         inductance_mh: {})",
        inductance * 1e3
    );
    let impedance = Box::new(move |w: f64| Complex(coil + load, w * inductance));
    Known { text, coupling, impedance, load, coil, voltage: load }
}

fn piezo(coupling: f64, capacitance: f64, load: f64) -> Known {
    let text = format!(
        "Piezoelectric(coupling_n_per_v: {coupling}, capacitance_nf: {}, load_kohm: {})",
        capacitance * 1e9,
        load / 1e3
    );
    let impedance = Box::new(move |w: f64| Complex(1.0 / load, w * capacitance));
    Known { text, coupling, impedance, load: 1.0 / load, coil: 0.0, voltage: 1.0 }
}

/// A linear oscillator of 1 kg, 1 N s/m and 400 N/m under 1 m/s^2 at the angular frequency `w`, on its steady
/// orbit for some periods; and the squared amplitude of the state.
fn steady(known: &Known, w: f64, tolerance: f64) -> (Model, f64) {
    let electrical = (known.impedance)(w);
    let k = Complex(known.coupling, 0.0);
    let mechanical = Complex(1.0, w - 400.0 / w) + k * k / electrical;
    let v = Complex(-1.0, 0.0) / mechanical;
    let (x, state) = (v / Complex(0.0, w), k * v / electrical);
    let text = format!(
        "mass_g: 1000, mechanism: Cubic(linear_n_per_m: 400, cubic_n_per_m3: 0), \
         damping: Coefficient(c_n_s_per_m: 1), transducer: {}, \
         excitation: Sine(frequency_hz: {}, amplitude_g: {}), \
         start: At(x_mm: {}, v_m_per_s: {}, electrical: {}), \
         run: (duration_s: {}, settle_s: 0, tolerance: {tolerance})",
        known.text,
        w / TAU,
        1.0 / 9.80665,
        x.1 * 1e3,
        v.1,
        state.1,
        5.0 * TAU / w,
    );
    (model(&text), state.squared())
}

fn is_steady(known: &Known, w: f64, bound: f64) {
    let (model, squared) = steady(known, w, 1e-13);
    let run = run(&model);
    assert_eq!(run.summary.outcome, Outcome::Done);
    let harvest = run.summary.harvest.unwrap();
    near_relative(harvest.mean_load_power.unwrap(), 0.5 * known.load * squared, bound);
    near(harvest.mean_coil_power.unwrap(), 0.5 * known.coil * squared, bound * known.coil * squared);
    near_relative(harvest.voltage_rms.unwrap(), known.voltage * (0.5 * squared).sqrt(), bound);
    let ledger = run.summary.ledger.unwrap();
    assert!(ledger.energy_residual < 1e-11, "{ledger:?}");
}

#[test]
fn a_linear_oscillator_gives_the_power_of_its_impedances() {
    for w in [3.0, 17.0, 20.0, 23.0, 90.0] {
        is_steady(&coil(5.0, 40.0, 60.0, 3.0), w, 1e-10);
        is_steady(&coil(5.0, 0.0, 10.0, 0.5), w, 1e-10);
        is_steady(&piezo(0.02, 5e-6, 1e4), w, 1e-10);
        is_steady(&piezo(0.001, 4e-8, 1e6), w, 1e-10);
    }
}

#[test]
fn a_stiff_circuit_is_as_exact() {
    // time constants of a microsecond, and a coupling a hundred times as fast as the oscillator
    is_steady(&coil(5.0, 40.0, 60.0, 1e-4), 20.0, 1e-9);
    is_steady(&piezo(0.001, 1e-9, 1e3), 20.0, 1e-9);
    is_steady(&coil(2000.0, 1.0, 9.0, 1.0), 20.0, 1e-9);
    is_steady(&piezo(2.0, 1e-6, 1e5), 20.0, 1e-9);
}

#[test]
fn the_load_of_most_power_is_that_of_the_impedances() {
    // at one frequency the power is largest where the load is the magnitude of the impedance it looks into
    let (w, k, r, l) = (23.0, 5.0, 40.0, 3.0);
    let mechanical = Complex(1.0, w - 400.0 / w);
    let seen = Complex(r, w * l) + Complex(k * k, 0.0) / mechanical;
    let best = seen.squared().sqrt();
    let power = |load: f64| {
        let run = run(&steady(&coil(k, r, load, l), w, 1e-13).0);
        run.summary.harvest.unwrap().mean_load_power.unwrap()
    };
    let most = power(best);
    assert!(power(0.99 * best) < most && power(1.01 * best) < most);
    // the slope is 0 there: both sides lose alike, to the third order
    near_relative((most - power(best / 1.01)) / (most - power(best * 1.01)), 1.0, 1e-5);
}

#[test]
fn a_small_inductance_is_none() {
    // the state lags by L/R: to the first order in it
    let model = |inductance: f64| {
        preset(
            "nominal-cubic",
            &[
                &format!(
                    "transducer=Electromagnetic(coupling_v_s_per_m: 1, coil_ohm: 40, load_ohm: 60, \
                     inductance_mh: {inductance})"
                ),
                "run.duration_s=1",
                "run.settle_s=0",
            ],
        )
    };
    let power = |inductance: f64| run(&model(inductance)).summary.harvest.unwrap().mean_load_power.unwrap();
    let none = power(0.0);
    let apart = [1.0, 0.1].map(|inductance| (power(inductance) / none - 1.0).abs());
    assert!(apart[0] < 1e-3 && apart[1] < 0.15 * apart[0], "{apart:?}");
}

#[test]
fn an_open_piezoelectric_layer_is_a_spring() {
    let (k, c) = (0.02, 5e-6);
    let text = |linear: f64, transducer: &str| {
        model(&format!(
            "mass_g: 15.2, mechanism: Cubic(linear_n_per_m: {linear}, cubic_n_per_m3: 8e5), \
             transducer: {transducer}, excitation: Sine(frequency_hz: 3, amplitude_g: 2), \
             start: At(x_mm: 0, v_m_per_s: 0.01), \
             stops: Rigid(travel_limit_mm: 4, restitution: 0.36), run: (duration_s: 2, tolerance: 1e-12)"
        ))
    };
    let open = "Piezoelectric(coupling_n_per_v: 0.02, capacitance_nf: 5000, load_kohm: inf)";
    let with = run(&text(-40.0, open));
    // from x = 0 without a charge the voltage is (k/C) x
    let spring = run(&text(-40.0 + k * k / c, "None"));
    assert_eq!(with.events.len(), spring.events.len());
    assert!(with.events.len() > 8, "{}", with.events.len());
    for (a, b) in with.events.iter().zip(&spring.events) {
        assert_eq!((a.kind, a.side), (b.kind, b.side));
        near(a.t, b.t, 1e-9);
    }
    near(with.summary.final_x, spring.summary.final_x, 1e-10);
    assert_eq!(with.summary.harvest.unwrap().mean_load_power, Some(0.0));
    assert!(with.summary.harvest.unwrap().voltage_rms.unwrap() > 1.0);
}

#[test]
fn short_and_open_circuits_without_a_state_change_no_bit() {
    let bare = run(&preset("paper", &[]));
    for transducer in [
        "Piezoelectric(coupling_n_per_v: 0.02, capacitance_nf: 5000, load_kohm: 0)",
        "Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: inf, inductance_mh: 10)",
    ] {
        let with = run(&preset("paper", &[&format!("transducer={transducer}")]));
        assert_eq!(with.events, bare.events);
        let (a, b) = (&with.summary, &bare.summary);
        assert_eq!((a.final_x, a.final_v, a.steps), (b.final_x, b.final_v, b.steps));
        assert_eq!(a.harvest.unwrap().mean_load_power, Some(0.0));
    }
}

fn balances(model: &Model, case: &str) -> Run {
    let run = run(model);
    let summary = &run.summary;
    assert_eq!(summary.outcome, Outcome::Done, "{case}");
    let ledger = summary.ledger.unwrap();
    assert!(ledger.energy_residual < 20.0 * model.tolerance(), "{case}: {ledger:?}");
    assert!(ledger.harvested_j.unwrap() >= 0.0, "{case}");
    run
}

#[test]
fn the_energy_balances_in_every_scene_with_a_state() {
    let stops = [
        "stops=None",
        "stops=Rigid(travel_limit_mm: 1.5, restitution: 0.36)",
        "stops=Rigid(travel_limit_mm: 4, restitution: 0.9)",
        "stops=Uneven(left_mm: 2, right_mm: 5, restitution_left: 0, restitution_right: 0.7)",
    ];
    let drives = [
        "excitation=Sine(frequency_hz: 3, amplitude_g: 1.1)",
        "excitation=Noise(rms_g: 0.6, low_hz: 1, high_hz: 20, seed: 3, lines: 24)",
        "excitation=Sum([Constant(accel_g: 0.1), AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, \
         over_s: 3)])",
    ];
    let transducers = [
        "Electromagnetic(coupling_v_s_per_m: 2, coil_ohm: 10, load_ohm: 20, inductance_mh: 500)",
        "Electromagnetic(coupling_v_s_per_m: 0.3, coil_ohm: 0, load_ohm: 2, inductance_mh: 5)",
        "Piezoelectric(coupling_n_per_v: 1e-3, capacitance_nf: 40, load_kohm: 100)",
        "Piezoelectric(coupling_n_per_v: 5e-3, capacitance_nf: 400, load_kohm: 3)",
    ];
    let (mut rests, mut sums, mut moving) = (0, 0, 0);
    for (i, stop) in stops.iter().enumerate() {
        for (j, drive) in drives.iter().enumerate() {
            for (l, transducer) in transducers.iter().enumerate() {
                let mechanism = if (i + j + l) % 2 == 0 { "paper" } else { "nominal-cubic" };
                let tolerance =
                    ["run.tolerance=1e-6", "run.tolerance=1e-9", "run.tolerance=1e-12"][(i + l) % 3];
                let transducer = format!("transducer={transducer}");
                let changes = [
                    *stop,
                    *drive,
                    transducer.as_str(),
                    tolerance,
                    "run.duration_s=4",
                    "run.settle_s=0.3333",
                ];
                let run = balances(&preset(mechanism, &changes), &format!("{mechanism} {changes:?}"));
                rests += run.summary.rests;
                sums += run.summary.chatter_sums;
                moving += u64::from(run.summary.ledger.unwrap().harvested_j > Some(0.0));
                // over the window too: the means are those of the samples
                let again = preset(mechanism, &changes).run(&Request::default()).summary;
                let (a, b) = (run.summary.harvest.unwrap(), again.harvest.unwrap());
                let power = a.mean_load_power.unwrap();
                near(b.mean_load_power.unwrap(), power, 1e-12 * power);
            }
        }
    }
    assert!(rests > 50 && sums > 50 && moving > 40, "{rests} rests, {sums} sums, {moving} move");
}

#[test]
fn samples_integrate_to_the_energy() {
    let transducer = "transducer=Piezoelectric(coupling_n_per_v: 1e-3, capacitance_nf: 40, load_kohm: 100)";
    let model = preset("paper", &[transducer, "run.duration_s=2", "run.settle_s=0"]);
    let times: Vec<f64> = (0..=200_000).map(|i| f64::from(i) * 1e-5).collect();
    let run = run_at(&model, &times);
    assert!(run.summary.rests > 3);
    let power = |i: usize| model.output(&run.samples[i]).unwrap().power;
    let sum: f64 = (1..times.len()).map(|i| 0.5e-5 * (power(i - 1) + power(i))).sum();
    // (the trapezium rule, at kinks of the voltage)
    near_relative(run.summary.ledger.unwrap().harvested_j.unwrap(), sum, 1e-5);
}

#[test]
fn company_changes_no_bit() {
    let models: Vec<Model> = (0..6)
        .map(|i| {
            let transducer = format!(
                "transducer=Electromagnetic(coupling_v_s_per_m: 2, coil_ohm: 10, load_ohm: {}, \
                 inductance_mh: {})",
                10 * i,
                if i % 2 == 0 { 0 } else { 100 }
            );
            preset("paper", &[&transducer, "run.duration_s=3", "run.settle_s=1"])
        })
        .collect();
    let mut together = Model::run_together(&models, &Request::default());
    for (model, run) in models.iter().zip(&mut together) {
        let mut alone = model.run(&Request::default());
        (alone.summary.cpu_s, run.summary.cpu_s) = (0.0, 0.0);
        assert_eq!(alone, *run);
    }
}
