//! Periodic motions beside a circuit: three multipliers and exponents, and events of branches, in closed
//! form.

use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

use interwell::dynamics::{EventKind, Model, STANDARD_GRAVITY};
use interwell_studies::study::{BranchEvent, ExponentOptions, average_exponents, exponents};
use nalgebra::{Complex, Matrix3};

use super::{at, document, find, over_amplitude};
use crate::measured::Noise;
use crate::support::{model, near, near_relative};

/// A linear oscillator of 1 kg beside a circuit.
#[derive(Clone)]
pub struct Oscillator {
    stiffness: f64,
    damping: f64,
    /// Force in N per A or V.
    coupling: f64,
    /// Inductance in H or capacitance in F.
    storage: f64,
    /// Rate in 1/s at which the circuit decays.
    decay: f64,
    is_coil: bool,
    pub frequency: f64,
    pub amplitude_g: f64,
}

impl Oscillator {
    pub fn random(random: &mut Noise) -> Self {
        let mut between = |low: f64, high: f64| random.between(low, high);
        Self {
            stiffness: between(0.5, 2.0),
            damping: between(0.02, 0.3),
            coupling: between(0.1, 1.0),
            storage: between(0.3, 2.0),
            decay: between(0.1, 3.0),
            is_coil: between(0.0, 1.0) < 0.5,
            frequency: between(0.05, 0.5),
            amplitude_g: between(0.005, 0.05),
        }
    }

    fn transducer(&self) -> String {
        let Self { coupling, storage, decay, .. } = self;
        if self.is_coil {
            let (resistance, inductance_mh) = (decay * storage, storage * 1e3);
            format!(
                "Electromagnetic(coupling_v_s_per_m: {coupling:?}, coil_ohm: 0, load_ohm: {resistance:?}, \
                 inductance_mh: {inductance_mh:?})"
            )
        } else {
            let (nf, kohm) = (storage * 1e9, 1e-3 / (decay * storage));
            format!(
                "Piezoelectric(coupling_n_per_v: {coupling:?}, capacitance_nf: {nf:?}, load_kohm: {kohm:?})"
            )
        }
    }

    pub fn text(&self, rest: &str) -> String {
        format!(
            "mass_g: 1000, mechanism: Polynomial(coefficients_si: [0, {:?}]), transducer: {}, \
             damping: Coefficient(c_n_s_per_m: {:?}), \
             excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}), {rest}",
            self.stiffness,
            self.transducer(),
            self.damping,
            self.frequency,
            self.amplitude_g
        )
    }

    /// x' = v, v' = -k x - c v - coupling w, w' = (coupling v - decay storage w) / storage.
    fn matrix(&self) -> Matrix3<f64> {
        let Self { stiffness, damping, coupling, storage, decay, .. } = self;
        Matrix3::new(0.0, 1.0, 0.0, -stiffness, -damping, -coupling, 0.0, coupling / storage, -decay)
    }

    /// Amplitude in m of the steady motion at 1 m/s^2.
    pub fn response(&self) -> f64 {
        let i = Complex::new(0.0, TAU * self.frequency);
        let circuit = i * (self.coupling * self.coupling / self.storage) / (i + self.decay);
        1.0 / (i * i + i * self.damping + self.stiffness + circuit).norm()
    }

    fn period(&self) -> f64 {
        1.0 / self.frequency
    }
}

fn exponents_of(model: &Model) -> interwell_studies::study::Lyapunov {
    let options = ExponentOptions { periods: 50, ..ExponentOptions::default() };
    exponents(model, &options, &AtomicBool::new(false)).unwrap()
}

#[test]
fn the_multipliers_of_a_linear_oscillator_are_exponentials_of_its_eigenvalues() {
    let mut random = Noise::new(41);
    for _ in 0..60 {
        let oscillator = Oscillator::random(&mut random);
        let model = model(&oscillator.text("run: (duration_s: 600, settle_s: 500, tolerance: 1e-13)"));
        let found = find(&model, 0.2, None).unwrap();
        let values = oscillator.matrix().complex_eigenvalues();
        let mut known: Vec<Complex<f64>> =
            values.iter().map(|value| (value * oscillator.period()).exp()).collect();
        known.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
        assert_eq!((found.multipliers().len(), found.period), (3, 1));
        for multiplier in found.multipliers() {
            let off = known.iter().map(|value| (multiplier.re - value.re).hypot(multiplier.im - value.im));
            assert!(off.fold(f64::INFINITY, f64::min) < 1e-9 * known[0].norm(), "{multiplier:?} {known:?}");
        }
        // the product is known without integration, and so is the sum of the exponents
        let product: f64 = found.multipliers().iter().map(|multiplier| multiplier.magnitude()).product();
        let rate = oscillator.damping + oscillator.decay;
        near_relative(product, (-rate * oscillator.period()).exp(), 1e-9);
        let exponents = exponents_of(&model);
        near_relative(exponents.exact_sum.unwrap(), -rate, 1e-13);
        let all = [exponents.first, exponents.second, exponents.third.unwrap()].map(|found| found.per_s);
        let mut real: Vec<f64> = values.iter().map(|value| value.re).collect();
        real.sort_by(|a, b| b.total_cmp(a));
        all.iter().zip(&real).for_each(|(found, known)| near(*found, *known, 1e-8 * rate));
        near_relative(all.iter().sum::<f64>(), -rate, 1e-9);
        // averages from any state tend to the same; they need no orbit
        let state = (0.01, 0.02);
        let average = average_exponents(&model, state, 0.0, 400, &AtomicBool::new(false)).unwrap();
        let third = average.third.unwrap();
        near_relative(average.first.per_s + average.second.per_s + third.per_s, -rate, 1e-9);
        near(average.first.per_s, real[0], 0.02 * rate);
        near(third.per_s, real[2], 0.02 * rate);
    }
}

/// With impacts the product of the multipliers is exp(-(c/m + decay) T) times the squared restitution of
/// each.
#[test]
fn the_product_of_three_multipliers_is_known_with_impacts_too() {
    let mut random = Noise::new(42);
    let mut seen = 0;
    for _ in 0..40 {
        let oscillator = Oscillator::random(&mut random);
        let restitution = random.between(0.4, 0.95);
        let gap = random.between(0.3, 0.95);
        let reach = gap * oscillator.response() * oscillator.amplitude_g * STANDARD_GRAVITY * 1e3;
        let stop = format!("Uneven(left_mm: {reach:?}, restitution_left: {restitution:?})");
        let rest = format!("stops: {stop}, run: (duration_s: 900, settle_s: 700, tolerance: 1e-12)");
        let Ok(found) = find(&model(&oscillator.text(&rest)), 0.0, None) else { continue };
        let impacts = found.passage.events.iter().filter(|event| event.kind == EventKind::Impact).count();
        if found.passage.rested || impacts == 0 {
            continue;
        }
        seen += 1;
        let time = f64::from(found.period) * oscillator.period();
        let known = (-(oscillator.damping + oscillator.decay) * time).exp()
            * restitution.powi(2 * i32::try_from(impacts).unwrap());
        let scale: f64 = found.multipliers()[0].magnitude().powi(3).max(known);
        near(found.jacobian.determinant().abs(), known, 1e-8 * scale.max(1e-6));
        let product: f64 = found.multipliers().iter().map(|multiplier| multiplier.magnitude()).product();
        near_relative(product, known, 1e-6);
    }
    assert!(seen >= 15, "{seen}");
}

/// A circuit that takes hardly any force leaves the events of a branch where they are without it: folds of
/// symmetric motions, folds of motions in one well, and a breaking of the symmetry.
#[test]
fn events_beside_a_circuit_that_takes_no_force_are_those_without_it() {
    let mut random = Noise::new(48);
    for (coefficients, damping, frequency, amplitudes, event) in [
        ("[0, 1, 0, 1]", 0.1, 0.22, (0.01, 0.06), "fold"),
        ("[0, 1, 0.6, 1]", 0.1, 0.22, (0.01, 0.08), "fold"),
        ("[0, 1, 0, 1]", 0.05, 0.159, (0.05, 0.5), "symmetry"),
    ] {
        let text = |transducer: &str| {
            document(&format!(
                "mass_g: 1000, mechanism: Polynomial(coefficients_si: {coefficients}), \
                 damping: Coefficient(c_n_s_per_m: {damping}), transducer: {transducer}, \
                 excitation: Sine(frequency_hz: {frequency}, amplitude_g: {}), \
                 start: At(x_mm: 0, v_m_per_s: 0), \
                 run: (duration_s: 3000, settle_s: 2900)",
                amplitudes.0
            ))
        };
        let events = |transducer: &str| {
            let found = over_amplitude(&text(transducer), amplitudes, Some(1));
            let named = found
                .events
                .iter()
                .zip(&found.values)
                .filter_map(|(event, value)| event.map(|event| (event.name(), *value)));
            (named.collect::<Vec<_>>(), found.unlocated)
        };
        let (known, _) = events("None");
        assert!(known.iter().any(|(name, _)| *name == event), "{event}: {known:?}");
        for is_coil in [true, false] {
            let mut oscillator = Oscillator::random(&mut random);
            (oscillator.coupling, oscillator.is_coil) = (1e-7, is_coil);
            let (found, unlocated) = events(&oscillator.transducer());
            assert_eq!((found.len(), &unlocated[..]), (known.len(), &[][..]), "{found:?} {known:?}");
            for ((name, value), (known_name, known_value)) in found.iter().zip(&known) {
                assert_eq!(name, known_name);
                near_relative(*value, *known_value, 1e-8);
            }
        }
    }
}

/// A branch over the amplitude touches the stop first where the steady motion reaches it. It begins at an
/// amplitude at which the transient, of at most twice the steady motion, does not touch it either.
#[test]
fn grazing_beside_a_circuit_is_where_the_response_reaches_the_stop() {
    let mut random = Noise::new(43);
    for _ in 0..12 {
        let oscillator = Oscillator::random(&mut random);
        let reach_mm = random.between(20.0, 80.0);
        let grazing_g = reach_mm * 1e-3 / oscillator.response() / STANDARD_GRAVITY;
        let restitution = random.between(0.5, 0.95);
        let scene = Oscillator { amplitude_g: 0.45 * grazing_g, ..oscillator };
        let rest = format!(
            "stops: Uneven(right_mm: {reach_mm:?}, restitution_right: {restitution:?}), start: At(x_mm: 0, \
             v_m_per_s: 0), run: (duration_s: 900, settle_s: 800, tolerance: 1e-12)"
        );
        let document = document(&scene.text(&rest));
        let branch = over_amplitude(&document, (0.45 * grazing_g, 1.002 * grazing_g), None);
        let found = at(&branch, BranchEvent::Grazing);
        assert_eq!(found.len(), 1, "{found:?} {grazing_g}");
        near_relative(found[0], grazing_g, 1e-8);
    }
}
