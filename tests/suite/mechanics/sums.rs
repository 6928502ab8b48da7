//! Sums of force curves, springs and magnets: exact sums, the closed form of the magnet, errors as stated.

use interwell::mechanics::{ForceCurve, magnet_force};
use interwell::numeric::{DoubleDouble, Number, Scalar};
use interwell::scene::{self, Document};

use super::{PROTOTYPE, build, close, fault_of};

fn sum(parts: Vec<scene::Mechanism>) -> scene::Mechanism {
    scene::Mechanism::Sum(parts)
}

fn cubic(linear_n_per_m: f64) -> scene::Mechanism {
    scene::Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3: 8.2e5 }
}

fn linear(n_per_m: f64) -> scene::Mechanism {
    scene::Mechanism::Linear { n_per_m }
}

fn magnet(strength_n_mm4: f64, gap_mm: f64) -> scene::Mechanism {
    scene::Mechanism::Magnet { strength_n_mm4, gap_mm, moments: scene::Moments::Facing }
}

fn table() -> scene::Mechanism {
    scene::Mechanism::Table { path: "force_dl2.7.csv".into(), tolerance: 1e-4 }
}

#[test]
fn a_duffing_with_a_spring_is_the_duffing_of_the_shifted_stiffness_to_the_last_digit() {
    let (summed, shifted) = (build(sum(vec![cubic(-40.0), linear(30.0)])), build(cubic(-10.0)));
    assert_eq!(summed.curve, shifted.curve);
    assert_eq!(summed.landscape, shifted.landscape);
    let balanced = build(sum(vec![cubic(-40.0), linear(30.0), linear(10.0)]));
    assert_eq!(balanced.curve, build(cubic(0.0)).curve);
    // order and parts that are nothing change nothing
    let same = build(sum(vec![linear(30.0), magnet(0.0, 5.0), cubic(-40.0)]));
    assert_eq!(same.curve, shifted.curve);
}

/// Breaks of both parts, each a part of the other's pieces, and neither moved by more than rounding.
#[test]
fn a_sum_of_pieces_is_the_sum_of_the_forces_potentials_and_slopes() {
    let parts = [table(), magnet(12.0, 4.0), linear(-7.0), cubic(3.0)];
    let summed = build(sum(parts.to_vec()));
    let parts = parts.map(build);
    assert!(summed.curve.is_odd());
    let (low, high) = summed.curve.domain();
    assert_eq!((low, high), parts[0].curve.domain());
    let mut breaks: Vec<f64> = parts.iter().flat_map(|part| part.curve.breaks()).copied().collect();
    breaks.retain(|x| *x > low && *x < high);
    breaks.sort_by(f64::total_cmp);
    assert_eq!(summed.curve.breaks(), breaks);
    assert!(breaks.len() > parts[0].curve.breaks().len(), "{breaks:?}");
    let largest = |of: fn(&ForceCurve, f64) -> f64| {
        let at = |i: i32| low + (high - low) * f64::from(i) / 499.0;
        (0..500).map(|i| of(&parts[0].curve, at(i).clamp(low, high)).abs()).fold(0.0, f64::max)
    };
    let [force, potential, slope] =
        [ForceCurve::force, ForceCurve::potential, ForceCurve::stiffness].map(largest);
    for i in 0..=4000 {
        let x = (low + (high - low) * f64::from(i) / 4000.0).clamp(low, high);
        let of = |of: fn(&ForceCurve, f64) -> f64| -> f64 {
            of(&summed.curve, x) - parts.iter().map(|part| of(&part.curve, x)).sum::<f64>()
        };
        assert!(of(|curve, x| curve.force(x)).abs() <= 1e-14 * force, "{x}");
        assert!(of(|curve, x| curve.potential(x)).abs() <= 1e-14 * potential, "{x}");
        assert!(of(|curve, x| curve.stiffness(x)).abs() <= 1e-12 * slope, "{x}");
        assert_eq!(summed.curve.force(-x), -summed.curve.force(x));
    }
    // a kink of a part is one of the sum, and the magnet has none of its own
    let [of_sum, of_table] = [&summed, &parts[0]].map(|mechanism| mechanism.landscape.kinks.len());
    assert_eq!(of_sum, of_table);
}

/// One that is not odd, with the first part known on one side further than the second.
#[test]
fn a_lopsided_sum_is_known_where_both_parts_are() {
    let text = "x_m,force_n\n-0.002,-1\n-0.001,-0.4\n0,0.1\n0.001,0.5\n0.003,2\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("own.csv");
    std::fs::write(&path, text).unwrap();
    let summed = build(sum(vec![
        scene::Mechanism::Table { path: path.to_str().unwrap().into(), tolerance: 1e-6 },
        table(),
        scene::Mechanism::Polynomial { coefficients_si: vec![0.5, 0.0, 3.0] },
    ]));
    assert_eq!(summed.curve.domain(), (-0.002, 0.003));
    assert!(!summed.curve.is_odd());
    let other = interwell::mechanics::Mechanism::from_table(PROTOTYPE, 1e-4).unwrap();
    for (x, force) in [(-0.002, -1.0), (0.0, 0.1), (0.003, 2.0)] {
        close(summed.curve.force(x), force + other.curve.force(x) + 0.5 + 3.0 * x * x, 1e-13);
    }
    assert_eq!(summed.curve.potential(0.0), 0.0);
}

/// The energy in 31 digits.
fn energy(strength: f64, gap: f64, x: f64) -> DoubleDouble {
    let number = |value: f64| DoubleDouble::of(value);
    let squared = DoubleDouble::product(x, x) + DoubleDouble::product(gap, gap);
    let r = squared.sqrt();
    let cube = squared * r;
    let gap = number(gap);
    number(strength) * (number(1.0) / cube - number(3.0) * gap * gap / (cube * squared))
}

#[test]
fn the_force_of_a_magnet_is_the_slope_of_its_energy() {
    let (strength, gap) = (7e-12, 4e-3);
    let at = |x: f64| energy(strength, gap, x);
    // a step that a place and its neighbours are whole multiples of, and that is small enough to be exact
    let h = 2.0_f64.powi(-30);
    for x in [1e-5, 3e-4, 1e-3, 2.5e-3, 0.02, 0.1] {
        let x = (x / h).round() * h;
        let difference = |n: f64| (at(x + n * h) - at(x - n * h)).to_f64();
        let slope = (8.0 * difference(1.0) - difference(2.0)) / (12.0 * h);
        close(magnet_force(strength, gap, x), slope, 1e-14);
    }
}

#[test]
fn a_magnet_has_its_stiffness_its_zeros_and_its_far_field() {
    let (strength, gap): (f64, f64) = (7e-12, 4e-3);
    close(magnet_force(strength, gap, 1e-12), 12e-12 * strength / gap.powi(5), 1e-15);
    assert_eq!(magnet_force(strength, gap, 2.0 * gap), 0.0);
    // far away -3 K/x^4 (1 - 15/2 (g/x)^2 + ..)
    for gaps in [1e3, 1e4] {
        let x = gaps * gap;
        let far = -3.0 * strength / x.powi(4) * (1.0 - 7.5 / (gaps * gaps));
        close(magnet_force(strength, gap, x), far, 50.0 / gaps.powi(4) + 1e-15);
    }
    let mechanism = build(magnet(7.0, 4.0));
    let [left, middle, right] = mechanism.landscape.equilibria[..] else {
        panic!("{:?}", mechanism.landscape)
    };
    assert!(middle.x == 0.0 && middle.stable && !left.stable && !right.stable);
    close(right.x, 8e-3, 1e-7);
    close(mechanism.damping_stiffness().unwrap(), 12.0 * strength / gap.powi(5), 1e-6);
    let repelling = build(magnet(-7.0, 4.0));
    let barrier = repelling.landscape.barrier.unwrap();
    close(barrier.right_well, 8e-3, 1e-7);
    // from the middle to r^2 = 5 g^2
    let height = 2.0 + 5.0_f64.powf(-1.5) - 3.0 * 5.0_f64.powf(-2.5);
    close(barrier.from_right_j, strength / gap.powi(3) * height, 1e-7);
}

#[test]
fn the_pieces_of_a_magnet_are_as_near_to_its_formula_as_is_said() {
    for (strength_n_mm4, gap_mm) in [(7.0, 4.0), (-2e3, 11.0), (1e-40, 1e-10), (-3e30, 1e9)] {
        let mechanism = build(magnet(strength_n_mm4, gap_mm));
        let (strength, gap) = (strength_n_mm4 * 1e-12, gap_mm / 1e3);
        let fit = mechanism.curve.fit().unwrap();
        assert!(mechanism.curve.is_odd() && mechanism.landscape.kinks.is_empty());
        let reach = mechanism.curve.domain().1;
        close(reach, 100.0 * gap, 1e-9);
        let mut worst = 0.0_f64;
        for i in 0..=30_000 {
            let x = (gap * (5.3 * f64::from(i) / 30_000.0).sinh()).min(reach);
            worst = worst.max((mechanism.curve.force(x) - magnet_force(strength, gap, x)).abs());
        }
        assert!(worst <= fit.worst_n, "{worst} {fit:?}");
        assert!(worst >= 0.9 * fit.worst_n, "{worst} {fit:?}");
        assert!(fit.worst_n <= 1.5e-8 * fit.scale_n, "{fit:?}");
    }
}

#[test]
fn the_far_field_of_a_magnet_keeps_its_digits_and_has_no_extrema() {
    for (strength_n_mm4, gap_mm) in [(7.0, 4.0), (-2e3, 11.0)] {
        let mechanism = build(magnet(strength_n_mm4, gap_mm));
        let (strength, gap) = (strength_n_mm4 * 1e-12, gap_mm / 1e3);
        // the roots of 4 s^2 - 27 s + 4, s = (x/g)^2
        let places = [-1.0, 1.0].map(|side| ((27.0 + side * 665_f64.sqrt()) / 8.0).sqrt() * gap);
        let exact = [-places[1], -places[0], places[0], places[1]];
        let found: Vec<f64> = mechanism.landscape.extrema.iter().map(|extremum| extremum.x).collect();
        assert_eq!(found.len(), 4, "{found:?}");
        for (found, exact) in found.iter().zip(exact) {
            close(*found, exact, 1e-3);
        }
        for i in 0..=5000 {
            let x = places[1]
                * 1.001
                * (mechanism.curve.domain().1 / places[1] / 1.001).powf(f64::from(i) / 5000.0);
            close(
                mechanism.curve.force(x.min(mechanism.curve.domain().1)),
                magnet_force(strength, gap, x),
                1e-5,
            );
        }
        // nor has a sum with a spring others than its own
        let sum = build(sum(vec![magnet(strength_n_mm4, gap_mm), linear(0.0)]));
        assert_eq!(sum.landscape.extrema.len(), 4);
    }
}

#[test]
fn what_no_sum_or_magnet_can_be_is_said_with_its_field() {
    let fault = fault_of(&magnet(1e-300, 1e15));
    assert_eq!(fault.field, "mechanism.strength_n_mm4");
    assert!(fault.problem.contains("leaves the range of double precision"), "{fault:?}");
    let nowhere = scene::Mechanism::Table { path: "nowhere.csv".into(), tolerance: 1e-4 };
    assert_eq!(fault_of(&sum(vec![linear(1.0), nowhere])).field, "mechanism.1.path");
    let said = |mechanism: scene::Mechanism| {
        let mut document = Document::load("nominal-cubic").unwrap();
        document.scene.mechanism = mechanism;
        document.check().unwrap_err().to_string()
    };
    let nested = said(sum(vec![linear(1.0), sum(vec![linear(2.0)])]));
    assert!(nested.contains("mechanism.1 = Sum([..]): a sum within a sum; give its parts"), "{nested}");
    assert!(said(sum(Vec::new())).contains("mechanism = a sum of 0: must have 1 to 16 parts"));
    assert!(said(sum(vec![linear(1.0); 17])).contains("a sum of 17"));
    let gap = said(sum(vec![linear(1.0), magnet(1.0, 0.0)]));
    assert!(gap.contains("mechanism.1.gap_mm = 0: must be 1e-15 to 1e15"), "{gap}");
    let mut paper = Document::load("paper").unwrap().scene.mechanism;
    if let scene::Mechanism::Flexures { preload_mm, .. } = &mut paper {
        *preload_mm = 20.0;
    }
    let preload = said(sum(vec![linear(1.0), paper]));
    assert!(preload.contains("mechanism.1.preload_mm = 20: must be 0 to 13 mm"), "{preload}");
    assert!(preload.contains("mechanism.1.parallel.length_mm = 26"), "{preload}");
}
