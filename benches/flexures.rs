//! Cost and error of a force curve from flexures: `cargo bench --bench flexures`. The prototype's curve at
//! several tolerances, CPU time beside the error at fresh solutions between the points it was made of.

mod shared;

use interwell::mechanics::Landscape;
use interwell::mechanics::flexure::{Flexures, Geometry, Group};

const ROUNDS: usize = 201;

/// Places between x = 0 and the end of the curve at which it is compared.
const PLACES: usize = 97;

fn main() {
    println!(
        "| tolerance | CPU, ms | states | functions | pieces | error of the force inside | \
         of the stiffness | outside |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let geometry = prototype();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-9] {
        let solve = || {
            let (curve, flexures) = Flexures::solve(&geometry, tolerance).unwrap();
            let landscape = Landscape::of(&curve);
            (curve, flexures, landscape)
        };
        let mut times: Vec<f64> = (0..shared::rounds(ROUNDS)).map(|_| shared::cpu(solve)).collect();
        let (curve, flexures, landscape) = solve();
        let largest = landscape.extrema.iter().fold(0.0_f64, |most, e| most.max(e.force.abs()));
        let (kink, end) = (landscape.kinks[1].x, curve.domain().1);
        let (mut inside, mut stiffness, mut outside) = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..PLACES {
            let x = end * (i as f64 + 0.5) / PLACES as f64;
            let state = flexures.state(x).unwrap();
            let force = (curve.force(x) - state.force).abs() / largest.max(state.force.abs());
            if x < kink {
                inside = inside.max(force);
                stiffness =
                    stiffness.max((curve.stiffness(x) - state.stiffness).abs() / curve.stiffness(0.0).abs());
            } else {
                outside = outside.max(force);
            }
        }
        println!(
            "| {tolerance:.0e} | {:.2} | {} | {} | {} | {inside:.1e} | {stiffness:.1e} | {outside:.1e} |",
            shared::median(&mut times) * 1e3,
            flexures.accuracy().solves,
            flexures.accuracy().modes,
            curve.pieces().len(),
        );
    }
}

fn prototype() -> Geometry {
    Geometry {
        preload: 2.7e-3,
        thickness: 1e-4,
        young: 190e9,
        poisson: 0.34,
        plane_strain: false,
        initial_bow: 0.0,
        yield_stress: 2e9,
        parallel: Group { count: 2, length: 26e-3, width: 20e-3 },
        buckling: Group { count: 1, length: 27.7e-3, width: 6.8e-3 },
    }
}
