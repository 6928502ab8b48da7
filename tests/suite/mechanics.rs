//! mechanics
use interwell::mechanics::{Table, fit};
#[test]
fn explore() {
    let text = include_str!("../../assets/force_dl2.7.csv");
    let table = Table::parse(text).unwrap();
    for tol in [1e-5, 1e-4, 3e-4, 1e-3, 1e-2] {
        let t0 = std::time::Instant::now();
        let curve = fit(&table, tol).unwrap();
        println!(
            "tol {tol:e} time {:?} pieces {} odd {} {:?}",
            t0.elapsed(),
            curve.pieces().len(),
            curve.is_odd(),
            curve.fit()
        );
        for (i, p) in curve.pieces().iter().enumerate().skip(curve.pieces().len() / 2) {
            let (l, r) = curve.piece_interval(i);
            let (a, b) = curve.stiffness_on_both_sides(r);
            println!("  {:.4} {:.4} deg {}  slope {a:.4} {b:.4}", l * 1e3, r * 1e3, p.coefficients.len() - 1);
        }
    }
}
