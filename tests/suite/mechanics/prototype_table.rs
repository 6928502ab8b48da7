//! The curve fitted to the prototype's table: its pieces, landscape, potential and smoothness.

use interwell::mechanics::{ForceTable, Mechanism};
use interwell::scene;

use super::{PROTOTYPE, build, close, fault_of, integral, keeps_its_promises};

#[test]
fn the_prototype_is_few_pieces() {
    let table = ForceTable::parse(PROTOTYPE).unwrap();
    assert_eq!(table.x.len(), 325);
    for (tolerance, most) in [(1e-2, 3), (1e-3, 11), (1e-4, 9), (1e-5, 13)] {
        let curve = keeps_its_promises(&table, tolerance);
        assert!(curve.is_odd());
        assert!(curve.pieces().len() <= most, "{tolerance:e}: {} pieces", curve.pieces().len());
        assert!(curve.fit().unwrap().warnings.is_empty());
        close(curve.fit().unwrap().scale_n, 0.2031592, 1e-12);
    }
}

#[test]
fn the_prototype_has_two_wells_and_two_corners() {
    let mechanism = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap();
    let [left, top, right] = mechanism.landscape.equilibria[..] else { panic!("{:?}", mechanism.landscape) };
    assert!((right.x - 6.882862e-3).abs() < 2e-7);
    assert_eq!((left.x, top.x), (-right.x, 0.0));
    assert!(left.stable && !top.stable && right.stable);
    close(right.stiffness_left, 146.0, 0.02);
    assert_eq!(mechanism.damping_stiffness(), Some(right.stiffness_left));
    let [_, corner] = mechanism.landscape.kinks[..] else { panic!("{:?}", mechanism.landscape.kinks) };
    assert_eq!(corner.x, 7.179338e-3);
    close(corner.stiffness_left, 165.0, 0.02);
    close(corner.stiffness_right, 4430.0, 0.02);
    let barrier = mechanism.landscape.barrier.unwrap();
    close(barrier.from_right_j, 0.94e-3, 0.05);
    assert_eq!(barrier.from_left_j, barrier.from_right_j);
    let [_, least] = mechanism.landscape.extrema[..] else { panic!("{:?}", mechanism.landscape.extrema) };
    assert!((least.x - 3.91e-3).abs() < 5e-5);
    assert!((least.force + 0.20316).abs() < 2e-5);
}

#[test]
fn the_presets_table_is_the_embedded_one() {
    let described = scene::Mechanism::Table { path: "force_dl2.7.csv".into(), tolerance: 1e-4 };
    assert_eq!(build(described).curve, Mechanism::from_table(PROTOTYPE, 1e-4).unwrap().curve);
    let described = scene::Mechanism::Table { path: "nowhere.csv".into(), tolerance: 1e-4 };
    let fault = fault_of(&described);
    assert_eq!((fault.field.as_str(), fault.value.as_str()), ("mechanism.path", "nowhere.csv"));
}

#[test]
fn potential_and_stiffness_belong_to_the_force() {
    let mechanism = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap();
    let curve = &mechanism.curve;
    assert_eq!(curve.potential(0.0), 0.0);
    for (i, piece) in curve.pieces().iter().enumerate() {
        let (left, right) = curve.piece_interval(i);
        let rise = curve.potential(right) - curve.potential(left);
        let expected = integral(|x| piece.force(x), left, right);
        assert!((rise - expected).abs() < 1e-12 * expected.abs().max(1e-3), "{rise:e} {expected:e}");
        let change = piece.potential_change(left, right);
        assert!((change - expected).abs() < 1e-12 * expected.abs().max(1e-3), "{change:e} {expected:e}");
        let x = 0.3 * left + 0.7 * right;
        let h = 1e-3 * (right - left);
        let slope = (piece.force(x - 2.0 * h) - 8.0 * piece.force(x - h) + 8.0 * piece.force(x + h)
            - piece.force(x + 2.0 * h))
            / (12.0 * h);
        close(curve.stiffness(x), slope, 1e-8);
    }
    assert!(curve.force(8.001e-3).is_nan() && curve.potential(-8.001e-3).is_nan());
}

/// Between samples the fit stays near the parabolas through three neighbours on either side.
#[test]
fn the_prototype_does_not_wiggle() {
    let table = ForceTable::parse(PROTOTYPE).unwrap();
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let curve = keeps_its_promises(&table, tolerance);
        for i in 0..table.x.len() - 3 {
            let (x, f) = (&table.x[i..i + 4], &table.force[i..i + 4]);
            if x.iter().any(|x| (x.abs() - 7.179338e-3).abs() < 1e-9) || x[3].abs().max(x[0].abs()) > 7.2e-3 {
                continue;
            }
            let parabola = |at: f64, k: usize| {
                (k..k + 3)
                    .map(|a| {
                        (k..k + 3).filter(|b| *b != a).fold(f[a], |w, b| w * (at - x[b]) / (x[a] - x[b]))
                    })
                    .sum::<f64>()
            };
            for part in [0.25, 0.5, 0.75] {
                let at = x[1] + part * (x[2] - x[1]);
                let (one, other) = (parabola(at, 0), parabola(at, 1));
                let off = (curve.force(at) - 0.5 * (one + other)).abs();
                assert!(off < 3.0 * tolerance * 0.203 + (one - other).abs(), "{off:e} at {at:e}");
            }
        }
    }
}
