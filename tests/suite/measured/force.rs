//! Force curves of slow pulls, exact and with noise of known size, and the mechanism that is made of them.

use interwell::mechanics::Mechanism;
use interwell::output::{header, rows};
use interwell::study::{FORCE_POINTS, Unidentified, force};

use super::{Noise, SEEDS, covered, holds, number};

const LINEAR: f64 = -40.0;
const CUBIC: f64 = 8e5;
const FRICTION: f64 = 0.01;
const WELL: f64 = 7.071_067_811_865_476e-3;

fn of(x: f64) -> f64 {
    LINEAR * x + CUBIC * x.powi(3)
}

/// A pull there and back over 9 mm either way, with friction, and noise of these standard deviations in m and
/// N.
fn pull(noise: (f64, f64), samples: u32, seed: u64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Noise::new(seed);
    let along = |i: u32| -9e-3 + 18e-3 * f64::from(i) / f64::from(samples);
    let there = (0..=samples).map(|i| (along(i), FRICTION));
    let back = (0..samples).rev().map(|i| (along(i), -FRICTION));
    let measured =
        |(x, friction): (f64, f64)| (x + noise.0 * random.next(), of(x) + friction + noise.1 * random.next());
    there.chain(back).map(measured).unzip()
}

#[test]
fn without_noise_the_curve_and_its_landscape_have_their_digits() {
    let (x, measured) = pull((0.0, 0.0), 20_000, 0);
    let found = force(&x, &measured, FORCE_POINTS).unwrap();
    let column = |name: &str| found.rows.numbers(name).unwrap();
    assert_eq!(found.rows.rows(), FORCE_POINTS);
    for (i, x) in column("x_m").iter().enumerate().skip(1).take(FORCE_POINTS - 2) {
        assert!((column("force_n")[i] - of(*x)).abs() < 1e-12, "{x}");
        assert!((column("force_rising_n")[i] - column("force_falling_n")[i] - 2.0 * FRICTION).abs() < 1e-12);
    }
    let barrier = LINEAR.powi(2) / (4.0 * CUBIC);
    let range = column("x_m")[FORCE_POINTS - 1] - column("x_m")[0];
    for (name, exact, bound) in [
        ("left_well_m", -WELL, 1e-11),
        ("right_well_m", WELL, 1e-11),
        ("barrier_m", 0.0, 1e-11),
        ("left_well_stiffness_n_per_m", -2.0 * LINEAR, 1e-7),
        ("barrier_stiffness_n_per_m", LINEAR, 1e-7),
        ("barrier_from_left_j", barrier, 1e-12),
        ("barrier_from_right_j", barrier, 1e-12),
        ("hysteresis_n", 2.0 * FRICTION, 1e-12),
        ("hysteresis_j", 2.0 * FRICTION * range, 1e-12),
    ] {
        let own = number(&found, name);
        assert!((own.value - exact).abs() < bound, "{name}: {} is not {exact}", own.value);
    }
}

#[test]
fn with_noise_the_intervals_hold_the_numbers_in_95_of_100_records() {
    let barrier = LINEAR.powi(2) / (4.0 * CUBIC);
    let exact = [
        ("left_well_m", -WELL),
        ("right_well_stiffness_n_per_m", -2.0 * LINEAR),
        ("barrier_m", 0.0),
        ("barrier_from_left_j", barrier),
        ("hysteresis_n", 2.0 * FRICTION),
    ];
    for noise in [(0.0, 5e-3), (1e-5, 1e-3)] {
        let mut hits = [0; 5];
        for seed in 0..SEEDS {
            let (x, measured) = pull(noise, 4000, seed);
            let found = force(&x, &measured, 51).unwrap();
            for (hits, (name, exact)) in hits.iter_mut().zip(exact) {
                *hits += u64::from(holds(number(&found, name), exact));
            }
        }
        for (hits, (name, _)) in hits.into_iter().zip(exact) {
            covered(hits, name);
        }
    }
}

#[test]
fn the_curve_is_a_table_that_makes_a_mechanism() {
    let (x, measured) = pull((1e-6, 2e-4), 20_000, 3);
    let found = force(&x, &measured, FORCE_POINTS).unwrap();
    let text = header(&found.rows) + &rows(&found.rows, 0..found.rows.rows());
    let mechanism = Mechanism::from_table(&text, 1e-3).unwrap();
    let wells: Vec<f64> =
        mechanism.landscape.equilibria.iter().filter(|own| own.stable).map(|own| own.x).collect();
    assert!(
        wells.len() == 2 && (wells[1] - WELL).abs() < 5e-6 && (wells[0] + WELL).abs() < 5e-6,
        "{wells:?}"
    );
    let barrier = mechanism.landscape.barrier.unwrap();
    assert!((barrier.from_left_j - number(&found, "barrier_from_left_j").value).abs() < 1e-6);
}

#[test]
fn one_direction_is_said_to_be_one_and_too_little_is_refused() {
    let (x, measured) = pull((0.0, 0.0), 4000, 0);
    let found = force(&x[..4000], &measured[..4000], FORCE_POINTS).unwrap();
    assert!(found.remarks.iter().any(|own| own.contains("one direction")), "{:?}", found.remarks);
    assert!(found.rows.numbers("force_falling_n").unwrap().iter().all(|own| own.is_nan()));
    assert!(matches!(force(&[1.0; 9], &[0.0; 9], FORCE_POINTS), Err(Unidentified::Still)));
    assert!(matches!(force(&x[..50], &measured[..50], 101), Err(Unidentified::FewSamples { .. })));
}
