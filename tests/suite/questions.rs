//! Questions: cancellation of mechanisms and records, and which argument a fault names.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use interwell::mechanics::ForceCurve;
use interwell::questions::{
    Branch, Curve, Error, Identify, Progress, Sampling, Simulation, Sweep, WhatToIdentify,
};
use interwell::scene::{Document, Excitation};

#[test]
fn a_mechanism_is_cancelled_and_solved_once() {
    let stop = AtomicBool::new(true);
    let stopped = Progress::none().stopped_by(&stop);
    let built = Simulation::build(Document::preset("paper").unwrap(), &stopped);
    assert_eq!(built.unwrap_err(), Error::Cancelled);
    let cubic = Simulation::preset("nominal-cubic").unwrap();
    let change = |field: &str, value: &str| cubic.with_changes(&[(field.into(), value.into())], &stopped);
    assert_eq!(change("mechanism.linear_n_per_m", "-41").unwrap_err(), Error::Cancelled);
    assert!(Arc::ptr_eq(change("mass_g", "16").unwrap().mechanism(), cubic.mechanism()));
    let sweep = Sweep::over("mass_g", 15.0..=16.0, 2).uncertain("mechanism.linear_n_per_m=-41+-1");
    assert_eq!(sweep.nominal(&cubic, &stopped).unwrap_err(), Error::Cancelled);
    let nominal = sweep.nominal(&cubic, &Progress::none()).unwrap();
    let again = sweep.nominal(&nominal, &Progress::none()).unwrap();
    assert!(Arc::ptr_eq(nominal.mechanism(), again.mechanism()));
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("times.csv");
    std::fs::write(&record, "t_s\n0\n1\n1.5\n1.75\n1.875\n").unwrap();
    let question = Identify { impact_times: true, ..Identify::of(WhatToIdentify::Restitution) };
    assert_eq!(question.run(&record, &stopped).unwrap_err(), Error::Cancelled);
}

/// Field and value of the fault of an argument.
fn fault<T>(found: Result<T, Error>) -> (String, String) {
    let faults = found.err().map(|error| error.faults()).unwrap_or_default();
    faults.into_iter().map(|fault| (fault.field, fault.value)).next().unwrap_or_default()
}

#[test]
fn a_fault_names_the_argument_and_its_value() {
    let scene = Simulation::preset("nominal-cubic").unwrap();
    let branch = |field: &str, from, to| Branch::over(field, from, to).run(&scene, &Progress::none());
    let curve = |range, tolerance, breaks: &[f64]| {
        ForceCurve::from_fn(|x| x, range, tolerance, breaks).map_err(Error::from)
    };
    let drive = |hz, tolerance| Excitation::from_fn(f64::sin, hz, tolerance).map_err(Error::from);
    let identify = |of, between| {
        let question = Identify { between, ..Identify::of(of) };
        question.run("no.csv".as_ref(), &Progress::none())
    };
    let uncertain = |law: &str| Sweep::over("mass_g", 15.0..=16.0, 2).uncertain(law);
    let sampled = |sampling| scene.record(&sampling, None, &Progress::none());
    let beyond = Curve { positions: Some(vec![99.0]) }.run(&Simulation::preset("paper").unwrap());
    for (found, expected) in [
        (fault(branch("mass_g", 1.0, 1.0)), ("range", "1:1")),
        (fault(branch("mass", 1.0, 2.0)), ("field", "mass")),
        (fault(branch("run.tolerance", 1e-9, 1e-8)), ("field", "run.tolerance")),
        (fault(curve((1.0, -1.0), 1e-8, &[])), ("range", "1:-1")),
        (fault(curve((-1.0, 1.0), 2.0, &[])), ("tolerance", "2")),
        (fault(curve((-1.0, 1.0), 1e-8, &[3.0])), ("breaks", "3")),
        (fault(drive(0.0, 1e-6)), ("frequency_hz", "0")),
        (fault(drive(1.0, 2.0)), ("tolerance", "2")),
        (fault(identify(WhatToIdentify::Damping, [Some(5.0), Some(2.0)])), ("from", "5")),
        (fault(identify(WhatToIdentify::Force, [None, Some(2.0)])), ("to", "2")),
        (fault(sampled(Sampling::Every(0.0))), ("dt", "0")),
        (fault(sampled(Sampling::At(vec![99.0]))), ("at", "99")),
        (fault(beyond), ("positions", "99")),
    ] {
        assert_eq!((&*found.0, &*found.1), expected);
    }
    let error = uncertain("damping.xi=+-nan").run(&scene, &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("NaN is not finite"), "{error}");
}
