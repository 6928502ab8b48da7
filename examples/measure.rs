use interwell::dynamics::*;
use interwell::mechanics::Mechanism;
use interwell::scene::*;
use std::sync::Arc;
use std::time::Instant;
fn build(name: &str, sets: &[&str]) -> Model {
    let mut d = Document::load(name).unwrap();
    for s in sets {
        d.set(s).unwrap();
    }
    d.check().unwrap();
    let m = Arc::new(Mechanism::build(&d.scene.mechanism, &d.files).unwrap());
    Model::build(&d.scene, m).unwrap()
}
fn time(m: &Model, r: &Request) -> f64 {
    let mut best = f64::MAX;
    for _ in 0..15 {
        let t = Instant::now();
        std::hint::black_box(m.run(r));
        best = best.min(t.elapsed().as_secs_f64());
    }
    best * 1e6
}
fn main() {
    for (name, sets) in [("P1", vec!["stops=None", "excitation.amplitude_g=1.1"]), ("P2", vec![])] {
        let m = build("nominal-cubic", &sets);
        println!("{:?}", m.scales);
        let req = Request { events: true, ledger: true, ..Default::default() };
        let t = Instant::now();
        let r = m.run_reference(&req, 1e-27);
        println!("{name} ref {:?} in {:?}", r.summary, t.elapsed());
        for tol in [1e-3, 1e-6, 1e-9, 1e-12, 1e-14] {
            let mut mm = m.clone();
            mm.tolerance = tol;
            let a = mm.run(&req);
            let dx = ((a.summary.final_x - r.summary.final_x) / 7e-3).abs();
            let drms = (a.summary.rms_velocity.unwrap() / r.summary.rms_velocity.unwrap() - 1.0).abs();
            let big = |e: &Vec<Event>| {
                e.iter()
                    .filter(|e| e.kind == EventKind::Impact && e.v_in.abs() > 1e-2)
                    .map(|e| e.t)
                    .collect::<Vec<_>>()
            };
            let (ea, er) = (big(&a.events), big(&r.events));
            let dt = if ea.len() == er.len() {
                ea.iter().zip(&er).map(|(a, b)| (a - b).abs() * 3.0).fold(0.0, f64::max)
            } else {
                f64::NAN
            };
            let us = time(&mm, &Request::default());
            let usl = time(&mm, &req);
            println!(
                "{name} tol {tol:e} dx {dx:.2e} drms {drms:.2e} dt {dt:.2e} impacts {} sums {} steps {} us {us:.0} with ledger {usl:.0} resid {:.1e} {:?} period {:?}",
                a.summary.total_impacts,
                a.summary.chatter_sums,
                a.summary.steps,
                a.summary.ledger.unwrap().energy_residual,
                a.summary.regime,
                a.summary.period
            );
        }
    }
}
