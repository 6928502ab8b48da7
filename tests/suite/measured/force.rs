//! Force curves of slow pulls, exact and with noise of known size, and the mechanism that is made of them.

use interwell::mechanics::Mechanism;
use interwell::output::{header, rows};
use interwell_studies::study::{FORCE_POINTS, Unidentified, force};

use super::{Noise, SEEDS, covered, hold_95_of_100, holds, number};
use crate::properties::harness::multiplied;

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
    let found = force(&x, &measured, None).unwrap();
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
        let identity = number(&found, name);
        assert!((identity.value - exact).abs() < bound, "{name}: {} is not {exact}", identity.value);
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
            let found = force(&x, &measured, Some(51)).unwrap();
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
fn wells_are_found_where_the_range_ends_shortly_beyond_them() {
    // by 0.3 % of the range, with and without friction, and with a turn over which the friction changes
    // slowly
    let end = WELL * 1.006;
    for (friction, over) in [(0.0, 0.0), (FRICTION, 0.0), (FRICTION, 1e-5)] {
        let along = |i: u32| -end + 2.0 * end * f64::from(i) / 4000.0;
        let slowly = |since: f64| if over > 0.0 { 1.0 - 2.0 * (-since / over).exp() } else { 1.0 };
        let there = (0..=4000).map(|i| (along(i), of(along(i)) + friction * slowly(along(i) + end)));
        let back = (0..4000).rev().map(|i| (along(i), of(along(i)) - friction * slowly(end - along(i))));
        let (x, measured): (Vec<f64>, Vec<f64>) = there.chain(back).unzip();
        let found = force(&x, &measured, None).unwrap();
        for (name, exact) in [("left_well_m", -WELL), ("barrier_m", 0.0), ("right_well_m", WELL)] {
            let bound = if over > 0.0 { 5e-6 } else { 1e-12 };
            assert!((number(&found, name).value - exact).abs() < bound, "{name} {friction} {over}");
        }
        let barrier = LINEAR.powi(2) / (4.0 * CUBIC);
        assert!((number(&found, "barrier_from_left_j").value / barrier - 1.0).abs() < 1e-4);
        if friction == 0.0 {
            let found = force(&x[..4001], &measured[..4001], None).unwrap();
            assert!((number(&found, "left_well_m").value + WELL).abs() < 1e-12);
        }
    }
}

/// A force with kinks near its wells, which lie 2 um beyond them: stiffness -71 N/m at 0, 139 N/m inside the
/// kinks and 4000 N/m beyond.
fn kinked(x: f64) -> f64 {
    let kink = 7.179e-3;
    let inside = |x: f64| -71.0 * x + 1.3592e6 * x.powi(3);
    let beyond = (x.abs() - kink).max(0.0);
    inside(x) + (x.signum()) * (3860.0 * beyond + 4e6 * beyond * beyond)
}

#[test]
fn wells_beside_a_kink_are_held_by_their_intervals() {
    // the zero beyond the kink, by bisection
    let (mut low, mut high) = (7.0e-3, 7.4e-3);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if kinked(middle) < 0.0 { low = middle } else { high = middle }
    }
    let barrier = {
        let steps = 200_000;
        let h = low / f64::from(steps);
        -(0..steps).map(|i| kinked((f64::from(i) + 0.5) * h)).sum::<f64>() * h
    };
    let slope = (kinked(low + 1e-9) - kinked(low - 1e-9)) / 2e-9;
    let records = multiplied(40) as usize;
    let mut hits = [0; 3];
    let mut random = Noise::new(4);
    for _ in 0..records {
        let noise = random.of_any_size(1e-5, 2e-3);
        let end = random.between(7.3e-3, 7.6e-3);
        let along = |i: u32| -end + 2.0 * end * f64::from(i) / 4000.0;
        let there = (0..=4000).map(|i| (along(i), kinked(along(i)) + FRICTION));
        let back = (0..4000).rev().map(|i| (along(i), kinked(along(i)) - FRICTION));
        let (x, measured): (Vec<f64>, Vec<f64>) =
            there.chain(back).map(|(x, force)| (x, force + noise * random.next())).unzip();
        let found = force(&x, &measured, None).unwrap();
        let exact = [
            ("right_well_m", low),
            ("right_well_stiffness_n_per_m", slope),
            ("barrier_from_right_j", barrier),
        ];
        for (hits, (name, exact)) in hits.iter_mut().zip(exact) {
            *hits += usize::from(holds(number(&found, name), exact));
        }
        assert!(found.remarks.iter().any(|remark| remark.contains("kink at 7.1")), "{:?}", found.remarks);
    }
    for (hits, what) in hits.into_iter().zip(["well", "stiffness", "barrier"]) {
        hold_95_of_100(hits, records, what);
    }
}

#[test]
fn the_curve_is_a_table_that_makes_a_mechanism() {
    let (x, measured) = pull((1e-6, 2e-4), 20_000, 3);
    let found = force(&x, &measured, None).unwrap();
    let text = header(&found.rows) + &rows(&found.rows, 0..found.rows.rows());
    let mechanism = Mechanism::from_table(&text, 1e-3).unwrap();
    let wells: Vec<f64> = mechanism.landscape.equilibria.iter().filter(|e| e.stable).map(|e| e.x).collect();
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
    let found = force(&x[..4000], &measured[..4000], None).unwrap();
    assert!(found.remarks.iter().any(|remark| remark.contains("one direction")), "{:?}", found.remarks);
    assert!(found.rows.numbers("force_falling_n").unwrap().iter().all(|force| force.is_nan()));
    assert!(matches!(force(&[1.0; 9], &[0.0; 9], None), Err(Unidentified::Still)));
    assert!(matches!(force(&x[..50], &measured[..50], Some(101)), Err(Unidentified::FewSamples { .. })));
}

#[test]
fn a_curve_has_as_many_points_as_its_samples_allow() {
    let (x, measured) = pull((1e-6, 1e-4), 200, 7);
    let found = force(&x, &measured, None).unwrap();
    let points = found.rows.rows();
    assert!((30..FORCE_POINTS).contains(&points), "{points}");
    assert_eq!(force(&x, &measured, Some(points)), Ok(found));
    for more in points + 1..=FORCE_POINTS {
        assert_eq!(force(&x, &measured, Some(more)), Err(Unidentified::FewSamples(x.len(), more)));
    }
    let too_few = Unidentified::FewSamples(9, 4);
    for points in [None, Some(4), Some(101)] {
        assert_eq!(force(&x[..9], &measured[..9], points), Err(too_few.clone()));
    }
    assert!(too_few.to_string().contains("record more") && !too_few.to_string().contains("--points"));
}
