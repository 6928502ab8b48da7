//! The sum of the exponents beside circuits that are faster than the motion, against its exact value.

use std::sync::atomic::AtomicBool;

use interwell::dynamics::Model;
use interwell_studies::study::{ExponentOptions, exponents};
use proptest::prelude::*;

use crate::properties::harness::hold_for;
use crate::support::{build, model};

/// A mass on a spring that hardens, a circuit whose state decays by so many powers of e in a forcing period,
/// and a stop on one side.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    powers: f64,
    is_coil: bool,
    coupling: f64,
    cubic: f64,
    damping: f64,
    frequency_hz: f64,
    amplitude_g: f64,
    stop_mm: Option<f64>,
}

impl Drawn {
    fn text(&self) -> String {
        let Self { powers, is_coil, coupling, cubic, damping, frequency_hz, amplitude_g, stop_mm } = *self;
        let rate = powers * frequency_hz;
        let circuit = match is_coil {
            // R / L, with L = 50 mH
            true => format!(
                "Electromagnetic(coupling_v_s_per_m: {coupling:?}, coil_ohm: {:?}, load_ohm: {:?}, \
                 inductance_mh: 50)",
                0.02 * rate,
                0.03 * rate
            ),
            // 1 / (R C), with C = 12 nF
            false => format!(
                "Piezoelectric(coupling_n_per_v: {:?}, capacitance_nf: 12, load_kohm: {:?})",
                1e-4 * coupling,
                1e-3 / (12e-9 * rate)
            ),
        };
        let stop = stop_mm
            .map_or_else(|| "None".into(), |at| format!("Uneven(right_mm: {at:?}, restitution_right: 0.44)"));
        format!(
            "mass_g: 40, mechanism: Polynomial(coefficients_si: [0, 12, 0, {cubic:?}]), \
             damping: Coefficient(c_n_s_per_m: {damping:?}), stops: {stop}, transducer: {circuit}, \
             excitation: Sine(frequency_hz: {frequency_hz:?}, amplitude_g: {amplitude_g:?}), \
             start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 60, settle_s: 30, tolerance: 1e-12)"
        )
    }
}

fn drawn() -> impl Strategy<Value = Drawn> {
    let circuit = (1.0..7.5_f64, any::<bool>(), 0.5..8.0_f64);
    let motion = (0.0..200.0_f64, 0.02..0.4_f64, 0.8..4.0_f64, 0.1..5.0_f64);
    let stop = prop_oneof![Just(None), (20.0..250.0_f64).prop_map(Some)];
    let all = (circuit, motion, stop);
    all.prop_map(|((power, is_coil, coupling), (cubic, damping, frequency_hz, amplitude_g), stop_mm)| Drawn {
        powers: power.exp(),
        is_coil,
        coupling,
        cubic,
        damping,
        frequency_hz,
        amplitude_g,
        stop_mm,
    })
}

/// The sum by the determinants, that by damping, circuit and impacts, and that of the three exponents; none
/// where the mass rests or a touch without speed has no exponents.
fn sums(model: &Model) -> Option<[f64; 3]> {
    let options = ExponentOptions { periods: 30, until_settled: Some(200.0), circuits: true };
    let found = exponents(model, &options, &AtomicBool::new(false)).ok().filter(|found| !found.rests())?;
    let all = [found.first, found.second, found.third?].map(|estimate| estimate.per_s);
    Some([found.sum, found.exact_sum?, all.iter().sum()])
}

#[test]
fn the_sum_is_exact_beside_a_circuit_of_any_speed() {
    let check = |drawn: &Drawn| {
        let Some([sum, exact, of_all]) = sums(&model(&drawn.text())) else { return Ok(false) };
        prop_assert!((sum / exact - 1.0).abs() < 1e-8, "{sum} is not {exact}");
        prop_assert!((of_all / exact - 1.0).abs() < 1e-12, "{of_all} is not {exact}");
        Ok(true)
    };
    hold_for("stiff circuits", 60, 0.6, drawn(), Drawn::text, check);
}

/// A circuit that keeps exp(-226) of its state in a period, beside a linear spring and a stop.
#[test]
fn the_sum_of_a_stiff_circuit() {
    let text =
        "(mass_g: 39.21758192521698, mechanism: Polynomial(coefficients_si: [0.0, 11.873573379600263]),
        damping: Coefficient(c_n_s_per_m: 0.23865158263107739),
        stops: Uneven(right_mm: 167.3911495985048, restitution_right: 0.4418084047097165),
        transducer: Piezoelectric(coupling_n_per_v: 0.0004243766310896574, capacitance_nf: 12.123582869719403,
            load_kohm: 326.75458401865137),
        excitation: Sine(frequency_hz: 1.1168980479001762, amplitude_g: 5.514598139501643,
            phase_deg: -97.17255782314479),
        start: At(x_mm: 0.0, v_m_per_s: 0.0),
        run: (duration_s: 537.2021207558109, settle_s: 447.6684339631758, tolerance: 1e-12))";
    let document = interwell::scene::Document::from_text("stiff", text, Default::default()).unwrap();
    let [sum, exact, of_all] = sums(&build(&document)).unwrap();
    assert!((exact + 262.1685).abs() < 1e-4 && (of_all / exact - 1.0).abs() < 1e-12, "{exact} {of_all}");
    assert!((sum / exact - 1.0).abs() < 1e-9, "{sum} is not {exact}");
}
