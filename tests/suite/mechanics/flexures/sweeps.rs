//! Preload and sizes in small steps: each is solved, and no force jumps between them.

use super::*;

/// Curves at these preloads in m, ascending.
fn swept(preloads: &[f64]) -> Vec<ForceCurve> {
    preloads.iter().map(|preload| solve(&Geometry { preload: *preload, ..prototype() }).0).collect()
}

/// That the force at each fixed x goes on from one curve to the next as it did before: it may not be further
/// from the line through the last two than the steps themselves are long.
#[track_caller]
fn no_jump(preloads: &[f64], curves: &[ForceCurve], positions: &[f64], allowed: f64) {
    for x in positions {
        let known: Vec<(f64, f64)> = preloads
            .iter()
            .zip(curves)
            .map(|(p, curve)| (*p, curve.force(*x)))
            .filter(|(_, f)| !f.is_nan())
            .collect();
        assert!(known.len() > 100, "{} of {} curves reach {x:e}", known.len(), curves.len());
        for pair in known.windows(2) {
            let step = (pair[1].1 - pair[0].1).abs();
            assert!(
                step <= allowed,
                "{step:e} N at x = {x:e} from preload {:e} to {:e}",
                pair[0].0,
                pair[1].0
            );
        }
    }
}

#[test]
fn preload_from_none_to_much() {
    let preloads: Vec<f64> = (0..=160).map(|i| 4e-3 * f64::from(i) / 160.0).collect();
    let curves = swept(&preloads);
    // Inside the kinks the force hardly knows the preload.
    no_jump(&preloads[20..], &curves[20..], &[1e-4, 5e-4, 1e-3, 2e-3], 6e-3);
    let mut last = 0.0;
    for (preload, curve) in preloads.iter().zip(&curves).skip(1) {
        let landscape = Mechanism::new(curve.clone()).landscape;
        let kink = landscape.kinks.last().unwrap_or_else(|| panic!("{preload:e}")).x;
        assert!(kink > last && landscape.barrier.is_some(), "{preload:e}");
        last = kink;
    }
}

/// Through the two thresholds, at which wells and then a bump appear, in steps of a nanometre and finer.
#[test]
fn preload_through_the_thresholds() {
    let coarse = (0..=100).map(|i| 1.30e-6 + 1e-9 * f64::from(i));
    let fine = (-20..=20).flat_map(|i| [1.315e-6, 1.377e-6].map(|at| at + 2e-11 * f64::from(i)));
    let mut preloads: Vec<f64> = coarse.chain(fine).collect();
    preloads.sort_by(f64::total_cmp);
    let curves = swept(&preloads);
    // A nanometre of preload changes the compression by 4 mN and the slope by half a newton per metre.
    no_jump(&preloads, &curves, &[1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 2.5e-3], 3e-3);
    for x in [1e-5, 3e-5, 1e-4] {
        no_jump(&preloads, &curves, &[x], 1.0 * x);
    }
    // Wells and kinks appear once and stay.
    let count = |of: fn(&Mechanism) -> usize| -> Vec<usize> {
        curves.iter().map(|curve| of(&Mechanism::new(curve.clone()))).collect()
    };
    let (wells, kinks) = (
        count(|mechanism| mechanism.landscape.equilibria.iter().filter(|e| e.stable).count()),
        count(|mechanism| mechanism.landscape.kinks.len()),
    );
    for (all, most) in [(wells, 2), (kinks, 2)] {
        assert!(all.windows(2).all(|pair| pair[0] <= pair[1]), "{all:?}");
        assert_eq!(all.last(), Some(&most));
    }
}

/// Every preload on a logarithmic scale is solved, down to what is nothing beside a straight beam's own
/// compression.
#[test]
fn preload_of_any_size() {
    for i in 0..=80 {
        let preload = 1e-15 * 10.0_f64.powf(12.8 * f64::from(i) / 80.0);
        let (curve, flexures) = solve(&Geometry { preload, ..prototype() });
        assert!(flexures.accuracy().outer_force <= 1e-8, "{preload:e}");
        assert!(curve.domain().1 >= 2.6e-3 * (1.0 - 1e-12));
    }
}

/// Thickness, length and bow, each in small steps: the force at one place follows.
#[test]
fn other_sizes() {
    for name in ["thickness", "length", "bow"] {
        let forces: Vec<f64> = (0..=40)
            .map(|i| {
                let mut geometry = prototype();
                let part = f64::from(i) / 40.0;
                match name {
                    "thickness" => geometry.thickness *= 1.0 + 0.5 * part,
                    "length" => geometry.parallel.length *= 1.0 + 0.1 * part,
                    _ => geometry.initial_bow = 3e-4 * part,
                }
                solve(&geometry).0.force(3e-3)
            })
            .collect();
        let bends = forces.windows(3).map(|f| (f[0] - 2.0 * f[1] + f[2]).abs());
        let steps = forces.windows(2).map(|f| (f[1] - f[0]).abs());
        let (bend, step) = (bends.fold(0.0, f64::max), steps.fold(0.0, f64::max));
        assert!(bend < 0.2 * step, "{name}: {forces:?}");
    }
}
