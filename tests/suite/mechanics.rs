//! Statics: force curves, fitted tables, landscapes, flexures.

mod building;
mod flexures;
mod functions;
mod kinks;
mod polynomials;
mod prototype_table;
mod reading;
mod sums;
mod tables;
mod transverse;

use interwell::mechanics::{BuildError, ForceCurve, ForceTable, Mechanism, Piece, fit, force_scale};
use interwell::scene::{self, Files};

const PROTOTYPE: &str = include_str!("../../assets/force_dl2.7.csv");

fn build(described: scene::Mechanism) -> Mechanism {
    Mechanism::build(&described, &Files::default()).unwrap()
}

fn fault_of(described: &scene::Mechanism) -> scene::Fault {
    match Mechanism::build(described, &Files::default()) {
        Err(BuildError::Wrong(fault)) => fault,
        other => panic!("{other:?}"),
    }
}

fn polynomial(coefficients: &[f64]) -> Mechanism {
    build(scene::Mechanism::Polynomial { coefficients_si: coefficients.to_vec() })
}

fn close(a: f64, b: f64, relative: f64) {
    assert!((a - b).abs() <= relative * b.abs(), "{a:e} is not {b:e}");
}

/// A table of `force` at even steps; the positions of a symmetric range are symmetric bit for bit.
fn sampled(from: f64, to: f64, points: usize, force: impl Fn(f64) -> f64) -> ForceTable {
    let (middle, half, last) = (0.5 * (from + to), 0.5 * (to - from), points as f64 - 1.0);
    let x: Vec<f64> = (0..points).map(|i| middle + half * ((2.0 * i as f64 - last) / last)).collect();
    let force = x.iter().map(|x| force(*x)).collect();
    ForceTable { x, force }
}

/// What every fitted curve promises.
fn keeps_its_promises(table: &ForceTable, tolerance: f64) -> ForceCurve {
    let curve = fit(table, tolerance).unwrap();
    let largest = table.force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let allowed = tolerance * force_scale(table) + 1e-14 * largest;
    let worst =
        table.x.iter().zip(&table.force).map(|(x, f)| (curve.force(*x) - f).abs()).fold(0.0, f64::max);
    assert!(worst <= allowed, "{worst:e} > {allowed:e}");
    let report = curve.fit().unwrap();
    assert_eq!(report.worst_n, worst);
    assert_eq!(report.samples, Some(table.x.len()));
    assert_eq!(curve.domain(), (table.x[0], table.x[table.x.len() - 1]));
    assert_eq!(curve.pieces().len(), curve.breaks().len() + 1);
    assert!(curve.max_degree() < ForceCurve::MAX_COEFFICIENTS);
    for (i, x) in curve.breaks().iter().enumerate() {
        assert!(table.x.contains(x), "the break {x:e} is no sample");
        let (left, right) = (&curve.pieces()[i], &curve.pieces()[i + 1]);
        let size = terms(left, *x) + terms(right, *x);
        let jump = (left.force(*x) - right.force(*x)).abs();
        assert!(jump <= 4e-16 * size, "jump of {jump:e} at {x:e}, terms of {size:e}");
        // The potential is held to rounding of its terms, which is finer.
        let jump = (left.potential(*x) - right.potential(*x)).abs();
        let reach = (x - left.origin).abs().max((x - right.origin).abs());
        assert!(jump <= 1e-15 * (size * reach + left.potential(*x).abs()), "{jump:e}");
    }
    if curve.is_odd() {
        mirrors_bit_for_bit(&curve);
    }
    curve
}

fn terms(piece: &Piece, x: f64) -> f64 {
    piece.coefficients.iter().rev().fold(0.0, |sum, c| sum * (x - piece.origin).abs() + c.abs())
}

fn mirrors_bit_for_bit(curve: &ForceCurve) {
    let end = curve.domain().1.min(10.0);
    for i in 0..1000 {
        let x = end * i as f64 / 1000.0;
        assert_eq!(curve.force(-x), -curve.force(x));
        assert_eq!(curve.stiffness(-x), curve.stiffness(x));
        assert_eq!(curve.potential(-x), curve.potential(x));
        assert_eq!(curve.stiffness_on_both_sides(-x).0, curve.stiffness_on_both_sides(x).1);
    }
}

/// Ten-point Gauss-Legendre quadrature, exact to degree 19.
fn integral(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * NODES.iter().map(|(t, w)| w * (f(middle + half * t) + f(middle - half * t))).sum::<f64>()
}
