//! Magnets with moments across their gap and the motion, against closed forms.

use interwell::mechanics::transverse_magnet_force;
use interwell::numeric::{DoubleDouble, Number, Scalar};
use interwell::scene::{Mechanism, Moments};

use super::{build, close};
use crate::support::{Draw, documented};

fn magnet(strength_n_mm4: f64, gap_mm: f64) -> Mechanism {
    Mechanism::Magnet { strength_n_mm4, gap_mm, moments: Moments::Transverse }
}

/// The energy of two dipoles with the moments (0, 0, m) at (0, 0, 0) and (x, g, 0) in 31 digits, from the
/// scalar products of the general formula.
fn energy(strength: f64, gap: f64, x: f64) -> DoubleDouble {
    let dot = |a: [f64; 3], b: [f64; 3]| {
        a.into_iter().zip(b).fold(DoubleDouble::of(0.0), |sum, (a, b)| sum + DoubleDouble::product(a, b))
    };
    let (moment, apart) = ([0.0, 0.0, 1.0], [x, gap, 0.0]);
    let squared = dot(apart, apart);
    let along = dot(apart, moment);
    let three = DoubleDouble::of(3.0);
    let cube = squared * squared.sqrt();
    DoubleDouble::of(strength) * (dot(moment, moment) - three * along * along / squared) / cube
}

/// The energy over that at x = 0.
fn potential(strength: f64, gap: f64, x: f64) -> f64 {
    (energy(strength, gap, x) - energy(strength, gap, 0.0)).to_f64()
}

#[test]
fn the_force_is_the_slope_of_the_energy_at_any_geometry() {
    let mut draw = Draw(11);
    for _ in 0..200 {
        let gap = 10_f64.powf(draw.between(-4.0, -1.0));
        let strength = draw.between(-1.0, 1.0) * 1e-9;
        // a step of which the places are whole multiples, so that differences are exact
        let h = (gap * 2.0_f64.powi(-18)).log2().floor().exp2();
        let x = (gap * 10_f64.powf(draw.between(-3.0, 1.0)) / h).round() * h;
        let at = |x: f64| energy(strength, gap, x);
        let difference = |n: f64| (at(x + n * h) - at(x - n * h)).to_f64();
        let slope = (8.0 * difference(1.0) - difference(2.0)) / (12.0 * h);
        close(transverse_magnet_force(strength, gap, x), slope, 1e-13);
        assert_eq!(transverse_magnet_force(strength, gap, -x), -transverse_magnet_force(strength, gap, x));
    }
}

#[test]
fn the_pieces_follow_the_formula_over_the_whole_range() {
    let mut draw = Draw(12);
    for _ in 0..12 {
        let (gap_mm, size) = (10_f64.powf(draw.between(-3.0, 4.0)), 10_f64.powf(draw.between(-8.0, 8.0)));
        let strength_n_mm4 = size * if draw.unit() < 0.5 { -1.0 } else { 1.0 };
        let (strength, gap) = (strength_n_mm4 * 1e-12, gap_mm / 1e3);
        let mechanism = build(magnet(strength_n_mm4, gap_mm));
        let (curve, fit) = (&mechanism.curve, mechanism.curve.fit().unwrap());
        assert!(curve.is_odd() && mechanism.landscape.kinks.is_empty());
        let reach = curve.domain().1;
        close(reach, 100.0 * gap, 1e-9);
        let depth = potential(strength, gap, reach);
        for i in 0..=4000 {
            let x = (gap * (5.3 * f64::from(i) / 4000.0).sinh()).min(reach);
            let exact = transverse_magnet_force(strength, gap, x);
            assert!((curve.force(x) - exact).abs() <= fit.worst_n, "{x} {fit:?}");
            // the far field keeps its digits
            close(curve.force(x), exact, if x > 0.5 * gap { 1e-5 } else { 1.0 });
            assert!((curve.potential(x) - potential(strength, gap, x)).abs() <= 2e-8 * depth.abs(), "{x}");
        }
        // the greatest force is at half the gap: 3/2 (5/4)^(-5/2)
        close(fit.scale_n, strength.abs() / gap.powi(4) * 1.5 * 1.25_f64.powf(-2.5), 1e-6);
        assert!(fit.worst_n <= 1.5e-8 * fit.scale_n, "{fit:?}");
        let extrema: Vec<f64> = mechanism.landscape.extrema.iter().map(|extremum| extremum.x).collect();
        assert_eq!(extrema.len(), 2, "{extrema:?}");
        extrema.iter().zip([-0.5, 0.5]).for_each(|(x, exact)| close(*x, exact * gap, 1e-3));
        let middle = mechanism.landscape.equilibria[0];
        assert_eq!((mechanism.landscape.equilibria.len(), middle.x, middle.stable), (1, 0.0, strength < 0.0));
        close(curve.stiffness(0.0), -3.0 * strength / gap.powi(5), 1e-5);
    }
}

/// A spring k beside repelling magnets: k x = 3 K x/r^5, so that x^2 = (3 K/k)^(2/5) - g^2 and the wells are
/// k x^2/2 + K (1/r^3 - 1/g^3) deep.
#[test]
fn beside_a_spring_the_equilibria_are_those_of_the_closed_form() {
    let mut draw = Draw(13);
    for _ in 0..40 {
        let (gap, k) = (draw.between(2e-3, 30e-3), 10_f64.powf(draw.between(0.0, 3.0)));
        // r at equilibrium over the gap; below 1 the spring is the stronger one
        let ratio = draw.between(0.5, 4.0);
        let strength = k / 3.0 * (ratio * gap).powi(5);
        let spring = Mechanism::Linear { n_per_m: k };
        let sum = build(Mechanism::Sum(vec![spring, magnet(strength * 1e12, gap * 1e3)]));
        let landscape = &sum.landscape;
        if ratio < 1.0 {
            assert_eq!(landscape.equilibria.len(), 1, "{ratio}");
            assert!(landscape.equilibria[0].stable && landscape.barrier.is_none());
            continue;
        }
        let exact = ((3.0 * strength / k).powf(0.4) - gap * gap).sqrt();
        let barrier = landscape.barrier.unwrap();
        // the wells go to the middle where both forces are nearly equal there
        let bound = 1e-6 / (ratio - 1.0).min(1.0);
        close(barrier.right_well, exact, bound);
        close(barrier.left_well, -exact, bound);
        assert_eq!(barrier.x, 0.0);
        let height = -0.5 * k * exact * exact - potential(strength, gap, exact);
        assert!(
            (barrier.from_right_j - height).abs() <= 1e-7 * 0.5 * k * exact * exact,
            "{height} {barrier:?}"
        );
        // antiparallel moments leave one well
        let attracting = build(Mechanism::Sum(vec![
            Mechanism::Linear { n_per_m: k },
            magnet(-strength * 1e12, gap * 1e3),
        ]));
        assert_eq!(attracting.landscape.equilibria.len(), 1);
    }
}

/// The equation of Cottone, Vocca and Gammaitoni (2009): wells at x^2 = (3 K/k)^(2/5) - D^2, two of them
/// where D is below (3 K/k)^(1/5).
#[test]
fn the_pendulum_of_cottone_vocca_and_gammaitoni_has_two_wells_up_to_the_distance_of_the_formula() {
    let document = documented("Pendulum of Cottone, Vocca and Gammaitoni");
    let (strength, k) = (5e-10_f64, 25.0);
    let most = (3.0 * strength / k).powf(0.2);
    let well = |gap: f64| (most * most - gap * gap).sqrt();
    let page = include_str!("../../../docs/scene.md");
    assert!(page.contains(&format!("here x = {:.3} mm", 1e3 * well(8e-3))), "{}", well(8e-3));
    assert!(page.contains(&format!("here {:.3} mm", 1e3 * most)), "{most}");
    let mut draw = Draw(14);
    let mut gaps = vec![8e-3, most * 0.999, most * 1.001];
    gaps.extend((0..20).map(|_| most * draw.between(0.3, 1.7)));
    for gap in gaps {
        let mut document = document.clone();
        document.set(&format!("mechanism.1.gap_mm={:?}", 1e3 * gap)).unwrap();
        let landscape = &build(document.scene.mechanism.clone()).landscape;
        let places: Vec<f64> = landscape.equilibria.iter().map(|one| one.x).collect();
        if gap > most {
            assert_eq!(places, [0.0], "{gap}");
            continue;
        }
        assert_eq!(places.len(), 3, "{gap}");
        for (x, exact) in places.iter().zip([-well(gap), 0.0, well(gap)]) {
            assert!((x - exact).abs() < 1e-5 * most, "{x} {exact}");
        }
    }
}
