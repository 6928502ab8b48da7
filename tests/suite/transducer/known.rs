//! Known results: the piezoelectric double well of Erturk, Hoffmann and Inman, and white noise.

use interwell::dynamics::{Regime, Request};
use interwell::scene::FieldPath;

use crate::support::*;

#[test]
fn the_double_well_of_erturk_hoffmann_and_inman_is_chaotic_or_on_its_large_orbit() {
    // Appl. Phys. Lett. 94, 254102 (2009): x'' + 2 z x' - x (1 - x^2)/2 - chi u = f cos W t,
    // u' + lambda u + kappa x' = 0, z = 0.01, chi = 0.05, kappa = 0.5, lambda = 0.05, f = 0.083, W = 0.8.
    // Of the other sign of the voltage k = chi, C = chi/kappa = 0.1 F, R = 1/(lambda C) = 200 ohm.
    let document = documented("Harvester of Erturk, Hoffmann and Inman");
    near_relative(FieldPath::new("transducer.load_kohm").get(&document.scene).unwrap(), 0.2, 1e-15);
    let from = |v: f64, transducer: Option<&str>| {
        let mut document = document.clone();
        document.set(&format!("start.v_m_per_s={v}")).unwrap();
        if let Some(transducer) = transducer {
            document.set(&format!("transducer={transducer}")).unwrap();
        }
        run(&build(&document)).summary
    };
    let (chaotic, large) = (from(0.0, None), from(1.3, None));
    assert_eq!((chaotic.regime, chaotic.period), (Regime::Irregular, None));
    assert_eq!((large.regime, large.period), (Regime::Interwell, Some(1)));
    assert_eq!(large.crossings, 800);
    let power = |summary: &interwell::dynamics::Summary| summary.harvest.unwrap().mean_load_power.unwrap();
    assert!(power(&large) > 2.0 * power(&chaotic), "{} {}", power(&large), power(&chaotic));
    for summary in [chaotic, large] {
        assert!(summary.ledger.unwrap().energy_residual < 1e-9);
    }
    // the coil that the page has in place of the layer
    let page = include_str!("../../../docs/scene.md");
    let (_, coil) = page.split_once("R = lambda L:\n`").unwrap();
    let other = from(1.3, coil.split('`').next());
    near_relative(power(&other), power(&large), 1e-9);
    near_relative(other.rms_velocity.unwrap(), large.rms_velocity.unwrap(), 1e-9);
}

/// Mean power into a coil of 0.5 N s/m under white noise over some seeds, and its standard error, over m S/4.
fn under_noise(mechanism: &str, stops: &str) -> (f64, f64) {
    const SEEDS: u32 = 8;
    let (rms, band) = (1.0, 4.0);
    let powers: Vec<f64> = (0..SEEDS)
        .map(|seed| {
            let text = format!(
                "mass_g: 1000, mechanism: {mechanism}, stops: {stops}, \
                 transducer: Electromagnetic(coupling_v_s_per_m: 1, coil_ohm: 1, load_ohm: 1), \
                 excitation: Noise(rms_g: {}, low_hz: 0, high_hz: {band}, seed: {seed}, lines: 800), \
                 start: At(x_mm: 200, v_m_per_s: 0), run: (duration_s: 200, settle_s: 10, tolerance: 1e-6)",
                rms / 9.80665
            );
            let harvest = model(&text).run(&Request::default()).summary.harvest.unwrap();
            harvest.mean_load_power.unwrap() + harvest.mean_coil_power.unwrap()
        })
        .collect();
    // white noise of the one-sided density S gives a mass m S/4, whatever holds it
    let whole = 0.25 * rms * rms / band;
    let mean = powers.iter().sum::<f64>() / f64::from(SEEDS);
    let scatter = powers.iter().map(|power| (power - mean).powi(2)).sum::<f64>() / f64::from(SEEDS - 1);
    (mean / whole, (scatter / f64::from(SEEDS)).sqrt() / whole)
}

#[test]
fn white_noise_gives_a_damper_the_same_power_whatever_the_potential() {
    let one = "Cubic(linear_n_per_m: 1, cubic_n_per_m3: 0)";
    let two = "Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1)";
    let stops = |mm: f64, e: f64| format!("Rigid(travel_limit_mm: {mm}, restitution: {e})");
    let elastic = [(one, stops(600.0, 1.0)), (two, stops(1e3, 1.0))];
    let free = [(one, "None".to_owned()), (two, "None".to_owned())];
    for (mechanism, stops) in free.into_iter().chain(elastic) {
        let (mean, error) = under_noise(mechanism, &stops);
        assert!(error < 0.06, "{error}");
        // (a band up to 4 Hz leaves out a hundredth)
        near(mean, 1.0, 3.0 * error + 0.02);
    }
    for (mechanism, stops) in [(one, stops(300.0, 0.36)), (two, stops(1e3, 0.36))] {
        let (mean, error) = under_noise(mechanism, &stops);
        assert!(mean + 3.0 * error < 0.95, "{mechanism}: {mean} {error}");
    }
}
