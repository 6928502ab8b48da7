//! Statics: force curves, fitted tables, landscapes; flexures in a module of their own.

mod flexures;

use std::sync::Arc;

use interwell::dynamics::{Model, Scales};
use interwell::mechanics::flexure::{Geometry, Group};
use interwell::mechanics::{
    BuildError, Equilibrium, ForceCurve, ForceTable as Table, Kink, Landscape, Mechanism, Piece, TableError,
    fit, force_scale,
};
use interwell::scene::{self, ColumnsError, Document, Files};
use proptest::prelude::*;

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
fn sampled(from: f64, to: f64, points: usize, force: impl Fn(f64) -> f64) -> Table {
    let (middle, half, last) = (0.5 * (from + to), 0.5 * (to - from), points as f64 - 1.0);
    let x: Vec<f64> = (0..points).map(|i| middle + half * ((2.0 * i as f64 - last) / last)).collect();
    let force = x.iter().map(|x| force(*x)).collect();
    Table { x, force }
}

fn text_of(table: &Table) -> String {
    let rows = table.x.iter().zip(&table.force).map(|(x, f)| format!("{x},{f}\n"));
    "x_m,force_n\n".chars().chain(rows.collect::<String>().chars()).collect()
}

/// What every fitted curve promises.
fn keeps_its_promises(table: &Table, tolerance: f64) -> ForceCurve {
    let curve = fit(table, tolerance).unwrap();
    let largest = table.force.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
    let allowed = tolerance * force_scale(table) + 1e-14 * largest;
    let worst =
        table.x.iter().zip(&table.force).map(|(x, f)| (curve.force(*x) - f).abs()).fold(0.0, f64::max);
    assert!(worst <= allowed, "{worst:e} > {allowed:e}");
    let report = curve.fit().unwrap();
    assert_eq!(report.worst_n, worst);
    assert_eq!(report.samples, table.x.len());
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

// --- Polynomials ---------------------------------------------------------------------------------

#[test]
fn a_cubic_has_its_exact_landscape() {
    let own = build(scene::Mechanism::Cubic { linear_n_per_m: -40.0, cubic_n_per_m3: 40.0 / 49e-6 });
    assert_eq!(own.curve.pieces().len(), 1);
    assert!(own.curve.is_odd());
    assert_eq!(own.curve.domain(), (f64::NEG_INFINITY, f64::INFINITY));
    let [left, top, right] = own.landscape.equilibria[..] else { panic!("{:?}", own.landscape) };
    close(right.x, 7e-3, 1e-15);
    assert_eq!(left.x, -right.x);
    assert_eq!(top.x, 0.0);
    assert!(left.stable && right.stable && !top.stable);
    close(right.stiffness_left, 80.0, 1e-14);
    assert_eq!(right.stiffness_left, right.stiffness_right);
    assert_eq!(top.stiffness_left, -40.0);
    let barrier = own.landscape.barrier.unwrap();
    close(barrier.from_right_j, 10.0 * 49e-6, 1e-14);
    assert_eq!(barrier.from_left_j, barrier.from_right_j);
    assert_eq!((barrier.x, barrier.left_well, barrier.right_well), (0.0, left.x, right.x));
    let [most, least] = own.landscape.extrema[..] else { panic!("{:?}", own.landscape) };
    close(least.x, 7e-3 / 3.0_f64.sqrt(), 1e-14);
    close(most.force, 40.0 * 7e-3 * 2.0 / (3.0 * 3.0_f64.sqrt()), 1e-14);
    assert_eq!((most.x, most.force), (-least.x, -least.force));
    assert!(own.landscape.kinks.is_empty());
    close(own.damping_stiffness().unwrap(), 80.0, 1e-14);
    assert_eq!(own.landscape.crossing_position(), Some(0.0));
}

#[test]
fn a_double_well_has_the_wells_and_the_barrier_it_names() {
    let own = build(scene::Mechanism::DoubleWell { equilibrium_mm: 7.0, barrier_mj: 0.5 });
    close(own.landscape.right_stable().unwrap().x, 7e-3, 1e-14);
    close(own.landscape.barrier.unwrap().from_left_j, 0.5e-3, 1e-14);
    close(own.damping_stiffness().unwrap(), 8.0 * 0.5e-3 / 49e-6, 1e-13);
}

#[test]
fn scaling_the_unit_of_length_scales_the_landscape() {
    for scale in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
        // F(x/scale): the wells -2, 0.5 and 3 with tops -1 and 1.
        let force = product(&[-2.0, -1.0, 0.5, 1.0, 3.0]);
        let scaled: Vec<f64> = force.iter().enumerate().map(|(i, c)| c / scale_power(scale, i)).collect();
        let own = polynomial(&scaled);
        let found: Vec<f64> = own.landscape.equilibria.iter().map(|e| e.x / scale).collect();
        assert_eq!(found.len(), 5, "{scale:e}: {found:?}");
        for (f, e) in found.iter().zip([-2.0, -1.0, 0.5, 1.0, 3.0]) {
            assert!((f - e).abs() < 1e-12, "{scale:e}: {found:?}");
        }
        let stable: Vec<bool> = own.landscape.equilibria.iter().map(|e| e.stable).collect();
        assert_eq!(stable, [true, false, true, false, true]);
        assert_eq!(own.landscape.extrema.len(), 4);
        let barrier = own.landscape.barrier.unwrap();
        assert!((barrier.x / scale).abs() < 1.0 + 1e-12, "the one nearest to 0: {barrier:?}");
    }
}

fn scale_power(scale: f64, i: usize) -> f64 {
    (0..i).fold(1.0, |p, _| p * scale)
}

fn product(roots: &[f64]) -> Vec<f64> {
    roots.iter().fold(vec![1.0], |p, r| {
        let mut next = vec![0.0; p.len() + 1];
        for (i, c) in p.iter().enumerate() {
            next[i + 1] += c;
            next[i] -= r * c;
        }
        next
    })
}

#[test]
fn a_touching_is_an_equilibrium_but_not_a_stable_one() {
    // (x - 1)^2 (x + 1): stable nowhere but at -1.
    let own = polynomial(&product(&[1.0, 1.0, -1.0]));
    let found: Vec<(f64, bool)> = own.landscape.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found, [(-1.0, true), (1.0, false)]);
    assert_eq!(own.landscape.barrier, None);
}

#[test]
fn a_cubic_well_is_stable_without_stiffness() {
    let own = polynomial(&[0.0, 0.0, 0.0, 2.0]);
    assert_eq!(own.landscape.equilibria.len(), 1);
    assert!(own.landscape.right_stable().unwrap().stable);
    assert_eq!(own.damping_stiffness(), None);
    assert!(own.landscape.extrema.is_empty(), "a level point is no extremum");
}

#[test]
fn no_force_and_a_constant_force_have_no_landscape() {
    for coefficients in [&[][..], &[0.0], &[0.0, 0.0, 0.0], &[9.81]] {
        let own = polynomial(coefficients);
        assert_eq!(own.landscape, Landscape::default());
        assert_eq!(own.damping_stiffness(), None);
        assert_eq!(own.landscape.crossing_position(), None);
    }
    assert!(polynomial(&[]).curve.is_odd());
    assert!(!polynomial(&[9.81]).curve.is_odd());
}

#[test]
fn too_many_coefficients_are_a_fault() {
    let described = scene::Mechanism::Polynomial { coefficients_si: vec![1.0; 17] };
    let fault = fault_of(&described);
    assert_eq!(fault.field, "mechanism.coefficients_si");
}

// --- The prototype's table -----------------------------------------------------------------------

#[test]
fn the_prototype_is_few_pieces() {
    let table = Table::parse(PROTOTYPE).unwrap();
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
    let own = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap();
    let [left, top, right] = own.landscape.equilibria[..] else { panic!("{:?}", own.landscape) };
    assert!((right.x - 6.882862e-3).abs() < 2e-7);
    assert_eq!((left.x, top.x), (-right.x, 0.0));
    assert!(left.stable && !top.stable && right.stable);
    close(right.stiffness_left, 146.0, 0.02);
    assert_eq!(own.damping_stiffness(), Some(right.stiffness_left));
    let [_, corner] = own.landscape.kinks[..] else { panic!("{:?}", own.landscape.kinks) };
    assert_eq!(corner.x, 7.179338e-3);
    close(corner.stiffness_left, 165.0, 0.02);
    close(corner.stiffness_right, 4430.0, 0.02);
    let barrier = own.landscape.barrier.unwrap();
    close(barrier.from_right_j, 0.94e-3, 0.05);
    assert_eq!(barrier.from_left_j, barrier.from_right_j);
    let [_, least] = own.landscape.extrema[..] else { panic!("{:?}", own.landscape.extrema) };
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
    let own = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap();
    let curve = &own.curve;
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
    let table = Table::parse(PROTOTYPE).unwrap();
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

// --- Other tables --------------------------------------------------------------------------------

#[test]
fn a_sampled_cubic_is_recovered() {
    let cubic = |x: f64| -40.0 * x + 8e5 * x * x * x;
    let curve = keeps_its_promises(&sampled(-9e-3, 9e-3, 61, cubic), 1e-4);
    assert_eq!((curve.pieces().len(), curve.max_degree(), curve.is_odd()), (1, 3, true));
    close(curve.pieces()[0].coefficients[1], -40.0, 1e-12);
    close(curve.pieces()[0].coefficients[3], 8e5, 1e-12);
    // Not odd, and as few points as there may be.
    let slanted = |x: f64| 3.0 - 2.0 * x + x * x * x;
    let curve = keeps_its_promises(&sampled(-1.0, 2.0, 4, slanted), 1e-6);
    assert_eq!((curve.pieces().len(), curve.max_degree(), curve.is_odd()), (1, 3, false));
    assert!((curve.force(0.37) - slanted(0.37)).abs() < 1e-13);
}

#[test]
fn an_even_number_of_odd_samples_is_odd_too() {
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 40, |x| x * x * x - 0.4 * x), 1e-4);
    assert!(curve.is_odd());
    assert_eq!(curve.pieces().len(), 1);
    assert_eq!(curve.force(0.0), 0.0);
}

#[test]
fn data_that_are_odd_but_for_noise_below_the_tolerance_are_odd() {
    let noise = |x: f64| 1e-5 * (1e4 * x).sin().abs();
    let table = sampled(-1.0, 1.0, 101, |x| x * x * x - 0.4 * x + noise(x));
    assert!(keeps_its_promises(&table, 1e-3).is_odd());
    assert!(!keeps_its_promises(&table, 1e-5).is_odd());
}

#[test]
fn a_corner_on_a_sample_is_found_and_one_between_samples_is_bracketed() {
    let bent =
        |at: f64| move |x: f64| if x > at { 5.0 * (x - at) + (x - at).powi(2) } else { 0.5 * (x - at) };
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 41, bent(0.25)), 1e-4);
    let corners = Landscape::of(&curve).kinks;
    assert_eq!(corners.len(), 1, "{corners:?}");
    assert_eq!(curve.pieces().len(), 2);
    assert!((corners[0].x - 0.25).abs() < 1e-15);
    close(corners[0].stiffness_left, 0.5, 1e-9);
    close(corners[0].stiffness_right, 5.0, 1e-9);
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 41, bent(0.27)), 1e-4);
    assert!(curve.pieces().len() <= 4, "{:?}", curve.breaks());
    assert!(curve.breaks().iter().all(|b| (b - 0.27).abs() < 0.1), "{:?}", curve.breaks());
}

#[test]
fn smooth_tables_have_no_corners() {
    type Shape = fn(f64) -> f64;
    let shapes: [Shape; 5] = [
        |x| (3.0 * x).sin(),
        |x| x.exp() - 1.0,
        |x| (5.0 * x).tanh() - x,
        |x| 1.0 / (1.2 - x),
        |x| (x + 1.01).ln(),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        for points in [12, 20, 40, 150, 1000] {
            for tolerance in [1e-2, 1e-4, 1e-6, 1e-9] {
                let curve = keeps_its_promises(&sampled(-1.0, 1.0, points, shape), tolerance);
                let corners = Landscape::of(&curve).kinks;
                assert!(corners.is_empty(), "shape {i}, {points} points, {tolerance:e}: {corners:?}");
                let error = (0..=5000)
                    .map(|k| -1.0 + k as f64 / 2500.0)
                    .map(|x| (curve.force(x) - shape(x)).abs())
                    .fold(0.0, f64::max);
                if points >= 150 && i < 3 {
                    let allowed = 3.0 * tolerance * curve.fit().unwrap().scale_n + 1e-7;
                    assert!(error < allowed, "shape {i}, {points} points, {tolerance:e}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn a_monostable_table_is_relative_to_its_largest_force() {
    let table = sampled(-1.0, 2.0, 31, |x| 3.0 * x + 0.1 * x * x);
    assert_eq!(force_scale(&table), 6.4);
    let curve = keeps_its_promises(&table, 1e-4);
    let own = Mechanism::new(curve);
    assert_eq!(own.landscape.equilibria.len(), 1);
    close(own.damping_stiffness().unwrap(), 3.0, 1e-9);
    assert!((own.landscape.crossing_position().unwrap()).abs() < 1e-12);
}

#[test]
fn noise_about_zero_makes_no_wells() {
    let mut state = 1_u64;
    let mut noise = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut table = sampled(-1.0, 1.0, 501, |x| 2.0 * x.powi(3));
    table.force.iter_mut().for_each(|f| *f += 1e-2 * noise());
    assert!(force_scale(&table) > 1.9);
    let curve = keeps_its_promises(&table, 1e-2);
    assert!(curve.pieces().len() <= 3, "{}", curve.pieces().len());
    // Asked to follow the noise, it does, and says so.
    let rough = keeps_its_promises(&table, 1e-5);
    assert!(rough.fit().unwrap().warnings.iter().any(|w| w.contains("pieces")), "{:?}", rough.fit());
}

#[test]
fn no_force_at_all_is_a_table_too() {
    let curve = keeps_its_promises(&sampled(-1.0, 1.0, 11, |_| 0.0), 1e-4);
    assert_eq!(Landscape::of(&curve), Landscape::default());
    // A dead zone between two springs: the force vanishes on an interval, which is no equilibrium.
    let dead = |x: f64| if x.abs() < 0.5 { 0.0 } else { 4.0 * (x - 0.5 * x.signum()) };
    let own = Mechanism::new(keeps_its_promises(&sampled(-1.0, 1.0, 41, dead), 1e-4));
    assert!(own.landscape.equilibria.is_empty(), "{:?}", own.landscape.equilibria);
    assert_eq!(own.landscape.kinks.len(), 2);
}

#[test]
fn the_unit_of_the_table_does_not_matter() {
    let table = Table::parse(PROTOTYPE).unwrap();
    let pieces = fit(&table, 1e-4).unwrap().breaks().to_vec();
    for (length, force) in [(1e-9, 1.0), (1e9, 1e-6), (1e3, 1e12)] {
        let scaled = Table {
            x: table.x.iter().map(|x| x * length).collect(),
            force: table.force.iter().map(|f| f * force).collect(),
        };
        let curve = keeps_its_promises(&scaled, 1e-4);
        assert_eq!(curve.breaks().len(), pieces.len());
        for (a, b) in curve.breaks().iter().zip(&pieces) {
            close(*a, b * length, 1e-14);
        }
    }
}

#[test]
fn a_large_table_is_fitted() {
    let table = sampled(-1.0, 1.0, 100_000, |x| (7.0 * x).sin() + x.abs().powi(3));
    let curve = keeps_its_promises(&table, 1e-4);
    assert!(curve.pieces().len() < 12, "{}", curve.pieces().len());
}

// --- Reading -------------------------------------------------------------------------------------

#[test]
fn the_layout_of_the_text_does_not_matter() {
    let plain = "x_m,force_n\n-1,2\n0,0\n1,-2\n2,1\n";
    let expected = Table::parse(plain).unwrap();
    for text in [
        "\u{feff}x_m,force_n\n-1,2\n0,0\n1,-2\n2,1\n",
        "x_m,force_n\r\n-1,2\r\n0,0\r\n1,-2\r\n2,1",
        "# a comment, with commas\n\n force_n , note, x_m \n2,a,-1\n# another\n0,,0\n-2,\"b, c\",1\n\n1,d,2\n",
        "x_m,force_n\n2,1\n1,-2\n0,0\n-1,2\n",
        "x_m,force_n\n-1.0e0, +2.000\n  0 ,0\n1,-2,9,9\n2,1\n",
        "x_m,force_n\r-1,2\r\r# a comment\r0,0\r1,-2\r2,1\r",
    ] {
        assert_eq!(Table::parse(text).as_ref(), Ok(&expected), "{text}");
    }
}

#[test]
fn what_is_wrong_with_a_table_is_said_with_its_line() {
    let error = |text: &str| Table::parse(text).unwrap_err();
    assert!(matches!(error(""), TableError::Columns(ColumnsError::Empty { .. })));
    assert!(matches!(error("# nothing\n"), TableError::Columns(ColumnsError::Empty { .. })));
    assert_eq!(error("x_m,force_n\n0,0\n1,1\n"), TableError::TooFew(2));
    let missing = error("# c\nx_mm,force_n\n1,2\n").to_string();
    assert!(
        missing.contains("line 2") && missing.contains("x_m;") && missing.contains("x_mm, force_n"),
        "{missing}"
    );
    assert!(error("x_m;force_n\n1;2\n").to_string().contains("x_m;force_n"));
    assert_eq!(error("x_m,x_m,force_n\n"), ColumnsError::RepeatedColumn { line: 1, column: "x_m" }.into());
    for bad in ["NaN", "inf", "-Infinity", "1e999", "one", "", "0x10", "1 2"] {
        let found = error(&format!("x_m,force_n\n0,0\n# c\n1,{bad}\n2,0\n3,0\n"));
        assert_eq!(found, ColumnsError::NoNumber { line: 4, column: "force_n", value: bad.into() }.into());
    }
    assert_eq!(
        error("x_m,force_n\n0,0\n1\n"),
        ColumnsError::NoNumber { line: 3, column: "force_n", value: String::new() }.into()
    );
    assert_eq!(error("x_m,force_n\n0,0\n1,1\n1,2\n2,2\n"), TableError::Repeated { line: 4, x: 1.0 });
    assert_eq!(
        error("x_m,force_n\n0,0\n1,1\n2,2\n1.5,2\n"),
        TableError::TurnsBack { line: 5, x: 1.5, before: 2.0 }
    );
    assert_eq!(
        error("x_m,force_n\r0,0\r1,one\r"),
        ColumnsError::NoNumber { line: 3, column: "force_n", value: "one".into() }.into()
    );
    for rest in ["c\n2,2,d\n3,3,e", "\n2,2\n3,3", "\n\",2,2\n3,3", ""] {
        let found = error(&format!("x_m,force_n,note\n-2,0,\"a, b\"\n-1,0\n0,0\n# c\n1,1,\"{rest}\n"));
        assert_eq!(found, ColumnsError::OpenQuote { line: 6 }.into());
    }
    let moves_a_cursor = error("x_m,force_n\n0,\u{1b}[2J\n").to_string();
    assert!(!moves_a_cursor.contains('\u{1b}'), "{moves_a_cursor}");
    let many = "0,0\n".repeat(100_002);
    assert_eq!(error(&format!("x_m,force_n\n{many}")), TableError::Columns(ColumnsError::TooMany(100_000)));
}

#[test]
fn millimetres_draw_a_warning() {
    let table = sampled(-8.0, 8.0, 33, |x| x * x * x - 40.0 * x);
    let curve = keeps_its_promises(&table, 1e-4);
    let [warning] = &curve.fit().unwrap().warnings[..] else { panic!("{:?}", curve.fit()) };
    assert!(warning.contains("16") || warning.contains("-8 m to 8 m"), "{warning}");
    assert!(warning.contains("divide"), "{warning}");
}

#[test]
fn numbers_at_the_ends_of_the_range_are_an_answer_or_an_error() {
    for length in [1e-300, 1e-150, 1e150, 1e300] {
        for force in [1e-300, 1e300] {
            let table = sampled(-length, length, 12, |x| force * ((x / length).powi(3) - 0.3 * x / length));
            if let Ok(curve) = fit(&table, 1e-4) {
                assert!(curve.pieces().iter().all(|p| p.coefficients.iter().all(|c| c.is_finite())));
                Landscape::of(&curve);
            }
        }
    }
}

#[test]
fn a_position_far_off_is_met_as_well() {
    for far in [1e3, 1e9, 1e17, 1e61, 1e150] {
        for force in [4.0, -0.5] {
            let text = format!("x_m,force_n\n2,1\n4,2\n5,4\n{far},{force}\n");
            let curve = fit(&Table::parse(&text).unwrap(), 1e-4).unwrap();
            assert!(curve.fit().unwrap().worst_n <= 1e-4 * 4.0, "{:?} at {far}", curve.fit());
        }
    }
}

// --- Curves of several pieces --------------------------------------------------------------------

/// Straight lines through the given points.
fn chain(points: &[(f64, f64)]) -> ForceCurve {
    let pieces = points
        .windows(2)
        .map(|p| Piece {
            origin: p[0].0,
            coefficients: vec![p[0].1, (p[1].1 - p[0].1) / (p[1].0 - p[0].0)],
            potential_at_origin: 0.0,
        })
        .collect();
    let breaks = points[1..points.len() - 1].iter().map(|p| p.0).collect();
    ForceCurve::from_pieces(pieces, breaks, (points[0].0, points[points.len() - 1].0), false, None)
}

#[test]
fn an_equilibrium_may_lie_on_a_corner() {
    let own =
        Landscape::of(&chain(&[(-2.0, -4.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 0.0), (2.0, -1.0), (3.0, 5.0)]));
    let found: Vec<(f64, bool)> = own.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found.len(), 3, "{found:?}");
    assert_eq!(found[..2], [(-1.0, true), (1.0, false)]);
    close(found[2].0, 2.0 + 1.0 / 6.0, 1e-15);
    assert_eq!((own.equilibria[0].stiffness_left, own.equilibria[0].stiffness_right), (4.0, 1.0));
    let extrema: Vec<f64> = own.extrema.iter().map(|e| e.x).collect();
    assert_eq!(extrema, [0.0, 2.0]);
    let barrier = own.barrier.unwrap();
    close(barrier.from_left_j, 1.0, 1e-15);
    assert_eq!(own.kinks.len(), 3, "{:?}", own.kinks);
}

#[test]
fn the_ends_of_the_domain_are_known_from_one_side() {
    let own = Landscape::of(&chain(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]));
    let found: Vec<(f64, bool)> = own.equilibria.iter().map(|e| (e.x, e.stable)).collect();
    assert_eq!(found, [(0.0, false), (2.0, false)]);
    assert!(own.equilibria[0].stiffness_left.is_nan());
    assert_eq!(own.equilibria[0].stiffness_right, 1.0);
}

#[test]
fn the_damping_stiffness_does_not_jump_while_an_equilibrium_crosses_a_corner() {
    let landscape = |shift: f64| {
        Landscape::of(&chain(&[(-1.0, 1.0), (1.0, -1.0 + shift), (2.0, 1.0 + shift), (3.0, 40.0 + shift)]))
    };
    // The well at 1.5 - shift/2, then on the corner at 2, then beyond.
    let before = landscape(-1.0 + 1e-9);
    assert_eq!(before.kinks.len(), 2);
    for shift in [-0.9, -1.0 + 1e-9, -1.0, -1.0 - 1e-9, -1.1] {
        let own = landscape(shift);
        let well = own.right_stable().unwrap();
        assert_eq!(well.x > 2.0, shift < -1.0);
        close(own.damping_stiffness().unwrap(), 2.0, 1e-12);
    }
}

#[test]
fn either_well_has_its_own_inner_stiffness() {
    let own = Landscape::of(&chain(&[
        (-3.0, -4.0),
        (-2.0, 0.5),
        (-1.0, 1.0),
        (1.0, -1.0),
        (2.0, -0.1),
        (3.0, 40.0),
    ]));
    let inner: Vec<f64> =
        own.equilibria.iter().filter(|e| e.stable).map(|e| own.inner_stiffness(e)).collect();
    // The left well lies beyond its corner at -2, the right one beyond that at 2.
    assert_eq!(inner.len(), 2);
    close(inner[0], 0.5, 1e-12);
    close(inner[1], 0.9, 1e-12);
}

#[test]
fn the_damping_stiffness_looks_inward_from_either_side() {
    let well = |x: f64, left: f64, right: f64| Equilibrium {
        x,
        stable: true,
        stiffness_left: left,
        stiffness_right: right,
    };
    let corner = |x: f64, left: f64, right: f64| Kink { x, stiffness_left: left, stiffness_right: right };
    let of = |w: Equilibrium, kinks: Vec<Kink>| {
        Landscape { equilibria: vec![w], kinks, ..Default::default() }.damping_stiffness()
    };
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(2.0, 7.0, 9.0)]), Some(5.0));
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(0.99, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(1.0, 5.0, 5.0), vec![corner(0.5, -3.0, 5.0)]), Some(5.0));
    assert_eq!(of(well(1.0, 3.0, 5.0), vec![corner(1.0, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(-1.0, 5.0, 3.0), vec![corner(-1.0, 5.0, 3.0)]), Some(3.0));
    assert_eq!(of(well(-1.0, 5.0, 5.0), vec![corner(-0.9, 5.0, 2.0)]), Some(2.0));
    assert_eq!(of(well(0.0, 3.0, 5.0), vec![corner(0.0, 3.0, 5.0)]), Some(3.0));
    assert_eq!(of(well(1.0, 0.0, 0.0), vec![]), None);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Random tables, smooth or not, are followed or refused; the landscape agrees with the signs of the force.
    #[test]
    fn any_table_is_followed(
        steps in prop::collection::vec(1e-3..1.0_f64, 4..60),
        rough in prop::collection::vec(-1.0..1.0_f64, 60),
        roughness in prop::sample::select(vec![0.0, 1e-6, 1e-3, 1.0]),
        digits in 1..8_i32,
    ) {
        let mut x = -0.3 * steps.iter().sum::<f64>();
        let mut table = Table { x: Vec::new(), force: Vec::new() };
        for (step, r) in steps.iter().zip(&rough) {
            x += step;
            table.x.push(x);
            table.force.push((1.3 * x).sin() + 0.02 * x * x + roughness * r);
        }
        let curve = keeps_its_promises(&table, 10.0_f64.powi(-digits));
        let read = Table::parse(&text_of(&table));
        prop_assert_eq!(read.as_ref(), Ok(&table));
        let own = Landscape::of(&curve);
        let mut last = (curve.domain().0, curve.force(curve.domain().0));
        for i in 1..=400 {
            let at = curve.domain().0 + (curve.domain().1 - curve.domain().0) * f64::from(i) / 400.0;
            let at = at.min(curve.domain().1);
            let force = curve.force(at);
            if last.1 * force < 0.0 {
                prop_assert!(own.equilibria.iter().any(|e| e.x >= last.0 && e.x <= at));
            }
            last = (at, force);
        }
        for e in &own.equilibria {
            prop_assert!(curve.force(e.x).abs() <= 1e-10 * (1.0 + roughness));
        }
    }

    /// No text makes the reader panic.
    #[test]
    fn any_text_is_read_or_refused(text in "(x_m|force_n|[,;\"#\n\r .0-9eE+-]){0,120}", tail in ".{0,40}") {
        let _ = Mechanism::from_table(&format!("{text}{tail}"), 1e-4);
        let _ = Mechanism::from_table(&format!("x_m,force_n\n{text}{tail}"), 1e-4);
    }

    /// The landscape of a polynomial is complete and alternates.
    #[test]
    fn polynomials_alternate(coefficients in prop::collection::vec(-2.0..2.0_f64, 1..10)) {
        let own = polynomial(&coefficients);
        for pair in own.landscape.equilibria.windows(2) {
            prop_assert!(pair[0].x < pair[1].x);
            prop_assert!(!(pair[0].stable && pair[1].stable));
        }
        let at = |x: f64| own.curve.force(x).signum();
        let changes = (0..2000).filter(|i| at(-10.0 + f64::from(*i) * 0.01) * at(-9.99 + f64::from(*i) * 0.01) < 0.0);
        prop_assert!(own.landscape.equilibria.len() >= changes.count());
    }
}

// --- Kinks beside a well -------------------------------------------------------------------------

/// An odd curve with a kink at 1, slopes `inner` and `outer` there, and the well `past` beyond it.
fn kinked(inner: f64, outer: f64, past: f64) -> Mechanism {
    // a x + b x^3 inside, a straight line outside.
    let (force, slope) = (-outer * past, inner);
    let b = 0.5 * (slope - force);
    let a = force - b;
    let piece = |origin, coefficients| Piece { origin, coefficients, potential_at_origin: 0.0 };
    let right = piece(1.0, vec![force, outer]);
    let pieces = vec![right.mirrored(), piece(0.0, vec![0.0, a, 0.0, b]), right];
    Mechanism::new(ForceCurve::from_pieces(pieces, vec![-1.0, 1.0], (-2.0, 2.0), true, None))
}

#[test]
fn a_kink_beside_a_well_gives_it_two_stiffnesses() {
    for past in [1e-4, 9e-3, 0.0] {
        let own = kinked(137.0, 4000.0, past).landscape;
        let kink = own.kink_at_right_well().unwrap();
        close(kink.inner, 137.0, 1e-12);
        close(kink.outer, 4000.0, 1e-12);
        assert_eq!(own.damping_kink().map(|kink| kink.x), Some(1.0));
        close(own.damping_stiffness().unwrap(), 137.0, 1e-12);
    }
    // Far beyond the kink a small pluck does not meet it; the ratio still means the inner slope.
    let own = kinked(137.0, 4000.0, 0.02).landscape;
    assert_eq!(own.kink_at_right_well(), None);
    close(own.damping_stiffness().unwrap(), 137.0, 1e-12);
    // Just inside it, the slope that counts is that of the well itself, and the kink is still beside it.
    let own = kinked(137.0, 4000.0, -1e-4).landscape;
    assert!(own.right_stable().unwrap().x < 1.0);
    assert_eq!(own.damping_kink(), None);
    close(own.kink_at_right_well().unwrap().inner, 137.0, 1e-12);
    // Well inside it, as in the prototype's table.
    let table = Mechanism::from_table(PROTOTYPE, 1e-4).unwrap().landscape;
    assert_eq!((table.kink_at_right_well(), table.damping_kink()), (None, None));
}

#[test]
fn the_scales_do_not_jump_while_a_well_crosses_its_kink() {
    // All that a run in the unit of 1 m is relative to, beside the tolerance: it follows the well, by micrometres, and
    // the slope inside the kink, 137 N/m, not the wall of 4000 N/m in which the well lies once it is beyond.
    let text = "(title: \"t\", mass_g: 15.2, mechanism: Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1), \
                damping: Ratio(0.023), run: (duration_s: 1))";
    let scene = Document::from_text("t", text, Files::default()).unwrap().scene;
    let scales =
        |past: f64| -> Scales { Model::build(&scene, Arc::new(kinked(137.0, 4000.0, past))).unwrap().scales };
    let at = scales(0.0);
    for past in [-1e-6, -1e-9, 1e-9, 1e-6] {
        let own = scales(past);
        close(own.length, at.length, 1e-4);
        close(own.speed, at.speed, 1e-4);
        close(own.time, at.time, 1e-4);
    }
    close(at.time, (15.2e-3_f64 / 137.0).sqrt(), 1e-9);
}

// --- Flexures ------------------------------------------------------------------------------------

#[test]
fn flexures_enter_in_si() {
    let group = |count, length_mm, width_mm| scene::FlexureGroup { count, length_mm, width_mm };
    let own = build(scene::Mechanism::Flexures {
        preload_mm: 2.7,
        thickness_mm: 0.1,
        young_gpa: 190.0,
        parallel: group(2, 26.0, 20.0),
        buckling: group(1, 27.7, 6.8),
        poisson: 0.34,
        plane_strain: true,
        initial_bow_mm: 0.0,
        yield_gpa: 2.0,
    });
    let expected = Geometry {
        preload: 2.7e-3,
        thickness: 1e-4,
        young: 190e9,
        poisson: 0.34,
        plane_strain: true,
        initial_bow: 0.0,
        yield_stress: 2e9,
        parallel: Group { count: 2, length: 26e-3, width: 20e-3 },
        buckling: Group { count: 1, length: 27.7e-3, width: 6.8e-3 },
    };
    assert_eq!(own.flexures.as_ref().unwrap().geometry(), &expected);
    assert_eq!(polynomial(&[0.0, 1.0]).flexures, None);
}

#[test]
fn building_ends_once_it_is_told_to() {
    use std::sync::atomic::AtomicBool;
    for name in ["paper", "paper-table", "nominal-cubic"] {
        let document = interwell::scene::Document::load(name).unwrap();
        let build = |told: bool| {
            let cancel = AtomicBool::new(told);
            interwell::mechanics::Mechanism::build_unless(&document.scene.mechanism, &document.files, &cancel)
        };
        let whole = interwell::mechanics::Mechanism::build(&document.scene.mechanism, &document.files);
        assert!(build(true).is_none(), "{name}");
        assert_eq!(build(false).unwrap().unwrap().curve, whole.unwrap().curve, "{name}");
    }
}
